"""Servers that speak the protocol and do one thing badly, for what a load test says of them."""

import asyncio
from contextlib import suppress
from typing import Any

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed

from esplanade.protocol.messages import ClientMessage, Ping
from tests.bots.scripted import Person, ScriptedServer


class Sparse(ScriptedServer):
    """Sends so many of its 20 snapshots a second, and counts its ticks as it should."""

    per_second = 2.6

    def _snapshot(self, person: Person) -> bytes:
        share = self.per_second / self.tick_rate
        due = int(self.tick * share) > int((self.tick - 1) * share)
        return super()._snapshot(person) if due else b"\x91\x7f"  # [127], a message of the future


class Sleepy(ScriptedServer):
    """Stands still at the word of a test, pongs and all, like a process that is stopped.

    With `gives_up`, its clock and its ticks go on afterwards as if no time had passed.
    """

    def __init__(self, gives_up: bool = True, **settings: Any) -> None:
        super().__init__(**settings)
        self.gives_up = gives_up
        self.awake = asyncio.Event()
        self.awake.set()

    async def stand_still(self, seconds: float) -> float:
        """The time for which it really stood still."""
        loop = asyncio.get_running_loop()
        self.awake.clear()
        began_s = loop.time()
        await asyncio.sleep(seconds)
        stood_s = loop.time() - began_s
        if self.gives_up:
            self._loop_start_s += stood_s
        else:
            self.tick += round(stood_s * self.tick_rate)
        self.awake.set()
        return stood_s

    async def _hear(self, person: Person, message: ClientMessage) -> None:
        await self.awake.wait()
        await super()._hear(person, message)

    async def _before_tick(self) -> None:
        await self.awake.wait()


class Mute(ScriptedServer):
    """Never answers a ping."""

    async def _hear(self, person: Person, message: ClientMessage) -> None:
        if not isinstance(message, Ping):
            await super()._hear(person, message)


class Unwelcoming(ScriptedServer):
    """Takes every connection and never answers hello."""

    async def talk(self, socket: ServerConnection) -> None:
        with suppress(ConnectionClosed):
            await socket.wait_closed()


class Closing(ScriptedServer):
    """Closes every connection soon after its welcome."""

    close_code = 4008

    async def talk(self, socket: ServerConnection) -> None:
        loop = asyncio.get_running_loop()
        closing = loop.call_later(0.3, lambda: loop.create_task(socket.close(self.close_code)))
        try:
            await super().talk(socket)
        finally:
            closing.cancel()
