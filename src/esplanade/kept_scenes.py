"""The folder of scenes that were made of meshes and plans: it is bounded in size and age."""

import os
import re
import shutil
import time
from contextlib import suppress
from pathlib import Path
from typing import Final, NamedTuple

MOST_BYTES: Final = 2**30
"""Scenes that take more than this together make room, those first that were used longest ago."""
MOST_AGE_S: Final = 30 * 86_400.0
"""Scenes that were not used for so long go."""
_IN_USE_S: Final = 3600.0
"""A scene used within this time may still be made, or be about to be read by another start."""
UNFINISHED: Final = "unfinished-"
"""The names of folders in which something is still being made begin so."""
_NAME: Final = re.compile(rf"[0-9a-f]{{16}}|{UNFINISHED}.*")


class _Kept(NamedTuple):
    """A folder of one scene, the time of its last use, and its size."""

    used_s: float
    size: int
    folder: Path


def mark_used(folder: Path) -> None:
    """Note that a scene is used now."""
    with suppress(OSError):
        os.utime(folder)


def make_room(scenes: Path, current: Path) -> list[Path]:
    """Remove scenes that are too old, or too many; returns their folders.

    The current one stays, and so does whatever was used within the last hour or was not made here.
    """
    now = time.time()
    kept = sorted(_kept(scenes), reverse=True)
    removed = []
    total = 0
    for used_s, size, folder in kept:
        total += size
        spared = folder == current or now - used_s < _IN_USE_S
        if not spared and (total > MOST_BYTES or now - used_s > MOST_AGE_S):
            shutil.rmtree(folder, ignore_errors=True)
            removed.append(folder)
            total -= size
    return removed


def _kept(scenes: Path) -> list[_Kept]:
    found = []
    try:
        folders = [path for path in scenes.iterdir() if _NAME.fullmatch(path.name)]
    except OSError:
        return []
    for folder in folders:
        try:
            if folder.is_symlink() or not folder.is_dir():
                continue
            size = sum(path.stat().st_size for path in folder.iterdir() if path.is_file())
            found.append(_Kept(folder.stat().st_mtime, size, folder))
        except OSError:
            continue  # another start has just removed it
    return found
