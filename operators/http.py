"""One request over HTTP, as JSON."""

import json
from collections.abc import Mapping
from http.client import HTTPException
from typing import Any, Final
from urllib.error import HTTPError, URLError
from urllib.parse import urlsplit
from urllib.request import Request, urlopen

from esplanade.operators.errors import RefusedError, UnreachableError

PREFIX: Final = "/api/v1"
PATIENCE_S: Final = 60.0
MOST_BYTES: Final = 32 * 1024 * 1024
"""Longer answers are not read."""


def ask(url: str, token: str, path: str, body: Any = None, method: str | None = None) -> Any:
    """The answer of a server to GET, or to POST if there is a body, or to another method.

    It is None where the server has nothing to say.

    Raises
    ------
    RefusedError
        The server has refused it.
    UnreachableError
        It cannot be reached, or the address is none.
    """
    base = url.rstrip("/")
    if urlsplit(base).scheme not in {"http", "https"}:
        raise UnreachableError(f"{url!r} is no address such as http://localhost:8081")
    headers = {"Authorization": f"Bearer {token}", "Accept": "application/json"}
    data = None
    if method is not None:
        headers["X-Esplanade"] = "1"
    if body is not None:
        data = json.dumps(body, allow_nan=False).encode()
        headers |= {"Content-Type": "application/json", "X-Esplanade": "1"}
    request = Request(  # noqa: S310 (the scheme is checked)
        f"{base}{PREFIX}{path}", data, headers, method=method
    )
    try:
        with urlopen(request, timeout=PATIENCE_S) as answer:  # noqa: S310
            text = answer.read(MOST_BYTES)
            return json.loads(text) if text else None
    except HTTPError as error:
        raise _refusal(error) from None
    except (URLError, OSError, HTTPException) as error:
        raise UnreachableError(f"{base}: {getattr(error, 'reason', None) or error}") from None
    except ValueError:
        raise UnreachableError(f"{base}: what answers there is no server of this kind") from None


def _refusal(error: HTTPError) -> RefusedError:
    try:
        told: Mapping[str, Any] = json.loads(error.read(MOST_BYTES))
        return RefusedError(error.code, told["faults"])
    except (ValueError, KeyError, TypeError):
        return RefusedError(error.code, [{"text": f"{error.code} {error.reason}"}])
