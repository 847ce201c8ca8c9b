"""Keeps the recording of a zone that is served."""

import asyncio
import re
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import structlog

from esplanade.recordings.writing import WritingError
from esplanade.server.file_thread import Ended
from esplanade.server.live.bulletin import Bulletin
from esplanade.server.loading import LoadingError
from esplanade.server.metrics import Metrics
from esplanade.server.settings import ServerSettings
from esplanade.server.trajectories.writer import free_path
from esplanade.server.world.zone import Zone

if TYPE_CHECKING:
    from esplanade.server.recording.zone_recording import ZoneRecording

log = structlog.get_logger(__name__)


@asynccontextmanager
async def recorded(
    settings: ServerSettings, zone: Zone, name: str, metrics: Metrics, bulletin: Bulletin
) -> AsyncIterator["ZoneRecording | None"]:
    """Record a zone where the settings say so; the file ends with the zone.

    Raises
    ------
    LoadingError
        The file cannot be written.
    """
    if settings.record is None:
        yield None
        return
    try:
        # What writes recordings is in an extra.
        from esplanade.server.recording.folder import RecordingFolder  # noqa: PLC0415
        from esplanade.server.recording.head import Built, Head  # noqa: PLC0415
        from esplanade.server.recording.zone_recording import ZoneRecording  # noqa: PLC0415
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0]
        raise LoadingError(f"record: it needs {package}: install esplanade[record]") from None
    path = free_path(settings.record / f"{_as_file(name or zone.scene.name)}.mcap")

    def ended(fault: Ended) -> None:
        log.error("the zone is not recorded any more", code=fault.code, why=fault.text)
        bulletin.event("recording", fault.text, code=fault.code, file=path.name)

    def removed(old: Path, why: str) -> None:
        log.info("an old recording is removed", file=str(old), why=why)
        text = f"{old.name} is removed: {why}"
        bulletin.event("recording", text, code="removed", file=old.name)

    most_bytes = None if settings.record_keep_gb is None else settings.record_keep_gb * 1e9
    folder = RecordingFolder(settings.record, most_bytes, settings.record_keep_days, removed)
    built = Built.of(
        zone,
        name,
        settings.seed,
        settings.person_radius_m,
        names=settings.record_names,
        chat=settings.record_chat,
    )
    try:
        settings.record.mkdir(parents=True, exist_ok=True)
        recording = ZoneRecording(
            zone,
            Head.of(zone, built),
            path,
            ended,
            longest_s=max(1, round(settings.record_hours * 3600)),
            folder=folder,
        )
    except OSError as error:
        raise LoadingError(f"record: {path}: {error.strerror or error}") from None
    except WritingError as error:
        raise LoadingError(f"record: {error}") from None
    log.info("recording", file=str(path))
    _watch(recording, metrics)
    try:
        yield recording
    finally:
        await asyncio.get_running_loop().run_in_executor(None, recording.close)


def _as_file(name: str) -> str:
    """A name without what no name of a file should have."""
    return re.sub(r"[^\w.-]+", "-", name).strip("-.") or "zone"


def _watch(recording: "ZoneRecording", metrics: Metrics) -> None:
    metrics.gauge(
        "recording_waiting",
        "Seconds of the recording that wait to be written",
        lambda: recording.waiting,
    )
    metrics.total(
        "recording_written", "Seconds of the recording that were written", lambda: recording.written
    )
    metrics.gauge(
        "recording_ended",
        "Whether the recording has ended before the world",
        lambda: int(recording.fault is not None),
    )
