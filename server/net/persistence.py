"""Parts by which a world outlasts its process: checkpoints, seats, ids that are given away once."""

import asyncio
from typing import Final

import structlog

from esplanade.server.checkpoint.ids import BLOCK, Block, reserve
from esplanade.server.checkpoint.seat_keeper import SeatKeeper
from esplanade.server.checkpoint.writer import CheckpointWriter
from esplanade.server.metrics import Metrics
from esplanade.server.store.store import Store, StoreError
from esplanade.server.world.inputs import IdsReserved, Input
from esplanade.server.world.zone import Zone

PAUSE_S: Final = 0.5
"""If no ids can be reserved, it is tried again after this time."""

log = structlog.get_logger(__name__)


class Persistence:
    """Sees between ticks to what the store has of a zone. The event loop never waits for it."""

    def __init__(
        self,
        zone: Zone,
        store: Store,
        seats: SeatKeeper | None = None,
        writer: CheckpointWriter | None = None,
    ) -> None:
        """Without `seats` and `writer`, nothing outlasts the process."""
        self._zone = zone
        self._store = store
        self.seats = seats
        self._writer = writer
        self._held = False
        self._reserving: asyncio.Task[None] | None = None
        self._reserved: list[Block] = []

    def drain(self) -> list[Input]:
        """Return the ids that were reserved since; it has more reserved in good time."""
        if self.seats is None:
            return []
        reserved, self._reserved = self._reserved, []
        is_low = self._zone.state.ids_left < BLOCK // 2 and not reserved
        if is_low and (self._reserving is None or self._reserving.done()):
            self._reserving = asyncio.create_task(self._reserve())
        return [IdsReserved(block.first, block.end) for block in reserved]

    def hold(self) -> None:
        """Take no checkpoints until `go_on`."""
        self._held = True

    def go_on(self) -> None:
        """Take checkpoints again."""
        self._held = False

    def between_ticks(self, now_s: float) -> None:
        """Take a checkpoint, if one is due."""
        if self._writer is not None and not self._held:
            self._writer.between_ticks(self._zone.tick, now_s)

    async def begin(self) -> None:
        """Write the checkpoint of a world before its first tick."""
        if self._writer is not None:
            await self._writer.begin(self._zone.tick)

    async def stop(self, *, in_order: bool) -> None:
        """Write all that is left; with a last checkpoint if the world has ended in good order."""
        if self.seats is not None:
            await self.seats.stop()
        if self._reserving is not None:
            self._reserving.cancel()
        if self._writer is not None:
            await self._writer.end(self._zone.tick if in_order and not self._held else None)

    async def _reserve(self) -> None:
        world = self._store.world
        try:
            self._reserved.append(
                await self._store.write(lambda connection: reserve(connection, world))
            )
        except StoreError as error:
            log.error("no ids can be reserved", fault=str(error))  # noqa: TRY400
            await asyncio.sleep(PAUSE_S)


def watch(seats: SeatKeeper, writer: CheckpointWriter, metrics: Metrics) -> None:
    """Tell in the metrics how it goes."""
    metrics.total("checkpoints", "Checkpoints that were written", lambda: writer.written)
    metrics.total(
        "checkpoints_left_out",
        "Checkpoints not taken, since the one before was not written yet",
        lambda: writer.left_out,
    )
    metrics.total(
        "checkpoints_failed", "Checkpoints that could not be written", lambda: writer.failures
    )
    metrics.gauge("checkpoint_bytes", "Bytes of the latest checkpoint", lambda: writer.bytes)
    metrics.gauge("checkpoint_age_seconds", "Time since a checkpoint was written", writer.age_s)
    metrics.gauge(
        "checkpoint_taking_seconds",
        "Time that the latest checkpoint took between two ticks",
        lambda: writer.taking_s,
    )
    metrics.gauge("seats_waiting", "Changes of seats that wait", lambda: seats.waiting)
