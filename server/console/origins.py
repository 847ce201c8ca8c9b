"""Pages that may ask in an operator's name: those that this port has served, under a name of its
own.

A browser adds cookies to what any page asks. `Origin` and `Sec-Fetch-Site` say which page it is;
`Host` says under which name the port was reached, and a name that others can point here (DNS
rebinding) is not taken.
"""

from collections.abc import Iterable
from ipaddress import ip_address
from typing import Final
from urllib.parse import urlsplit

from starlette.datastructures import Headers

from esplanade.server.console.refusals import RefusedError

_PORTS: Final = {"http": 80, "https": 443}
_OWN_SITE: Final = frozenset({"same-origin", "none"})


class Origins:
    """Checks names and pages. `names` are those of the port beside addresses and localhost.

    With `encrypted`, the port itself speaks TLS, so that pages of http:// are none of its own.
    """

    def __init__(self, names: Iterable[str] = (), *, encrypted: bool = False) -> None:
        self._names = frozenset(name.strip().lower() for name in names if name.strip())
        self._encrypted = encrypted
        self.refused = 0
        """Requests that were refused for their name or their page."""

    def check(self, headers: Headers, *, by_browser: bool, origin_needed: bool = False) -> None:
        """Check who sends a request that changes something, or opens a WebSocket.

        `by_browser` says that it is let in by what a browser adds by itself, or by nothing at all;
        a script that sends its token is asked for its page only if it has one.

        Raises
        ------
        RefusedError
            The name is none of this port, or the page is somebody else's.
        """
        try:
            self._check(headers, by_browser, origin_needed)
        except RefusedError:
            self.refused += 1
            raise

    def _check(self, headers: Headers, by_browser: bool, origin_needed: bool) -> None:
        origin, host = _only(headers, "origin"), _only(headers, "host")
        site = _only(headers, "sec-fetch-site")
        if site is not None and site not in _OWN_SITE:
            raise RefusedError.of("foreign_origin", "this was asked by a page of somebody else")
        if origin is None and origin_needed:
            raise RefusedError.of("foreign_origin", "the header Origin is missing")
        if (by_browser or origin is not None) and not self._is_ours(host):
            text = (
                f"this port is not known as {host!r}: use its address or localhost, or start the "
                "server with --private-names"
            )
            raise RefusedError.of("foreign_host", text)
        if origin is not None and not self._is_same(origin, host or ""):
            text = f"this was asked by a page of {origin!r}, not by one of this port"
            raise RefusedError.of("foreign_origin", text)

    def _is_ours(self, host: str | None) -> bool:
        """Whether nobody else can have pointed this name here: an address is no name."""
        try:
            parts = urlsplit(f"//{host or ''}")
            name, _ = parts.hostname, parts.port
        except ValueError:
            return False
        if not name or parts.username is not None or parts.path or parts.query:
            return False
        if name == "localhost" or name.endswith(".localhost") or name in self._names:
            return True
        try:
            ip_address(name)
        except ValueError:
            return False
        return True

    def _is_same(self, origin: str, host: str) -> bool:
        try:
            page = urlsplit(origin)
            here = urlsplit(f"{page.scheme}://{host}")
            usual = _PORTS.get(page.scheme)
            ports = [each.port or usual for each in (page, here)]
        except ValueError:
            return False
        if usual is None or page.path or page.query or page.fragment or page.username is not None:
            return False
        safe = page.scheme == "https" or not self._encrypted
        return safe and page.hostname == here.hostname and ports[0] == ports[1]


def _only(headers: Headers, name: str) -> str | None:
    """The value of a header that may come once; None if it does not come.

    Raises
    ------
    RefusedError
        It comes more than once.
    """
    values = headers.getlist(name)
    if len(values) > 1:
        raise RefusedError.of("ambiguous", f"the header {name} came {len(values)} times")
    return values[0] if values else None
