"""The forms of files that trajectories are written into, by their suffixes."""

from pathlib import Path
from typing import Final

SUFFIXES: Final = (".csv", ".txt", ".sqlite", ".parquet")
"""Those of `esplanade.recordings.streams`, which is not read before something is written."""


def check_suffix(path: Path) -> None:
    """Check that a file of trajectories has a form that can be written.

    Raises
    ------
    ValueError
        It has none; the message says which there are.
    """
    if path.suffix.lower() not in SUFFIXES:
        raise ValueError(f"{path.name} ends in none of {', '.join(SUFFIXES)}")
