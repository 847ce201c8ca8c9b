"""Takes a checkpoint every second between two ticks, and writes it in other threads."""

import asyncio
import time
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Final

import structlog

from esplanade.server.checkpoint.format import FORMAT, digest, pack
from esplanade.server.checkpoint.parts import Parts
from esplanade.server.checkpoint.rows import KeptCheckpoint, write_checkpoint
from esplanade.server.checkpoint.scene import SceneKey
from esplanade.server.store.store import Store, StoreError

EVERY_S: Final = 1.0

log = structlog.get_logger(__name__)


class CheckpointWriter:
    """Has at most one checkpoint under way; while the store is slow, later ones are left out."""

    def __init__(self, parts: Parts, store: Store, scene: SceneKey) -> None:
        self._parts = parts
        self._store = store
        self._scene = scene
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="checkpoint")
        self._due_s = 0.0
        self._writing: asyncio.Task[None] | None = None
        self._ended = False
        self.written = 0
        """Checkpoints that are in the store."""
        self.left_out = 0
        """Checkpoints that were not taken, since the one before was not written yet."""
        self.failures = 0
        """Checkpoints that could not be taken or written."""
        self.bytes = 0
        """Bytes of the latest."""
        self.taking_s = 0.0
        """Time that the latest took between two ticks."""
        self._written_at_s = time.monotonic()

    def age_s(self) -> float:
        """Seconds since the latest was committed."""
        return time.monotonic() - self._written_at_s

    def between_ticks(self, tick: int, now_s: float) -> None:
        """Take a checkpoint if one is due; the world must not change meanwhile."""
        if now_s < self._due_s or self._ended:
            return
        self._due_s = now_s + EVERY_S
        if self._writing is not None and not self._writing.done():
            self.left_out += 1
            return
        start = time.perf_counter()
        try:
            saved = self._parts.save()
        except Exception:
            # The world goes on, as it does when the store fails.
            log.exception("no checkpoint can be taken", tick=tick)
            self.failures += 1
            return
        self.taking_s = time.perf_counter() - start
        self._writing = asyncio.create_task(self._write(saved, tick))

    async def begin(self, tick: int) -> None:
        """Write the checkpoint of a world that begins, so that nothing happens before there is one.

        It is no fault of the start if that fails: the next one is due with the first tick.
        """
        await self._write(self._parts.save(), tick)

    async def end(self, tick: int | None) -> None:
        """Finish what is under way; with a tick, take a last checkpoint of the world after it."""
        self._ended = True
        if self._writing is not None:
            await self._writing
        if tick is not None:
            await self._write(self._parts.save(), tick)
        self._thread.shutdown()

    async def _write(self, saved: dict[str, Any], tick: int) -> None:
        try:
            payload = await asyncio.get_running_loop().run_in_executor(self._thread, pack, saved)
            kept = KeptCheckpoint(
                made_us=time.time_ns() // 1000,
                tick=tick,
                scene=self._scene.digest,
                scene_name=self._scene.name,
                format=FORMAT,
                digest=digest(payload),
                payload=payload,
            )
            zone = self._store.zone
            await self._store.write(lambda connection: write_checkpoint(connection, zone, kept))
        except StoreError as error:
            self.failures += 1
            log.error("a checkpoint is not written", tick=tick, fault=str(error))  # noqa: TRY400
            return
        except Exception:
            self.failures += 1
            log.exception("a checkpoint cannot be packed", tick=tick)
            return
        self.written += 1
        self.bytes = len(payload)
        self._written_at_s = time.monotonic()
