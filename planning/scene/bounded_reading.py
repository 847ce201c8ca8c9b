"""Files are read up to a bound, so that a device or a pipe without an end fills no memory."""

import zlib
from pathlib import Path
from typing import Final

from esplanade.files.content import GZIP_MAGIC, ContentError, unpacked

MAX_UNPACKED_BYTES: Final = 128 * 2**20
"""A file that gzip packed may become this large."""


class TooLargeError(OSError):
    """A file that holds more than may be read of it."""


class DamagedError(OSError):
    """A file that gzip packed, and that cannot be unpacked."""


def read_bounded(path: Path, most_bytes: int) -> bytes:
    """Read a whole file of at most so many bytes; pipes and devices are read no further either.

    What gzip packed is unpacked.

    Raises
    ------
    OSError
        The file cannot be read.
    TooLargeError
        It holds more bytes.
    DamagedError
        It cannot be unpacked, or becomes larger than `MAX_UNPACKED_BYTES`.
    """
    with path.open("rb") as file:
        content = file.read(most_bytes + 1)
    if len(content) > most_bytes:
        raise TooLargeError(0, f"it has more than {most_bytes // 2**20} MiB, the most that is read")
    if not content.startswith(GZIP_MAGIC):
        return content
    try:
        return unpacked(content, min(most_bytes, MAX_UNPACKED_BYTES))
    except ContentError as error:
        raise DamagedError(0, f"it {error}".replace("it its", "its")) from None


def read_head(path: Path, count: int) -> bytes:
    """The first bytes of a file, unpacked where gzip packed them; none where it is damaged.

    Raises
    ------
    OSError
        The file cannot be read.
    """
    with path.open("rb") as file:
        head = file.read(count)
    if not head.startswith(GZIP_MAGIC):
        return head
    try:
        return zlib.decompressobj(16 + zlib.MAX_WBITS).decompress(head, count)
    except zlib.error:
        return b""


def suffix_of(path: Path) -> str:
    """The suffix of a file in small letters; `.gz` behind another one does not count."""
    suffix = path.suffix.lower()
    return Path(path.stem).suffix.lower() if suffix == ".gz" else suffix
