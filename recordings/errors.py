"""The error of a file that cannot be read as a recording."""

from pathlib import Path
from typing import Final

MAX_FILE_BYTES: Final = 128 * 2**20
"""Some three million samples of people; a device that never ends is read no further either."""


class RecordingError(ValueError):
    """A file cannot be read as a recording; the message names the file, the line and the reason.

    Lines count from 1; `line` is None if the error is not in a single line.
    """

    def __init__(self, path: Path, text: str, line: int | None = None) -> None:
        where = str(path) if line is None else f"{path}:{line}"
        super().__init__(f"{where}: {text}")
        self.path = path
        self.line = line
        self.text = text


def read_text(path: Path) -> str:
    """Read a whole file as UTF-8 text without a byte order mark.

    Raises
    ------
    RecordingError
        The file cannot be read, is not UTF-8, or has more than `MAX_FILE_BYTES`.
    """
    try:
        with path.open("rb") as file:
            content = file.read(MAX_FILE_BYTES + 1)
        if len(content) > MAX_FILE_BYTES:
            most = MAX_FILE_BYTES // 2**20
            raise RecordingError(path, f"has more than {most} MiB, the most that is read")
        return content.decode("utf-8-sig")
    except OSError as error:
        raise RecordingError(path, f"cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError as error:
        raise RecordingError(path, f"is not UTF-8 text (byte {error.start})") from None
