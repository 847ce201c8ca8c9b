"""A client for scripts that tune a world while it runs."""

import asyncio
from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager
from typing import Any

from esplanade.operators import http
from esplanade.operators.accounts import Accounts
from esplanade.protocol.commands import Answer, Command


class Operator:
    """A client with the rights of an operator's token.

    Each method raises `RefusedError` where the server refuses, and `UnreachableError` where there
    is none.
    """

    def __init__(self, url: str, token: str) -> None:
        self._url = url
        self._token = token
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

    async def set(
        self,
        *,
        group: str | None = None,
        actor: str | None = None,
        note: str | None = None,
        dry_run: bool = False,
        if_revision: int | None = None,
        **values: float,
    ) -> Answer:
        """Set parameters of the world, or of a group, or of an actor."""
        return await self.send(
            {
                "op": "set_parameters",
                "scope": scope_text(group, actor),
                "values": values,
                "note": note,
                "dry_run": dry_run,
                "if_revision": if_revision,
            }
        )

    async def undo(self, change: int | None = None) -> Answer:
        """Take a change back, or your own latest."""
        return await self.send({"op": "revert", "change": change or "latest"})

    async def redo(self) -> Answer:
        """Make anew what you took back last."""
        return await self.send({"op": "revert", "change": "undone"})

    async def send(self, command: Command | Mapping[str, Any]) -> Answer:
        """Send one command."""
        return Answer.model_validate(await self._ask("/commands", _plain(command)))

    async def send_all(self, *commands: Command | Mapping[str, Any]) -> list[Answer]:
        """Send commands that are carried out in one tick: all of them, or none."""
        answers = await self._ask("/commands", [_plain(command) for command in commands])
        return [Answer.model_validate(answer) for answer in answers]

    async def _ask(self, path: str, body: Any = None, method: str | None = None) -> Any:
        return await asyncio.to_thread(http.ask, self._url, self._token, path, body, method)


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


def scope_text(group: str | None, actor: str | None) -> str:
    """A scope as commands name it: the world, unless there is a group or an actor."""
    if group is not None and actor is not None:
        raise ValueError("a scope is a group or an actor, not both")
    if group is not None:
        return f"group:{group}"
    return "world" if actor is None else f"actor:{actor}"


def _plain(command: Command | Mapping[str, Any]) -> dict[str, Any]:
    if isinstance(command, Mapping):
        return dict(command)
    return command.model_dump(mode="json")
