"""The cache keeps compiled kernels from one run to the next, and finds them again.

The folder is named by a digest of everything that decides what kernels are compiled to, and a
file in it by the kernel and its types. There is no index that several processes would have to
write in turn: each entry is a file of its own, put in place at once and checked when it is read.
"""

import contextlib
import hashlib
import inspect
import logging
import os
import pickle
import shutil
import sys
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, Final
from uuid import uuid4

import llvmlite  # type: ignore[import-untyped]
import numba
import numpy as np
from numba.core.caching import _Cache
from numba.core.compiler import CompileResult
from numba.core.serialize import dumps

_KEPT_S: Final = 30 * 24 * 3600.0
_SOURCES: Final = (
    "planning",
    "actors/locomotion",
    "evaluation/policies",
    "files",
    "pedestrians/compiled",
    "server/net/compiled",
    "server/world/compiled",
)
"""Folders that hold kernels, and all that kernels take functions and constants from."""
_INDIFFERENT: Final = ("NUMBA_CACHE_DIR", "NUMBA_NUM_THREADS")
"""Variables of numba that change nothing about compiled code."""
_ROOT: Final = Path(__file__).parents[2]
_CHECKSUM_BYTES: Final = hashlib.sha256().digest_size

log = logging.getLogger(__name__)


def sources() -> list[Path]:
    """The files whose text decides what kernels are compiled to, in a fixed order."""
    return sorted(path for folder in _SOURCES for path in (_ROOT / folder).rglob("*.py"))


def _digest() -> str:
    """Digest of every module that compiled code can reach, and of the compiler with its settings.

    numba's own cache looks at the file of the outermost function alone, so an edit of a helper
    or a constant in another file would go unnoticed. One digest for all of them makes that
    impossible. The processor is not in it: each entry is looked up for the processor at hand.
    """
    versions = numba.__version__, llvmlite.__version__, np.__version__, sys.version_info[:2]
    bounds_checked = bool(numba.config.BOUNDSCHECK)  # type: ignore[attr-defined]
    variables = sorted(
        (name, value)
        for name, value in os.environ.items()
        if name.startswith("NUMBA_") and name not in _INDIFFERENT
    )
    digest = hashlib.sha256(repr((versions, bounds_checked, variables)).encode())
    for path in sources():
        digest.update(str(path.relative_to(_ROOT)).encode() + path.read_bytes())
    return digest.hexdigest()[:16]


def _forget_older(marker: Path) -> None:
    """Remove kernels whose sources were not run in the month before this run."""
    for other in marker.parent.parent.glob(f"kernels-*/{marker.name}"):
        with contextlib.suppress(OSError):
            if marker.stat().st_mtime - other.stat().st_mtime > _KEPT_S:
                shutil.rmtree(other.parent)


@cache
def folder() -> Path | None:
    """The folder for this very source, None where there is none; one is made if need be."""
    name = f"kernels-{_digest()}"
    places = [base / "esplanade" / name for base in _bases()]
    for place in places:
        try:
            place.mkdir(parents=True, exist_ok=True)
            marker = place / ".used"
            marker.touch()
        except OSError:
            continue
        _forget_older(marker)
        return place
    readable = [place for place in places if place.is_dir()]
    if readable:
        return readable[0]
    log.warning("no folder to keep compiled kernels in; they are compiled anew at each start")
    return None


def _bases() -> list[Path]:
    bases = []
    with contextlib.suppress(RuntimeError):  # there is no home
        bases.append(Path.home() / ".cache")
    with contextlib.suppress(OSError):  # no temporary files can be written
        bases.append(Path(tempfile.gettempdir()))
    return bases


def _pickled(value: object) -> bytes:
    pickled: bytes = dumps(value)  # type: ignore[no-untyped-call]
    return pickled


class KernelCache(_Cache):
    """The entries of one kernel. No entry that cannot be read or written stops a program."""

    _told = False

    def __init__(self, function: Callable[..., object], kept_in: Path) -> None:
        self._function: Any = function
        self._folder = kept_in
        self._enabled = True
        file = Path(inspect.getfile(function))
        inside = file.is_relative_to(_ROOT)
        # Kernels of the package go by the folder's digest alone: every copy of it shares them.
        self._source = "" if inside else hashlib.sha256(file.read_bytes()).hexdigest()

    @property
    def cache_path(self) -> str:
        return str(self._folder)

    def enable(self) -> None:
        self._enabled = True

    def disable(self) -> None:
        self._enabled = False

    def flush(self) -> None:
        for path in self._folder.glob(f"{self._stem()}-*"):
            path.unlink(missing_ok=True)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """The compiled code for these types; None if none can be read."""
        if not self._enabled:
            return None
        target_context.refresh()
        key = self._key(sig, target_context.codegen())
        path = self._path(key)
        try:
            content = path.read_bytes()
        except OSError:
            return None
        checksum, entry = content[:_CHECKSUM_BYTES], content[_CHECKSUM_BYTES:]
        if hashlib.sha256(entry).digest() != checksum:
            log.debug("%s is damaged; the kernel is compiled anew", path)
            return None
        try:
            known, payload = pickle.loads(entry)  # noqa: S301 (its checksum is right)
            if known != key:
                return None
            parts = pickle.loads(payload)  # noqa: S301
            return CompileResult._rebuild(target_context, *parts)  # type: ignore[no-untyped-call]  # noqa: SLF001
        except Exception:
            log.debug("%s cannot be used; the kernel is compiled anew", path, exc_info=True)
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep compiled code; without room for it, the program goes on."""
        if not self._enabled or data.lifted or data.library.has_dynamic_globals:
            return
        key = self._key(sig, data.codegen)
        parts = data._reduce()  # noqa: SLF001 (as numba's own cache)
        entry = _pickled((key, _pickled(parts)))
        path = self._path(key)
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            # Put in place at once: nobody ever reads a half.
            draft = path.with_name(f"{path.name}.{uuid4().hex}")
            try:
                draft.write_bytes(hashlib.sha256(entry).digest() + entry)
                draft.replace(path)
            except BaseException:
                draft.unlink(missing_ok=True)
                raise
        except OSError as error:
            if not KernelCache._told:
                KernelCache._told = True
                log.warning("compiled kernels cannot be kept in %s: %s", self._folder, error)

    def _key(self, sig: Any, codegen: Any) -> tuple[object, ...]:
        closed = self._function.__closure__ or ()
        return (
            self._source,
            self._function.__module__,
            self._function.__qualname__,
            self._function.__code__.co_code,
            _pickled(tuple(cell.cell_contents for cell in closed)) if closed else b"",
            codegen.magic_tuple(),
            sig,
        )

    def _path(self, key: tuple[object, ...]) -> Path:
        return (
            self._folder / f"{self._stem()}-{hashlib.sha256(repr(key).encode()).hexdigest()[:24]}"
        )

    def _stem(self) -> str:
        name = f"{self._function.__module__}.{self._function.__name__}"
        return "".join(letter if letter.isalnum() or letter in "._" else "_" for letter in name)
