"""The error of a file that cannot be read as a recording."""

from pathlib import Path


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
        The file cannot be read, or is not UTF-8.
    """
    try:
        return path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise RecordingError(path, f"cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError as error:
        raise RecordingError(path, f"is not UTF-8 text (byte {error.start})") from None
