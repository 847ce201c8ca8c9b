"""Files are read up to a bound, so that a device or a pipe without an end fills no memory."""

from pathlib import Path


class TooLargeError(OSError):
    """A file that holds more than may be read of it."""


def read_bounded(path: Path, most_bytes: int) -> bytes:
    """Read a whole file of at most so many bytes; pipes and devices are read no further either.

    Raises
    ------
    OSError
        The file cannot be read.
    TooLargeError
        It holds more bytes.
    """
    with path.open("rb") as file:
        content = file.read(most_bytes + 1)
    if len(content) > most_bytes:
        raise TooLargeError(0, f"it has more than {most_bytes // 2**20} MiB, the most that is read")
    return content
