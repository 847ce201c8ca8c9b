"""What the commands share: faults that end them, files, progress."""

from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TaskProgressColumn, TextColumn

from esplanade.planning import Scene
from esplanade.planning.scene.scene_file import read_scene


class UsageError(Exception):
    """What was asked for cannot be done; the message says what and why."""


def open_scene(path: Path) -> Scene:
    """The scene of a file.

    Raises
    ------
    UsageError
        The file cannot be read.
    SceneError
        It holds no scene.
    """
    try:
        return read_scene(path)
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror or error}") from None


def progress(share: bool = False) -> Progress:
    """A bar on the error output, gone when all is done; with a share of the whole, or a count."""
    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        TaskProgressColumn() if share else MofNCompleteColumn(),
        console=Console(stderr=True),
        transient=True,
    )
