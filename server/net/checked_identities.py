"""The names that proxies in front have for people whom they have let in."""

from typing import Final

from websockets.http11 import Request

from esplanade.server.net.addresses import TrustedProxies

MAX_CHARS: Final = 256


class CheckedIdentities:
    """Reads the name in a header, from trusted proxies only; anybody else may have made it up."""

    def __init__(self, header: str, proxies: TrustedProxies) -> None:
        """Without a name of a header nobody is known."""
        self._header = header
        self._proxies = proxies

    def of(self, peer: str, request: Request) -> str | None:
        """The name of whoever is behind a peer; None if nobody who is trusted tells one."""
        if not self._header or not self._proxies.trusts(peer):
            return None
        values = request.headers.get_all(self._header)
        # A proxy that hands on the header of its client beside its own cannot be believed.
        if len(values) != 1 or not 0 < len(values[0].strip()) <= MAX_CHARS:
            return None
        return values[0].strip()
