"""Callers on the private port, known by a script's token or by the cookie of a session."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from starlette.requests import HTTPConnection

from esplanade.server.accounts.identity import Identity
from esplanade.server.accounts.sessions import Sessions
from esplanade.server.accounts.tokens import Tokens
from esplanade.server.console.origins import Origins
from esplanade.server.console.refusals import RefusedError

HEADER: Final = "X-Esplanade"
"""Pages of others cannot send this header: requests that change something must have it."""
COOKIE: Final = "esplanade_session"
SAFE: Final = frozenset({"GET", "HEAD", "OPTIONS"})
RENEWED_S: Final = 30.0
"""Whoever has a socket open is looked up again this often at least."""
_SCHEME: Final = "bearer "


@dataclass(frozen=True, slots=True)
class Credential:
    """The secret that was shown, and the address that it came from."""

    secret: str
    is_session: bool
    address: str


class Callers:
    """Finds out who asks. `address_of` tells the client's address from the socket's other end and
    the lines of `X-Forwarded-For`."""

    def __init__(
        self,
        tokens: Tokens,
        sessions: Sessions,
        origins: Origins,
        address_of: Callable[[str, list[str]], str],
    ) -> None:
        self.origins = origins
        self._tokens = tokens
        self._sessions = sessions
        self._address_of = address_of

    async def identity(self, request: HTTPConnection) -> Identity:
        """Return the identity of whoever sends a request.

        Raises
        ------
        RefusedError
            Nothing opens anything; or a request that changes something comes from a page of
            somebody else, or without the header against forged requests.
        StoreError
            It cannot be looked up.
        """
        credential = self.credential(request)
        if credential.is_session or request.scope.get("method") not in SAFE:
            self.origins.check(request.headers, by_browser=credential.is_session)
        identity = await self.found(credential, used=True)
        if request.scope.get("method") not in SAFE:
            check_header(request)
        return identity

    async def at_socket(self, socket: HTTPConnection) -> "Standing":
        """Return the standing of whoever opens a WebSocket; call it before it is accepted.

        Raises
        ------
        RefusedError
            The page is somebody else's, or nothing opens anything.
        StoreError
            It cannot be looked up.
        """
        credential = self.credential(socket)
        of_browser = credential.is_session
        self.origins.check(socket.headers, by_browser=of_browser, origin_needed=of_browser)
        return await self.standing(credential)

    async def standing(self, credential: Credential) -> "Standing":
        """Return the standing of whoever has shown a secret.

        Raises
        ------
        RefusedError
            It opens nothing.
        StoreError
            It cannot be looked up.
        """
        return Standing(self, credential, await self.found(credential, used=True))

    def check_stranger(self, request: HTTPConnection) -> str:
        """Check a request that changes something and says nothing of who sends it; the address.

        Raises
        ------
        RefusedError
            It comes from a page of somebody else, or without the header.
        """
        self.origins.check(request.headers, by_browser=True)
        check_header(request)
        return self.address(request)

    def credential(self, request: HTTPConnection) -> Credential:
        """The token of a request, or else the cookie of its session.

        Raises
        ------
        RefusedError
            There is none, or more than one.
        """
        given = request.headers.getlist("authorization")
        if len(given) > 1:
            raise RefusedError.of("ambiguous", "the header Authorization came more than once")
        if given:
            if not given[0].lower().startswith(_SCHEME):
                raise RefusedError.of("unauthorized", _SEND_TOKEN)
            secret = given[0][len(_SCHEME) :].strip()
            return Credential(secret, is_session=False, address=self.address(request))
        secrets = session_cookies(request)
        if len(secrets) > 1:
            raise RefusedError.of("ambiguous", f"the cookie {COOKIE} came more than once")
        if not secrets or not secrets[0]:
            raise RefusedError.of("unauthorized", _SEND_TOKEN)
        return Credential(secrets[0], is_session=True, address=self.address(request))

    def address(self, request: HTTPConnection) -> str:
        """The key of the client's address, by which limits go."""
        peer = request.client.host if request.client else "127.0.0.1"
        return self._address_of(peer, request.headers.getlist("x-forwarded-for"))

    async def found(self, credential: Credential, *, used: bool) -> Identity:
        """Return the identity that a secret stands for at this moment.

        Raises
        ------
        RefusedError
            It opens nothing, or no longer.
        StoreError
            It cannot be looked up.
        """
        secret, address = credential.secret, credential.address
        if credential.is_session:
            identity = await self._sessions.identity(secret, address, used=used)
            text = "your session has ended: log in again"
        else:
            identity = await self._tokens.identity(secret, address)
            text = "this token opens nothing, or no longer does"
        if identity is None:
            raise RefusedError.of("unauthorized", text)
        return identity


class Standing:
    """The identity of whoever has a socket open. What was revoked ends it at the next look."""

    def __init__(self, callers: Callers, credential: Credential, identity: Identity) -> None:
        self.identity = identity
        self._callers = callers
        self._credential = credential

    async def renew(self, *, used: bool = False) -> Identity:
        """Look the identity up again, each `RENEWED_S` at least; role and rights may be others.

        An open socket alone does not keep a session from ending; a client that asks for something
        does, which `used` says.

        Raises
        ------
        RefusedError
            The session has ended, or the token opens nothing any more: close the socket.
        StoreError
            It cannot be looked up.
        """
        self.identity = await self._callers.found(self._credential, used=used)
        return self.identity


def session_cookies(request: HTTPConnection) -> list[str]:
    """All values of the session's cookie; a browser sends one, if it has it."""
    pairs = [
        pair.strip().partition("=")
        for line in request.headers.getlist("cookie")
        for pair in line.split(";")
    ]
    return [value for name, _, value in pairs if name == COOKIE]


def check_header(request: HTTPConnection) -> None:
    """Check that a request that changes something has the header against forged ones.

    Raises
    ------
    RefusedError
        It has not.
    """
    if not request.headers.get(HEADER):
        text = f"a request that changes something needs the header {HEADER}: 1"
        raise RefusedError.of("header_missing", text)


_SEND_TOKEN: Final = "send a token of yours, Authorization: Bearer esplanade_…, or log in"  # noqa: S105
