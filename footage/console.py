"""What the commands share: errors that end them, files, progress."""

from importlib import import_module
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn


class UsageError(Exception):
    """What was asked for cannot be done; the message says what and why."""


def part_that_needs(library: str, module: str) -> Any:
    """Import a module of ours that draws.

    Raises
    ------
    UsageError
        The library that it draws with is not installed.
    """
    try:
        import_module(library)
    except ImportError:
        raise UsageError(
            f"pictures need {library}: pip install matplotlib, or `pip install '.[gait]'`"
        ) from None
    return import_module(module)


def made_folder(path: Path) -> Path:
    """Make a folder unless it is there.

    Raises
    ------
    UsageError
        The folder cannot be made.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UsageError(f"--out: {error}") from None
    return path


def progress() -> Progress:
    """A bar on the error output that goes away at the end."""
    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        console=Console(stderr=True),
        transient=True,
    )
