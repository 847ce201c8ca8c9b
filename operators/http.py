"""One request over HTTP, and its answer as JSON."""

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from http.client import HTTPException, HTTPResponse
from http.cookies import CookieError, SimpleCookie
from typing import Any, Final
from urllib.error import HTTPError, URLError
from urllib.parse import urlsplit
from urllib.request import Request, urlopen

from esplanade.operators.errors import RefusedError, UnreachableError

PREFIX: Final = "/api/v1"
PATIENCE_S: Final = 60.0
MOST_BYTES: Final = 32 * 1024 * 1024
"""Longer answers are not read."""
_COOKIE: Final = "esplanade_session"


class SessionToken(str):
    """The token of a session: it goes into the cookie that a browser would send."""

    __slots__ = ()


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
    with opened(url, token, path, body, method) as answer:
        text = answer.read(MOST_BYTES)
        return json.loads(text) if text else None


def log_in(url: str, name: str, password: str) -> SessionToken:
    """Begin a session; its token.

    Raises
    ------
    RefusedError, UnreachableError
        As with `ask`.
    """
    with opened(url, "", "/login", {"name": name, "password": password}) as answer:
        cookies: SimpleCookie = SimpleCookie()
        for each in answer.headers.get_all("Set-Cookie", ()):
            cookies.load(each)
        if _COOKIE not in cookies:
            raise ValueError("there is no session in the answer")
        return SessionToken(cookies[_COOKIE].value)


@contextmanager
def opened(
    url: str, token: str, path: str, body: Any = None, method: str | None = None
) -> Iterator[HTTPResponse]:
    """An answer to be read within the context; faults of reading are raised as those of asking.

    Raises
    ------
    RefusedError, UnreachableError
        As with `ask`.
    """
    base = url.rstrip("/")
    if urlsplit(base).scheme not in {"http", "https"}:
        raise UnreachableError(f"{url!r} is no address such as http://localhost:8081")
    headers = {**_shown(token), "Accept": "application/json"}
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
            yield answer
    except HTTPError as error:
        raise _refusal(error) from None
    except (URLError, OSError, HTTPException) as error:
        raise UnreachableError(f"{base}: {getattr(error, 'reason', None) or error}") from None
    except (ValueError, CookieError):
        raise UnreachableError(f"{base}: what answers there is no server of this kind") from None


def _shown(token: str) -> dict[str, str]:
    """The header that says who asks; none without a token."""
    if isinstance(token, SessionToken):
        return {"Cookie": f"{_COOKIE}={token}"}
    return {"Authorization": f"Bearer {token}"} if token else {}


def _refusal(error: HTTPError) -> RefusedError:
    try:
        told: Mapping[str, Any] = json.loads(error.read(MOST_BYTES))
        return RefusedError(error.code, told["faults"])
    except (ValueError, KeyError, TypeError):
        return RefusedError(error.code, [{"text": f"{error.code} {error.reason}"}])
