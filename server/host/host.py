"""A host: claims a zone, runs it, gives it back; waits for one where all have owners."""

import asyncio
import tempfile
from collections.abc import AsyncIterator, Iterable, Sequence
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Final

import structlog
from nats.aio.msg import Msg

from esplanade.server.cluster import copy_rows, ownership
from esplanade.server.cluster.processes import HOST, processes
from esplanade.server.cluster.tenure import Claim, Tenure
from esplanade.server.cluster.world_rows import ClusterWorld, world_kept, write_files
from esplanade.server.copies import Copies
from esplanade.server.heartbeat import Heartbeat
from esplanade.server.host.hosted_zone import HostedZone, HostProcess, hosted_zone
from esplanade.server.host.operators import HostOperators
from esplanade.server.host.renewal import Renewal
from esplanade.server.host.zone_recovery import Found, build
from esplanade.server.link.hints import MODERATION, OWNERSHIPS, hint, hinting
from esplanade.server.metrics import Metrics
from esplanade.server.moderation.sharing import SharedModeration
from esplanade.server.settings import ServerSettings
from esplanade.server.store.store import Store, StoreError
from esplanade.server.zones import ZoneToServe, zones_to_serve

CLAIM_S: Final = 0.5
"""A host without a zone asks for one so often, and at once where somebody gives one back."""
LOOK_S: Final = 1.0
"""So often an owner looks whether another host is to have its zone."""
UNWANTED_S: Final = 10.0
"""A copy of a zone is shut when it has been empty and of no use for so long."""

log = structlog.get_logger(__name__)


@dataclass(frozen=True)
class HostedWorld:
    """The world of a cluster as a host has read it."""

    kept: ClusterWorld
    zones: list[ZoneToServe]
    """All zones, in the order of the world's file."""

    @property
    def copied(self) -> set[Copies]:
        """The zones that have copies."""
        return {zone.copies for zone in self.zones if zone.copies is not None}

    def zone(self, name: str) -> tuple[int, ZoneToServe]:
        """The place of a zone, and the zone."""
        return next((k, zone) for k, zone in enumerate(self.zones) if zone.name == name)


@asynccontextmanager
async def world_of_cluster(store: Store, settings: ServerSettings) -> AsyncIterator[HostedWorld]:
    """Read the world of the cluster from the database. Its files are there until the end: meshes
    are read again when a zone is built.

    Raises
    ------
    StoreError
        The database does not answer, or has no world yet.
    LoadingError
        The world cannot be run by this program.
    """
    with tempfile.TemporaryDirectory(prefix="esplanade-world-") as folder:
        path = await store.read(partial(_write_files, Path(folder)))
        kept = await store.read(world_kept)
        named = settings.model_copy(update={"world": path})
        zones = await asyncio.to_thread(zones_to_serve, named)
        yield HostedWorld(kept, sorted(zones, key=lambda zone: zone.name))


class Host:
    """One process that runs one zone at a time, of those that it may claim."""

    def __init__(
        self,
        name: str,
        world: HostedWorld,
        wanted: Sequence[str],
        process: HostProcess,
        operators: HostOperators,
        metrics: Metrics,
        stop: asyncio.Event,
    ) -> None:
        """`wanted` names the zones that it may claim; all of them where it is empty."""
        self.name = name
        self._world = world
        self._wanted = list(wanted) or [zone.name for zone in world.zones]
        self._process = process
        self._store, self._broker, self._subjects = process.store, process.broker, process.subjects
        self._operators = operators
        self._moderation = SharedModeration(process.kept.moderation)
        self._metrics = metrics
        self._stop = stop
        self._ready = False
        self._owned = 0
        self._hint = asyncio.Event()
        self.running: HostedZone | None = None
        """The zone that it runs."""
        metrics.gauge("zones_owned", "Zones that run here", lambda: int(self.running is not None))
        metrics.total("ownerships", "Zones that were claimed here", lambda: self._owned)

    @property
    def hindrance(self) -> str | None:
        """The reason for which this host can run no zone; None if it can."""
        return None if self._ready else "starting"

    async def run(self) -> None:
        """Claim and run zones until told to stop, or drained.

        Raises
        ------
        StoreError
            The database does not answer at the begin.
        LoadingError
            A zone that was claimed cannot be run.
        """
        heartbeat = Heartbeat(self._store, self.name, HOST, "", self._people)
        await heartbeat.begin()
        beating = asyncio.create_task(heartbeat.run())
        beating.add_done_callback(lambda _: self._stop.set())
        looking = asyncio.create_task(self._moderation.run())
        self._process.kept.moderation.decided.append(
            hinting(self._broker, self._subjects, MODERATION)
        )
        hints = await self._broker.subscribe(self._subjects.control, cb=self._hear)
        try:
            while not self._stop.is_set():
                claim = await self._claim()
                if claim is not None:
                    await self._own(claim)
        finally:
            beating.cancel()
            looking.cancel()
            if not self._broker.is_closed:
                await hints.unsubscribe()
            await heartbeat.end()

    def _people(self) -> int:
        return 0 if self.running is None else self.running.world.count()[0]

    def warm_up(self) -> None:
        """Build a zone and let go of it: everything is compiled before anybody waits for that.

        It takes a while, and is meant for a thread.

        Raises
        ------
        LoadingError
            The zone cannot be run.
        """
        place, zone = self._world.zone(self._wanted[0])
        population, _, _ = build(zone, place, Found())
        population.close()
        self._ready = True
        log.info("ready to claim", host=self.name, zones=", ".join(self._wanted))

    async def _claim(self) -> Claim | None:
        """Claim a zone, or wait for a while."""
        self._hint.clear()
        try:
            copied = self._world.copied
            claim = await self._store.write(partial(_claim, self.name, self._wanted, copied))
        except StoreError as error:
            log.warning("no zone can be claimed", why=str(error))
            claim = None
        if claim is None:
            waits = [asyncio.create_task(each.wait()) for each in (self._hint, self._stop)]
            await asyncio.wait(waits, timeout=CLAIM_S, return_when=asyncio.FIRST_COMPLETED)
            for each in waits:
                each.cancel()
        return claim

    async def _own(self, claim: Claim) -> None:
        """Run a zone that was claimed, until it is another's or this process ends."""
        log.info("claimed", zone=claim.zone, epoch=claim.epoch, host=self.name)
        await self._tell()
        self._moderation.hear()
        tenure = Tenure(claim)
        renewal = Renewal(self._store, tenure)
        place, zone = self._world.zone(claim.zone)
        renewing = asyncio.create_task(renewal.run())
        metrics = self._metrics.of_zone(zone.name)
        self._owned += 1
        try:
            async with hosted_zone(
                zone,
                place,
                self._world.zones,
                tenure,
                renewal,
                self._process,
                metrics,
            ) as hosted:
                self.running = hosted
                await self._operators.open(claim.zone, claim.epoch, hosted.operated)
                ending = asyncio.create_task(self._end_when_told(hosted, zone.copies))
                log.info("open", zone=claim.zone, epoch=claim.epoch, host=self.name)
                try:
                    await hosted.run()
                finally:
                    ending.cancel()
                    await self._operators.close()
        except StoreError as error:
            log.warning("the zone is not run", zone=claim.zone, why=str(error))
            await asyncio.sleep(CLAIM_S)
        finally:
            self.running = None
            self._metrics.rests(zone.name)
            renewing.cancel()
            await self._give_back(tenure)

    async def _end_when_told(self, hosted: HostedZone, copies: Copies | None) -> None:
        """End a zone when this process is to stop, when another host is to have it, or when it is a
        copy that is of no use."""
        loop = asyncio.get_running_loop()
        wanted_s = loop.time()
        while not self._stop.is_set():
            with suppress(TimeoutError):
                async with asyncio.timeout(LOOK_S):
                    await self._stop.wait()
            with suppress(StoreError):
                if await self._store.read(partial(_moves_on, hosted.tenure.claim)):
                    log.info("another host is to have the zone", zone=hosted.tenure.claim.zone)
                    break
                if copies is None or await self._store.read(
                    partial(_is_wanted, copies, hosted.tenure.claim.zone)
                ):
                    wanted_s = loop.time()
                elif loop.time() - wanted_s >= UNWANTED_S:
                    log.info("the copy is shut", zone=hosted.tenure.claim.zone)
                    break
        hosted.ticker.stop()

    async def _give_back(self, tenure: Tenure) -> None:
        if not tenure.holds:
            return
        tenure.release()
        try:
            await self._store.write(partial(_release, tenure.claim))
        except StoreError as error:
            log.warning("the lease runs out by itself", zone=tenure.claim.zone, why=str(error))
            return
        log.info("given back", zone=tenure.claim.zone, host=self.name)
        await self._tell()

    async def _tell(self) -> None:
        """Let other hosts look at once; whoever does not hear it looks half a second later."""
        await hint(self._broker, self._subjects, OWNERSHIPS)

    async def _hear(self, message: Msg) -> None:
        if message.data == MODERATION:
            self._moderation.hear()
        else:
            self._hint.set()


def _write_files(folder: Path, connection: Any) -> Path:
    return write_files(connection, folder)


def _claim(host: str, zones: list[str], copied: Iterable[Copies], connection: Any) -> Claim | None:
    claimed = copy_rows.claim(connection, host, zones, copied)
    if claimed is not None:
        # The host that was to have it has it: from now on any host may follow.
        ownership.want(connection, claimed.zone, None)
    return claimed


def _is_wanted(copies: Copies, zone: str, connection: Any) -> bool:
    return copy_rows.is_wanted(connection, copies, zone)


def _release(claim: Claim, connection: Any) -> None:
    ownership.release(connection, claim)


def _moves_on(claim: Claim, connection: Any) -> bool:
    """Whether another host is to have the zone, and is there."""
    wanted = {each.zone: each.wanted_host for each in ownership.ownerships(connection)}
    there = {each.name for each in processes(connection) if each.kind == HOST and each.is_there}
    return wanted.get(claim.zone) not in {None, claim.host} and wanted[claim.zone] in there
