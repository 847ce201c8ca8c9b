"""Output of results: tables to a console, figures to a file, pictures to a folder."""

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from rich.console import Console

from esplanade.commandline.errors import UsageError

_PAGE: Final = 200
"""Columns of a file or pipe: nothing is cut off there."""


def console() -> Console:
    """The console for tables: on a terminal as wide as that is."""
    made = Console()
    return made if made.is_terminal else Console(width=_PAGE)


def write_json(option: str, path: Path, figures: Mapping[str, Any]) -> None:
    """Write what was measured; null stands for what is not finite.

    Raises
    ------
    UsageError
        The file cannot be written.
    """
    try:
        path.write_text(json.dumps(_plain(figures), indent=1, allow_nan=False) + "\n")
    except OSError as error:
        raise UsageError(f"{option}: {error}") from None


def made_folder(option: str, path: Path) -> Path:
    """The folder, which is there from now on.

    Raises
    ------
    UsageError
        It cannot be made.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UsageError(f"{option}: {error}") from None
    return path


def _plain(value: Any) -> Any:
    """The value as JSON can hold it; None stands for a number that is not finite."""
    match value:
        case Mapping():
            return {name: _plain(part) for name, part in value.items()}
        case list() | tuple():
            return [_plain(part) for part in value]
        case float() if not math.isfinite(value):
            return None
    return value
