"""Keeps the trajectories of a world that is served: from its ticks to a file."""

import asyncio
import shlex
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager
from pathlib import Path

import structlog

from esplanade.recordings.writing import WritingError
from esplanade.server.file_thread import Ended
from esplanade.server.live.bulletin import Bulletin
from esplanade.server.loading import DEFAULT_SCENE, LoadedScene, LoadingError
from esplanade.server.metrics import Metrics
from esplanade.server.options import SETTINGS
from esplanade.server.settings import ServerSettings
from esplanade.server.trajectories.provenance import Origin, files_of
from esplanade.server.trajectories.recorder import Recorder
from esplanade.server.trajectories.writer import TrajectoryWriter, free_path
from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import Input
from esplanade.server.world.zone import Zone

_TOLD: tuple[str, ...] = ("world", "people")
"""Groups of settings that make a world what it is; others may hold secrets."""
_SAID_BY_WORLD = frozenset(("scene", "actors", "max_clients"))
"""Settings of a zone that the file of its world has."""

log = structlog.get_logger(__name__)


class WorldTrajectories:
    """Takes each tick of a world and leaves its block to the thread that writes."""

    def __init__(self, recorder: Recorder, writer: TrajectoryWriter) -> None:
        self._recorder = recorder
        self._writer = writer

    def take(self, frame: Frame, inputs: Sequence[Input]) -> None:
        """Take a tick in that has ended; whatever fails here, the world goes on."""
        if self._writer.fault is not None:
            return
        try:
            block = self._recorder.take(frame, inputs)
            if block is not None:
                self._writer.put(block)
        except Exception as error:
            log.exception("trajectories cannot be taken", tick=frame.tick)
            self._writer.fail(error)


@asynccontextmanager
async def trajectories_kept(
    settings: ServerSettings,
    loaded: LoadedScene,
    world: Zone,
    metrics: Metrics,
    bulletin: Bulletin,
) -> AsyncIterator[WorldTrajectories | None]:
    """Write the trajectories of a world where the settings say so; the file ends with the world.

    Raises
    ------
    LoadingError
        The file cannot be written.
    """
    if settings.trajectories is None:
        yield None
        return
    path = free_path(settings.trajectories)
    recorder = Recorder(world, settings.trajectories_hz)
    scene = None if settings.crowd is not None else settings.scene or DEFAULT_SCENE
    files = files_of(settings, scene, loaded.scene.mesh)

    def ended(fault: Ended) -> None:
        log.error("trajectories are not written any more", code=fault.code, why=fault.text)
        bulletin.event("trajectories", fault.text, code=fault.code, file=path.name)

    try:
        head = recorder.head(Origin(command_of(settings), settings, files))
        writer = TrajectoryWriter(path, head, ended)
    except WritingError as error:
        raise LoadingError(f"trajectories: {error}") from None
    log.info("writing trajectories", file=str(path), frames_a_second=head.fps)
    _watch(writer, metrics)
    try:
        yield WorldTrajectories(recorder, writer)
    finally:
        await asyncio.get_running_loop().run_in_executor(None, writer.close)


def command_of(settings: ServerSettings) -> str:
    """The command line that makes the same world; what may be secret is not in it."""
    words = ["esplanade", "serve"]
    for group in _TOLD:
        for name, setting in SETTINGS.groups[group].items():
            value = getattr(settings, name)
            if settings.world is not None and name in _SAID_BY_WORLD:
                continue
            if value != setting.default:
                text = value.name if isinstance(value, Path) else f"{value}"
                words += [f"--{name.replace('_', '-')}", "yes" if value is True else text]
    return shlex.join(words)


def _watch(writer: TrajectoryWriter, metrics: Metrics) -> None:
    metrics.gauge(
        "trajectories_waiting",
        "Ticks of trajectories that wait to be written",
        lambda: writer.waiting,
    )
    metrics.total(
        "trajectories_written", "Ticks of trajectories that were written", lambda: writer.written
    )
    metrics.gauge(
        "trajectories_ended",
        "Whether the writing of trajectories has ended before the world",
        lambda: int(writer.fault is not None),
    )
