"""The bytes of a file up to a bound; what gzip packed is unpacked, up to the same bound."""

import zlib
from pathlib import Path
from typing import Final

MAX_TEXT_BYTES: Final = 256 * 2**20
"""More than a person writes by hand; what must hold more says its own bound."""

GZIP_MAGIC: Final = b"\x1f\x8b"
_GZIP_WINDOW: Final = 16 + zlib.MAX_WBITS


class ContentError(ValueError):
    """A file whose bytes or text cannot be had; the message says why, without the file's name."""


def read_content(path: Path, most_bytes: int = MAX_TEXT_BYTES) -> bytes:
    """Read a whole file; devices and pipes are read no further than the bound either.

    Raises
    ------
    ContentError
        The file cannot be read, holds more than `most_bytes`, or its gzip is damaged.
    """
    try:
        with path.open("rb") as file:
            content = file.read(most_bytes + 1)
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or error
        raise ContentError(f"cannot be read: {why}") from None
    if len(content) > most_bytes:
        raise ContentError(f"has more than {most_bytes // 2**20} MiB, the most that is read")
    return unpacked(content, most_bytes) if content.startswith(GZIP_MAGIC) else content


def unpacked(content: bytes, most_bytes: int) -> bytes:
    """The content of one or several members of gzip.

    Raises
    ------
    ContentError
        They are damaged, or hold more than `most_bytes`.
    """
    parts: list[bytes] = []
    room = most_bytes
    while content.startswith(GZIP_MAGIC):
        inflater = zlib.decompressobj(_GZIP_WINDOW)
        try:
            part = inflater.decompress(content, room + 1)
        except zlib.error as error:
            raise ContentError(f"its gzip is damaged: {error}") from None
        if len(part) > room:
            raise ContentError(
                f"unpacks to more than {most_bytes // 2**20} MiB, the most that is read"
            )
        if not inflater.eof:
            raise ContentError("its gzip is damaged: it ends too early")
        parts.append(part)
        room -= len(part)
        content = inflater.unused_data.lstrip(b"\0")
    return b"".join(parts)
