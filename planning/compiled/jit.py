"""How kernels are compiled: numba, without the interpreter's lock, cached by what they say."""

import contextlib
import hashlib
import logging
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar, cast

import numba

_KEPT_S = 30 * 24 * 3600.0
_SOURCES = ("planning", "actors/locomotion", "evaluation/policies")
"""Folders that hold kernels, and all that kernels take functions and constants from."""

F = TypeVar("F", bound=Callable[..., object])


def _source_digest() -> str:
    """Digest of every module that compiled code can reach.

    numba's own cache looks at the file of the outermost function alone, so an edit of a helper
    or a constant in another file would go unnoticed. One digest for all of them makes that
    impossible.
    """
    bounds_checked = bool(numba.config.BOUNDSCHECK)  # type: ignore[attr-defined]
    digest = hashlib.sha256(f"{numba.__version__} {bounds_checked}".encode())
    for path in sources():
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def sources() -> list[Path]:
    """The files whose text decides what kernels are compiled to, in a fixed order."""
    root = Path(__file__).parents[2]
    return sorted(path for folder in _SOURCES for path in (root / folder).rglob("*.py"))


def _forget_older(marker: Path) -> None:
    """Remove what was compiled from sources that nobody ran for a month before this run."""
    for other in marker.parent.parent.glob(f"kernels-*/{marker.name}"):
        with contextlib.suppress(OSError):
            if marker.stat().st_mtime - other.stat().st_mtime > _KEPT_S:
                shutil.rmtree(other.parent)


def _open_cache() -> bool:
    """Point numba at a folder of its own for this very source; False where none can be written."""
    for base in (Path.home() / ".cache", Path(tempfile.gettempdir())):
        folder = base / "esplanade" / f"kernels-{_source_digest()}"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            marker = folder / ".used"
            marker.touch()
        except OSError:
            continue
        _forget_older(marker)
        numba.config.CACHE_DIR = str(folder)  # type: ignore[attr-defined]
        return True
    logging.getLogger(__name__).warning(
        "no folder to keep compiled kernels in; they are compiled anew at each start"
    )
    return False


_CACHED = _open_cache()


def kernel(function: F) -> F:
    """Compile a function of arrays and scalars; it runs without the interpreter's lock."""
    return cast(F, numba.njit(nogil=True, cache=_CACHED, error_model="numpy")(function))


def inlined(function: F) -> F:
    """A kernel that is always compiled into those that call it.

    For what runs in the innermost loops: numba counts references to every array that is handed to
    a function, and the compiler removes that only where it sees both ends.
    """
    options = {
        "nogil": True,
        "cache": _CACHED,
        "error_model": "numpy",
        "forceinline": True,
        "_nrt": False,
    }
    compiled: F = numba.njit(**options)(function)  # type: ignore[call-overload]
    return compiled
