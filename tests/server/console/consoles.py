"""A console on a small world that ticks as fast as it can, with a clock that a test moves."""

import asyncio
from collections.abc import AsyncIterator, Callable, Iterable
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from typing import Any

from esplanade.protocol.commands import COMMAND, Answer
from esplanade.server.accounts.directory import Directory
from esplanade.server.accounts.identity import MACHINE, Identity
from esplanade.server.accounts.passwords import Passwords
from esplanade.server.accounts.rights import ROLES
from esplanade.server.audit.log import AuditLog
from esplanade.server.console.console import Console
from esplanade.server.console.preset_folder import read_presets
from esplanade.server.console.presets import Presets
from esplanade.server.console.refusals import RefusedError
from esplanade.server.store.sql_store import SqlStore
from tests.patience import PATIENCE_S
from tests.server.populated import Populated


class Nobody:
    """A world without people."""

    def name_of(self, person: int) -> str | None:
        return None

    def muted_s(self, person: int) -> float:
        return 0.0

    def within(self, **_: Any) -> list[int]:
        return []

    def announce(self, text: str, people: Iterable[int]) -> int:
        return 0

    def kick(self, person: int, text: str) -> None:
        """There is nobody."""

    def mute(self, person: int, seconds: float, text: str) -> None:
        """There is nobody."""


@dataclass
class Clock:
    """A clock that stands still until it is moved, in microseconds since 1970."""

    now_us: int = 1_800_000_000_000_000

    def __call__(self) -> int:
        return self.now_us

    def pass_s(self, seconds: float) -> None:
        self.now_us += round(1e6 * seconds)


@dataclass
class Desk:
    """Sends commands to a console as somebody."""

    console: Console
    world: Populated
    clock: Clock
    audit: AuditLog
    told: list[tuple[str, dict[str, Any]]] = field(default_factory=list)

    async def send(self, *commands: dict[str, Any], who: str = "olga") -> list[Answer]:
        given = [COMMAND.validate_python(each) for each in commands]
        return await self.console.carry_out(tuner(who), given)

    async def refused(self, *commands: dict[str, Any], who: str = "olga") -> RefusedError:
        """Return the refusal of commands, which must be refused."""
        try:
            answers = await self.send(*commands, who=who)
        except RefusedError as error:
            return error
        raise AssertionError(f"not refused: {answers}")

    def value(self, actor: str, name: str) -> Any:
        return getattr(self.world.zone.parameters(actor), name)

    async def until(self, holds: Callable[[], bool]) -> None:
        """Wait until something holds."""
        async with asyncio.timeout(PATIENCE_S):
            while not holds():  # noqa: ASYNC110 (it is no event of ours)
                await asyncio.sleep(0.005)


def tuner(name: str, role: str = "director") -> Identity:
    """An operator who came in by a token."""
    return Identity(account=name, role=role, rights=ROLES[role], via="token t")


@asynccontextmanager
async def desk(
    world: Populated, store: SqlStore, clock: Clock | None = None
) -> AsyncIterator[Desk]:
    """A console on a world, loaded from a store, and ticks until the end."""
    clock, audit = clock or Clock(), AuditLog(store, "server")
    presets = Presets(read_presets(None))
    console = Console(world.zone, Nobody(), store, audit, presets=presets, clock_us=clock)
    await console.load_operated()
    found = Desk(console, world, clock, audit)
    console.listen(lambda kind, what: found.told.append((kind, what)))
    ticking = asyncio.create_task(_tick(world, console))
    try:
        yield found
    finally:
        await console.close()
        ticking.cancel()
        await asyncio.gather(ticking, return_exceptions=True)


async def add_account(store: SqlStore, name: str, role: str) -> Directory:
    """Make an account; returns the directory that has it."""
    passwords = Passwords()
    passwords.close()
    directory = Directory(store, AuditLog(store, "test"), passwords)
    await directory.add(MACHINE, name, role, None)
    return directory


async def _tick(world: Populated, console: Console) -> None:
    while True:
        console.take(world.frame(*console.drain()))
        await asyncio.sleep(0.0)
