"""Download of meshes that are named by a web address; they are kept only while they are used."""

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
"""The download fails if no byte arrives for this long."""
_PIECE_BYTES: Final = 2**18


@contextmanager
def local_file(source: str, report: Callable[[str, float], None]) -> Iterator[Path]:
    """The local path of a file that is named by its path or web address.

    A downloaded file is deleted when the context ends. `report` is called with the current
    activity and the fraction of it that is done.

    Raises
    ------
    UsageError
        The file cannot be downloaded, or is too large.
    """
    if urlsplit(source).scheme not in SCHEMES:
        yield Path(source)
        return
    with TemporaryDirectory() as folder:
        name = PurePosixPath(unquote(urlsplit(source).path)).name or "mesh"
        path = Path(folder) / name
        _download(source, path, report)
        yield path


def _download(address: str, path: Path, report: Callable[[str, float], None]) -> None:
    activity = f"downloading {path.name}"
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
                report(activity, got / size if size else 0.0)
    except urllib.error.HTTPError as error:
        raise UsageError(f"{address}: the server answers {error.code} {error.reason}") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "reason", None) or error
        raise UsageError(f"{address}: cannot be downloaded: {reason}") from None
