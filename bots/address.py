"""The address of the server, as people type it."""

import socket
from typing import Final
from urllib.parse import urlsplit, urlunsplit

SOCKET_NAME: Final = "ws"
"""The last part of the socket's path; before it stands the path of the page."""

KNOCK_TIMEOUT_S: Final = 5.0

_SCHEMES: Final = {"ws": "ws", "wss": "wss", "http": "ws", "https": "wss"}


def websocket_url(text: str) -> str:
    """Full WebSocket address of a server.

    `localhost:8080`, `http://localhost:8080/` and `ws://localhost:8080` all mean
    `ws://localhost:8080/ws`. A path that ends with a slash, and any path behind http:// or
    https://, is that of the page: `ws://host/world/` and `https://host/world` mean the socket
    `/world/ws`. Every other path stays.

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
    path = _socket_path(parts.path, is_page=parts.scheme in {"http", "https"})
    return urlunsplit((scheme, parts.netloc, path, parts.query, ""))


def _socket_path(path: str, *, is_page: bool) -> str:
    folder, _, name = path.rpartition("/")
    if name == "index.html" or not name:
        return f"{folder}/{SOCKET_NAME}"
    return f"{path}/{SOCKET_NAME}" if is_page and name != SOCKET_NAME else path


def refusal(url: str) -> str | None:
    """Why nothing takes connections at the address, None if something does."""
    parts = urlsplit(websocket_url(url))
    port = parts.port or (443 if parts.scheme == "wss" else 80)
    try:
        socket.create_connection((parts.hostname or "", port), KNOCK_TIMEOUT_S).close()
    except OSError as error:
        return error.strerror or str(error)
    return None
