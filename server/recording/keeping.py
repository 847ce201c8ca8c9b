"""Keeps the recordings of a zone that is served: from its beginning, or when operators say so."""

import asyncio
import re
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import structlog

from esplanade.recordings.writing import WritingError
from esplanade.server.file_thread import Ended
from esplanade.server.live.bulletin import Bulletin
from esplanade.server.loading import LoadingError
from esplanade.server.metrics import Metrics
from esplanade.server.recording.errors import NotRecordedError
from esplanade.server.settings import ServerSettings
from esplanade.server.trajectories.writer import free_path
from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import Input
from esplanade.server.world.zone import Zone

if TYPE_CHECKING:
    from esplanade.server.recording.zone_recording import ZoneRecording

log = structlog.get_logger(__name__)


class ZoneRecorder:
    """Writes one recording of a zone after the other into the folder of the settings."""

    def __init__(
        self, settings: ServerSettings, folder: Path, zone: Zone, name: str, bulletin: Bulletin
    ) -> None:
        self._settings = settings
        self._folder = folder
        self._zone = zone
        self._name = name
        self._bulletin = bulletin
        self._recording: ZoneRecording | None = None
        self._closed = 0
        """Seconds of the recordings that have ended."""

    @property
    def is_on(self) -> bool:
        """Whether the zone is being recorded."""
        return self._recording is not None and self._recording.fault is None

    @property
    def waiting(self) -> int:
        """Seconds of the world that wait to be written."""
        return 0 if self._recording is None else self._recording.waiting

    @property
    def written(self) -> int:
        """Seconds of the world that were written, by all recordings."""
        return self._closed + (0 if self._recording is None else self._recording.written)

    @property
    def has_failed(self) -> bool:
        """Whether the latest recording has ended before anybody wanted it."""
        return self._recording is not None and self._recording.fault is not None

    def take(self, frame: Frame, inputs: Sequence[Input]) -> None:
        """Take in a tick that has ended; whatever fails here, the world goes on."""
        if self._recording is not None:
            self._recording.take(frame, inputs)

    async def switch(self, *, on: bool) -> None:
        """Begin a recording, or end the one there is; nothing if it is so already.

        Raises
        ------
        NotRecordedError
            The file cannot be written.
        """
        if on == self.is_on:
            return
        await self.close()
        if on:
            recording = await asyncio.to_thread(self._made)
            self._recording = recording
            log.info("recording", file=str(recording.path))
            text = f"{recording.path.name} is being recorded"
            self._bulletin.event("recording", text, code="begun", file=recording.path.name)

    async def close(self) -> None:
        """Complete the recording that is being written, if any, within a bounded time."""
        recording, self._recording = self._recording, None
        if recording is None:
            return
        await asyncio.to_thread(recording.close)
        self._closed += recording.written
        if recording.fault is None:
            text = f"{recording.path.name} is complete"
            self._bulletin.event("recording", text, code="complete", file=recording.path.name)

    def told(self) -> dict[str, Any]:
        """The state of the recording, for programs: `on`, `off` or `failed`."""
        recording = self._recording
        if recording is None:
            return {"state": "off", "file": None, "bytes": 0, "seconds": 0, "fault": None}
        return {
            "state": "on" if recording.fault is None else "failed",
            "file": recording.path.name,
            "bytes": recording.size,
            "seconds": recording.written,
            "fault": None if recording.fault is None else recording.fault.text,
        }

    def _made(self) -> "ZoneRecording":
        """Make a recording that has begun to write its file."""
        try:
            # An extra has the library that writes recordings.
            from esplanade.server.recording.folder import RecordingFolder  # noqa: PLC0415
            from esplanade.server.recording.head import Built, Head  # noqa: PLC0415
            from esplanade.server.recording.zone_recording import ZoneRecording  # noqa: PLC0415
        except ModuleNotFoundError as error:
            package = (error.name or "").partition(".")[0]
            raise NotRecordedError(f"it needs {package}: install esplanade[record]") from None
        settings, zone = self._settings, self._zone
        path = free_path(self._folder / f"{_as_file(self._name or zone.scene.name)}.mcap")

        def ended(fault: Ended) -> None:
            log.error("the zone is not recorded any more", code=fault.code, why=fault.text)
            self._bulletin.event("recording", fault.text, code=fault.code, file=path.name)

        def removed(old: Path, why: str) -> None:
            log.info("an old recording is removed", file=str(old), why=why)
            text = f"{old.name} is removed: {why}"
            self._bulletin.event("recording", text, code="removed", file=old.name)

        most_bytes = None if settings.record_keep_gb is None else settings.record_keep_gb * 1e9
        built = Built.of(
            zone,
            self._name,
            settings.seed,
            settings.person_radius_m,
            names=settings.record_names,
            chat=settings.record_chat,
        )
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            return ZoneRecording(
                zone,
                Head.of(zone, built),
                path,
                ended,
                longest_s=max(1, round(settings.record_hours * 3600)),
                folder=RecordingFolder(
                    self._folder, most_bytes, settings.record_keep_days, removed
                ),
            )
        except OSError as error:
            raise NotRecordedError(f"{path}: {error.strerror or error}") from None
        except WritingError as error:
            raise NotRecordedError(str(error)) from None


@asynccontextmanager
async def recorder_of(
    settings: ServerSettings, zone: Zone, name: str, metrics: Metrics, bulletin: Bulletin
) -> AsyncIterator[ZoneRecorder | None]:
    """The recorder of a zone, where the settings have a folder; its file ends with the zone.

    Raises
    ------
    LoadingError
        The file cannot be written.
    """
    if settings.record is None:
        yield None
        return
    recorder = ZoneRecorder(settings, settings.record, zone, name, bulletin)
    if not settings.record_later:
        try:
            await recorder.switch(on=True)
        except NotRecordedError as error:
            raise LoadingError(f"record: {error}") from None
    _watch(recorder, metrics)
    try:
        yield recorder
    finally:
        await recorder.close()


def _as_file(name: str) -> str:
    """A name without what no name of a file should have."""
    return re.sub(r"[^\w.-]+", "-", name).strip("-.") or "zone"


def _watch(recorder: ZoneRecorder, metrics: Metrics) -> None:
    metrics.gauge(
        "recording_waiting",
        "Seconds of the recording that wait to be written",
        lambda: recorder.waiting,
    )
    metrics.total(
        "recording_written", "Seconds of recordings that were written", lambda: recorder.written
    )
    metrics.gauge(
        "recording_ended",
        "Whether the recording has ended before the world",
        lambda: int(recorder.has_failed),
    )
