"""A client for scripts that tune a world while it runs."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

from esplanade.operators.accounts import Accounts
from esplanade.operators.directing import Directing
from esplanade.operators.tuning import Tuning


class Operator(Tuning, Directing):
    """A client with the rights of an operator's token.

    Each method raises `RefusedError` where the server refuses, and `UnreachableError` where there
    is none.
    """

    def __init__(self, url: str, token: str) -> None:
        super().__init__(url, token)
        self.accounts = Accounts(self._ask)
        """Accounts, tokens, invitations and bots."""

    async def world(self) -> dict[str, Any]:
        """The zone at this moment: tick, people, actors, doors, places, revision."""
        return dict(await self._ask("/world"))

    async def actors(self) -> list[dict[str, Any]]:
        """All actors at this moment."""
        return list((await self._ask("/actors"))["actors"])

    async def actor(self, actor: str) -> dict[str, Any]:
        """One actor, with each parameter and where it comes from."""
        return dict(await self._ask(f"/actors/{actor}"))

    async def people(self) -> list[dict[str, Any]]:
        """Everyone who is connected."""
        return list((await self._ask("/people"))["people"])


@asynccontextmanager
async def connect(url: str, token: str) -> AsyncIterator[Operator]:
    """An operator of the server at that address, whose token opens it.

    Raises
    ------
    RefusedError
        The token opens nothing.
    UnreachableError
        There is no server.
    """
    operator = Operator(url, token)
    await operator.world()
    yield operator
