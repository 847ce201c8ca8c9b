"""The lines of every written file on the software that has made it."""

import hashlib
from functools import cache
from pathlib import Path

from esplanade import __version__

_ROOT = Path(__file__).resolve().parents[1]
_ELSEWHERE = frozenset({"tests", "tools", "benchmarks", "chaos", "client_web", "docs", "deploy"})


def software() -> dict[str, str]:
    """Version and digest of the sources."""
    return {"written by": f"esplanade {__version__}", "sources sha256": sources_digest()}


@cache
def sources_digest() -> str:
    """SHA-256 of every Python file of the package, by name and content."""
    digest = hashlib.sha256()
    packages = sorted(
        folder
        for folder in _ROOT.iterdir()
        if (folder / "__init__.py").exists() and folder.name not in _ELSEWHERE
    )
    for package in packages:
        for path in sorted(package.rglob("*.py")):
            digest.update(path.relative_to(_ROOT).as_posix().encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()


def digest_of(path: Path) -> str:
    """SHA-256 of a file; of a folder that of its files, by name and content.

    Folders and hidden files in a folder do not count: they are read as no part of a recording.

    Raises
    ------
    OSError
        It cannot be read.
    """
    if not path.is_dir():
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    digest = hashlib.sha256()
    for part in sorted(path.iterdir()):
        if part.is_file() and not part.name.startswith("."):
            digest.update(part.name.encode() + b"\0" + bytes.fromhex(digest_of(part)))
    return digest.hexdigest()


def digest_if_there(path: Path) -> str:
    """The same; empty where it cannot be read any more."""
    try:
        return digest_of(path)
    except OSError:
        return ""
