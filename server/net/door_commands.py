"""Doors that operators move by a click while they walk: commands like any other, in the audit."""

import asyncio
from collections.abc import Awaitable, Callable
from typing import Any, Final, Protocol

import structlog

from esplanade.protocol import ErrorCode, ProtocolError
from esplanade.protocol.commands import MoveDoor
from esplanade.protocol.messages import SetDoor
from esplanade.server.accounts.identity import Identity
from esplanade.server.accounts.rights import Right
from esplanade.server.console.refusals import RefusedError
from esplanade.server.net.guests import Guest
from esplanade.server.net.operator_keys import SERVICE
from esplanade.server.store.store import StoreError

Again = Callable[[Identity], Awaitable[Identity | None]]
"""Looks up which rights an operator still has."""
MOST: Final = 256
"""Doors that wait to be moved; of each door the latest wish counts."""
PAUSE_S: Final = 0.25
"""Between two commands, so that wishes without end do not fill the audit."""

log = structlog.get_logger(__name__)


class Commands(Protocol):
    """The one path of operators' commands."""

    def carry_out(self, by: Identity, commands: list[Any]) -> Awaitable[object]:
        """Carry out commands in a tick, or raise RefusedError."""


class DoorCommands:
    """Carries out wishes for doors, one after the other; rights are looked up anew for each."""

    def __init__(self, commands: Commands, again: Again) -> None:
        self._commands = commands
        self._again = again
        self._wishes: dict[str, tuple[Guest, SetDoor]] = {}
        self._running: asyncio.Task[None] | None = None

    @property
    def waiting(self) -> int:
        """Doors that wait."""
        return len(self._wishes)

    def ask(self, session: Guest, wish: SetDoor) -> None:
        """Move a door soon; a later wish for the same door takes its place."""
        if wish.name not in self._wishes and len(self._wishes) >= MOST:
            session.tell(ProtocolError(ErrorCode.FLOODING, "too many doors wait already", None))
            return
        self._wishes[wish.name] = session, wish
        if self._running is None or self._running.done():
            self._running = asyncio.create_task(self._run())

    async def _run(self) -> None:
        while self._wishes:
            session, wish = self._wishes.pop(next(iter(self._wishes)))
            fault = await self._move(session, wish)
            if fault is not None:
                session.tell(fault)
            await asyncio.sleep(PAUSE_S)

    async def _move(self, session: Guest, wish: SetDoor) -> ProtocolError | None:
        before = session.operator
        try:
            # A person who said the key has no account that could be looked up.
            by = before if before is SERVICE else before and await self._again(before)
            if by is None or Right.DOORS not in by.rights:
                session.operator = by
                text = "you may not open and close doors any more"
                return ProtocolError(ErrorCode.FORBIDDEN, text, None)
            command = MoveDoor(op="move_door", door=wish.name, open=wish.open)
            await self._commands.carry_out(by, [command])
        except RefusedError as error:
            return ProtocolError(ErrorCode.INVALID, f"set_door: {error}", None)
        except StoreError as error:
            log.warning("door not moved", door=wish.name, fault=str(error))
            return ProtocolError(ErrorCode.INVALID, "set_door: try again later", None)
        return None
