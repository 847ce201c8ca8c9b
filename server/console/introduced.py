"""Callers who were known elsewhere: a gateway has looked at what they show, and tells who they are.

What they may do is looked up again here, so that nobody does more than their account may at that
moment, whatever was told.
"""

from collections.abc import Awaitable, Callable
from dataclasses import dataclass, replace
from typing import Final

from starlette.requests import HTTPConnection

from esplanade.server.accounts.identity import Identity
from esplanade.server.accounts.rights import Right
from esplanade.server.accounts.sessions import Sessions
from esplanade.server.accounts.tokens import Tokens
from esplanade.server.console.callers import Callers, Credential
from esplanade.server.console.origins import Origins
from esplanade.server.console.refusals import RefusedError
from esplanade.server.link.calls import Caller

INTRODUCED: Final = "esplanade.caller"
"""Where the scope of a request has who asks."""


@dataclass(frozen=True, slots=True)
class _Introduction(Credential):
    caller: Caller


class IntroducedCallers(Callers):
    """Knows callers by what the scope of a request tells of them, and by nothing that they send."""

    def __init__(
        self,
        tokens: Tokens,
        sessions: Sessions,
        again: Callable[[Identity], Awaitable[Identity | None]],
    ) -> None:
        """`again` looks up which role and rights an account has now."""
        super().__init__(tokens, sessions, Origins(), lambda peer, _: peer)
        self._again = again

    def credential(self, request: HTTPConnection) -> Credential:
        """The introduction of whoever asks.

        Raises
        ------
        RefusedError
            There is none.
        """
        caller: Caller | None = request.scope.get(INTRODUCED)
        if caller is None:
            raise RefusedError.of("unauthorized", "nobody has said who asks")
        return _Introduction("", is_session=False, address=caller.address or "", caller=caller)

    async def found(self, credential: Credential, *, used: bool) -> Identity:  # noqa: ARG002
        """Return the identity of who was introduced, with what rights are left of those told.

        Raises
        ------
        RefusedError
            The account is gone.
        StoreError
            It cannot be looked up.
        """
        assert isinstance(credential, _Introduction)  # noqa: S101 (they are made above)
        caller = credential.caller
        told = Identity(
            account=caller.account,
            role=caller.role,
            rights=frozenset(right for right in Right if right.value in caller.rights),
            via=caller.via,
            address=caller.address,
        )
        now = await self._again(told)
        if now is None:
            raise RefusedError.of("unauthorized", f"there is no account {caller.account} any more")
        return replace(now, rights=now.rights & told.rights)
