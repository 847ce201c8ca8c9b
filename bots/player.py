"""Plays a user's scenario with one client, and counts what goes wrong in it."""

import asyncio
import random
from typing import Final

from esplanade.bots.client import Client
from esplanade.bots.errors import BotError
from esplanade.bots.events import SnapshotEvent
from esplanade.bots.scenario import Scenario
from esplanade.bots.scenario_file import where
from esplanade.bots.tally import Tally
from esplanade.bots.view import View
from esplanade.protocol import ServerCode, decode_server
from esplanade.protocol.messages import Enter, Leave, Point, Snapshot
from esplanade.protocol.snapshot import unpack_block

MAX_FAULTS: Final = 20
"""This many different errors of a scenario are told; all others are counted together."""

_SEEN: Final = frozenset(
    {ServerCode.SNAPSHOT, ServerCode.ENTER, ServerCode.LEAVE, ServerCode.POINT}
)


class Player:
    """One bot of a scenario. The scenario runs beside the reading, so that it delays no measure."""

    def __init__(
        self, kind: type[Scenario], client: Client, index: int, seed: int, tally: Tally
    ) -> None:
        self._kind = kind
        self._client = client
        self._index = index
        self._seed = seed
        self._tally = tally
        self._view = View(client.welcome)
        self._ticked = asyncio.Event()

    def see(self, frame: bytes) -> None:
        """Keep up to date who is where."""
        if len(frame) < 2 or frame[1] not in _SEEN:
            return
        match decode_server(frame):
            case Snapshot(tick=tick, ack=ack, block=block):
                origin = self._client.welcome.origin
                self._view.snapshot(SnapshotEvent(tick, ack, unpack_block(block), origin))
                if self._view.placed:
                    self._ticked.set()
            case Enter() as message:
                self._view.enter(message)
            case Leave() as message:
                self._view.leave(message)
            case Point() as message:
                self._view.point(message)

    async def play(self) -> None:
        """Play until an error of the scenario, which is counted. Raises BotError."""
        await self._ticked.wait()
        try:
            scenario = self._kind()
            scenario._client, scenario._view = self._client, self._view  # noqa: SLF001
            scenario.welcome = self._client.welcome
            scenario.index = self._index
            scenario.random = random.Random(f"{self._seed}/{self._index}")
            await scenario.on_join()
            while True:
                await self._ticked.wait()
                self._ticked.clear()
                await scenario.on_tick(self._view.tick)
        except BotError:
            raise
        except (Exception, SystemExit) as error:  # noqa: BLE001 (anything may go wrong there)
            self._count(where(error, self._kind))

    def _count(self, fault: str) -> None:
        faults = self._tally.scenario_faults
        faults[fault if fault in faults or len(faults) < MAX_FAULTS else "other errors"] += 1
