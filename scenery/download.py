"""Meshes that are named by an address of the web: fetched, and kept as long as they are needed."""

import urllib.error
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath
from tempfile import TemporaryDirectory
from typing import Final
from urllib.parse import unquote, urlsplit

from esplanade.commandline.errors import UsageError

SCHEMES: Final = ("http", "https")
MAX_BYTES: Final = 256 * 2**20
TIMEOUT_S: Final = 30.0
"""Without a byte for so long, it is given up."""
_PIECE_BYTES: Final = 2**18


@contextmanager
def local_file(source: str, tell: Callable[[str, float], None]) -> Iterator[Path]:
    """A file by its path; one by its address for as long as the context lasts.

    `tell` hears what is being done, and which share of it is behind.

    Raises
    ------
    UsageError
        The address cannot be fetched, or what is there is too large.
    """
    if urlsplit(source).scheme not in SCHEMES:
        yield Path(source)
        return
    with TemporaryDirectory() as folder:
        name = PurePosixPath(unquote(urlsplit(source).path)).name or "mesh"
        path = Path(folder) / name
        _fetch(source, path, tell)
        yield path


def _fetch(address: str, path: Path, tell: Callable[[str, float], None]) -> None:
    doing = f"fetching {path.name}"
    try:
        with (
            urllib.request.urlopen(address, timeout=TIMEOUT_S) as answer,  # noqa: S310 - http only
            path.open("wb") as file,
        ):
            size = int(answer.headers.get("Content-Length") or 0)
            got = 0
            while piece := answer.read(_PIECE_BYTES):
                got += len(piece)
                if max(got, size) > MAX_BYTES:
                    raise UsageError(f"{address}: it is larger than {MAX_BYTES // 2**20} MiB")
                file.write(piece)
                tell(doing, got / size if size else 0.0)
    except urllib.error.HTTPError as error:
        raise UsageError(f"{address}: the server answers {error.code} {error.reason}") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "reason", None) or error
        raise UsageError(f"{address}: cannot be fetched: {reason}") from None
