"""Makes what operators command a world by and see of it: the console and the live view."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import NamedTuple

from esplanade.protocol.preset_files import PresetFileError
from esplanade.server.console.console import Console
from esplanade.server.console.preset_folder import read_presets
from esplanade.server.console.presets import Presets
from esplanade.server.kept import Kept
from esplanade.server.live.bulletin import Bulletin
from esplanade.server.live.live import Live
from esplanade.server.loading import LoadedScene, LoadingError
from esplanade.server.metrics import Metrics
from esplanade.server.net.door_commands import DoorCommands
from esplanade.server.net.moderation import PeopleModeration
from esplanade.server.settings import ServerSettings
from esplanade.server.watching import watch_console
from esplanade.server.world.pace import Pace
from esplanade.server.world.zone import Zone


class Commanded(NamedTuple):
    """The ways of commands into a zone."""

    console: Console
    doors: DoorCommands
    """The doors of operators who walk about."""


@asynccontextmanager
async def commanding(
    world: Zone,
    moderation: PeopleModeration,
    kept: Kept,
    loaded: LoadedScene,
    metrics: Metrics,
    presets: Presets,
    pace: Pace,
    bulletin: Bulletin,
) -> AsyncIterator[Commanded]:
    """Make the console, which all commands of operators go through; the bulletin hears of them.

    Raises
    ------
    StoreError
        What operators have made cannot be read.
    """
    overrides = None if loaded.roster is None else loaded.roster.overrides
    console = Console(world, moderation, kept.store, kept.audit, overrides, presets, pace)
    doors = DoorCommands(console, kept.directory.again)
    watch_console(console, doors, metrics)
    console.figures.add(
        "tick_p99_ms",
        "ms",
        "Percentile 99 of the last minute's ticks",
        lambda: 1e3 * metrics.ticks.percentile(99, round(60.0 / world.tick_s)),
    )
    # It hears before anything is loaded: what was missed meanwhile is an event too.
    console.listen(bulletin.heard)
    await console.load_operated()
    try:
        yield Commanded(console, doors)
    finally:
        await console.close()


def live_view(
    world: Zone,
    storeys: list[float],
    console: Console,
    moderation: PeopleModeration,
    metrics: Metrics,
    settings: ServerSettings,
    bulletin: Bulletin,
) -> Live:
    """Make what operators see of the world."""
    live = Live(
        world,
        storeys,
        bulletin,
        metrics.traffic,
        hide_names=settings.hide_names,
        groups=lambda spec: console.state.groups.names(spec),  # noqa: PLW0108 - they are replaced
    )
    moderation.listeners.append(live.bulletin.heard)
    return live


def shipped_presets(settings: ServerSettings) -> Presets:
    """The presets that come along with the server.

    Raises
    ------
    LoadingError
        A file of presets cannot be used.
    """
    try:
        return Presets(read_presets(settings.presets))
    except PresetFileError as error:
        raise LoadingError(str(error)) from None
