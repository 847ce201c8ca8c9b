"""The folder of recordings: which are being written, and which are removed to make room."""

import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import IO, Final

import structlog

from esplanade.server.recording.container import PROFILE

try:
    import fcntl
except ImportError:  # where a file that is open cannot be removed or replaced anyway
    fcntl = None  # type: ignore[assignment]

SUFFIX: Final = ".mcap"
_HEADER_BYTES: Final = 64
_DAY_S: Final = 86400.0

log = structlog.get_logger(__name__)


class RecordingFolder:
    """Removes the oldest recordings of a folder where there are too many, or they are too old."""

    def __init__(
        self,
        path: Path,
        most_bytes: float | None,
        most_days: float | None,
        removed: Callable[[Path, str], None],
    ) -> None:
        """`removed` is told each file that is gone, and why; None stands for no limit."""
        self._path = path
        self._most_bytes = most_bytes
        self._most_days = most_days
        self._removed = removed

    def clear(self) -> None:
        """Keep to the limits. Whole recordings go, the oldest first, and none that is written."""
        if self._most_bytes is None and self._most_days is None:
            return
        now_s = time.time()
        try:
            found = [(each, each.stat()) for each in recordings_in(self._path)]
            found.sort(key=lambda each: each[1].st_mtime)
            left = sum(state.st_size for _, state in found)
            for path, state in found:
                days = (now_s - state.st_mtime) / _DAY_S
                if self._most_days is not None and days > self._most_days:
                    why = f"it ended {days:.4g} days ago, and {self._most_days:g} are kept"
                elif self._most_bytes is not None and left > self._most_bytes:
                    why = f"the folder has {left / 1e9:.3g} GB, and {self._most_bytes / 1e9:g} may"
                else:
                    continue
                if is_being_written(path):
                    continue
                path.unlink()
                left -= state.st_size
                self._removed(path, why)
        except OSError as error:
            log.warning("recordings cannot be removed", folder=str(self._path), why=str(error))


def recordings_in(folder: Path) -> list[Path]:
    """The recordings of a folder by their names, and no other files of the same kind."""
    return [each for each in sorted(folder.glob(f"*{SUFFIX}")) if _is_recording(each)]


def mark_as_written(file: IO[bytes]) -> None:
    """Say to all processes of this machine that a file is being written, until it is closed."""
    if fcntl is not None:
        with suppress(OSError):  # there are file systems that know no locks
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


def is_being_written(path: Path) -> bool:
    """Whether some process of this machine writes this recording."""
    if fcntl is None:
        return False
    with path.open("rb") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            return True
        except OSError:
            return False
    return False


def _is_recording(path: Path) -> bool:
    try:
        with path.open("rb") as file:
            return PROFILE.encode() in file.read(_HEADER_BYTES)
    except OSError:
        return False
