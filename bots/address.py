"""The address of the server, as people type it."""

import socket
from typing import Final
from urllib.parse import urlsplit, urlunsplit

DEFAULT_PATH: Final = "/ws"

KNOCK_TIMEOUT_S: Final = 5.0

_SCHEMES: Final = {"ws": "ws", "wss": "wss", "http": "ws", "https": "wss"}


def websocket_url(text: str) -> str:
    """Full WebSocket address of a server.

    `localhost:8080`, `http://localhost:8080/` and `ws://localhost:8080` all mean
    `ws://localhost:8080/ws`; a path that is given stays.

    Raises
    ------
    ValueError
        Unknown scheme, no host, a port out of range, or a fragment.
    """
    full = text if "://" in text else f"ws://{text}"
    try:
        parts = urlsplit(full)
        port = parts.port
    except ValueError as error:
        raise ValueError(f"url {text!r}: {error}") from None
    scheme = _SCHEMES.get(parts.scheme)
    if scheme is None:
        known = ", ".join(_SCHEMES)
        raise ValueError(f"url {text!r}: unknown scheme {parts.scheme!r}, expected one of {known}")
    if not parts.hostname or port == 0:
        raise ValueError(f"url {text!r}: expected host and port, like ws://localhost:8080")
    if parts.fragment:
        raise ValueError(f"url {text!r}: a fragment (#) means nothing here")
    path = parts.path if parts.path not in {"", "/"} else DEFAULT_PATH
    return urlunsplit((scheme, parts.netloc, path, parts.query, ""))


def refusal(url: str) -> str | None:
    """Why nothing takes connections at the address, None if something does."""
    parts = urlsplit(websocket_url(url))
    port = parts.port or (443 if parts.scheme == "wss" else 80)
    try:
        socket.create_connection((parts.hostname or "", port), KNOCK_TIMEOUT_S).close()
    except OSError as error:
        return error.strerror or str(error)
    return None
