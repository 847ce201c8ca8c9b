"""The zones that a gateway shows: each is opened when the first of its people comes there."""

import asyncio
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, Final

import structlog
from nats.aio.client import Client
from nats.aio.msg import Msg

from esplanade.protocol import CloseCode, ErrorCode, ProtocolError
from esplanade.server.cluster.zone_rows import description_of
from esplanade.server.gateway.meshes import Meshes
from esplanade.server.gateway.zone_view import ZoneView
from esplanade.server.link.answers import AnswerError, decode_answers
from esplanade.server.link.subjects import Subjects
from esplanade.server.link.zone_description import DescriptionError, decode_description
from esplanade.server.metrics import Metrics
from esplanade.server.net.session import Session
from esplanade.server.settings import ServerSettings
from esplanade.server.store.store import Store, StoreError

ANSWER_S: Final = 5.0
"""A database that has not answered by then is away."""

log = structlog.get_logger(__name__)


class ZonesAwayError(ProtocolError):
    """A zone has not told anything of itself yet."""

    def __init__(self, zone: str) -> None:
        super().__init__(
            ErrorCode.BUSY,
            f"the zone {zone} is not there just now; come again in a moment",
            CloseCode.BUSY,
        )


class Views:
    """The views of zones of one gateway, by the zones' names."""

    def __init__(
        self,
        gateway: str,
        store: Store,
        broker: Client,
        subjects: Subjects,
        settings: ServerSettings,
        metrics: Metrics,
        meshes: Meshes,
        depart: Callable[[Session, bool], None],
        confirm: Callable[[Session], None],
    ) -> None:
        self._open: dict[str, ZoneView] = {}
        self._running: list[asyncio.Task[None]] = []
        self._opening = asyncio.Lock()
        self._gateway = gateway
        self._store = store
        self._broker = broker
        self._subjects = subjects
        self._settings = settings
        self._metrics = metrics
        self._meshes = meshes
        self._depart = depart
        self._confirm = confirm

    def __iter__(self) -> Iterator[ZoneView]:
        return iter(list(self._open.values()))

    def get(self, zone: str) -> ZoneView | None:
        """The view of a zone, if it is open."""
        return self._open.get(zone)

    async def opened(self, zone: str) -> ZoneView:
        """The view of a zone, which is opened where nobody of this gateway is there yet.

        Raises
        ------
        ProtocolError
            The zone has never been run, or the database does not answer.
        """
        async with self._opening:
            known = self._open.get(zone)
            if known is not None:
                return known
            try:
                async with asyncio.timeout(ANSWER_S):
                    found = await self._store.read(partial(_description_of, zone))
                if found is None:
                    raise ZonesAwayError(zone)
                description = decode_description(found[1])
            except (StoreError, TimeoutError, DescriptionError) as error:
                log.warning("a zone cannot be shown", zone=zone, why=str(error) or "no answer")
                raise ZonesAwayError(zone) from None
            await self._meshes.provide(description.mesh)
            view = ZoneView(
                zone,
                description,
                self._gateway,
                self._broker,
                self._subjects,
                self._settings,
                self._metrics.of_zone(zone),
                self._depart,
                self._confirm,
            )
            self._open[zone] = view
            task = asyncio.create_task(view.run())
            task.add_done_callback(_ended)
            self._running.append(task)
            return view

    async def send(self) -> None:
        """Send to each zone what people want there."""
        for view in self:
            await view.send()

    async def answered(self, message: Msg) -> None:
        """Take in what a host says to single people."""
        try:
            zone, answers = decode_answers(message.data)
        except AnswerError as error:
            log.warning("bad answers", error=str(error))
            return
        view = self._open.get(zone)
        if view is not None:
            for answer in answers:
                view.answered(answer)

    async def close(self) -> None:
        """Show no zone any more."""
        for task in self._running:
            task.cancel()
        await asyncio.gather(*self._running, return_exceptions=True)


def _ended(task: "asyncio.Task[None]") -> None:
    if not task.cancelled() and (error := task.exception()) is not None:
        log.error("a zone is shown no more", exc_info=error)


def _description_of(zone: str, connection: Any) -> tuple[int, bytes] | None:
    return description_of(connection, zone)
