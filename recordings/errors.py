"""The error of a file that cannot be read as a recording."""

from pathlib import Path
from typing import Final

from esplanade.files.content import ContentError, read_content
from esplanade.files.text import Text, decoded

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


def read_bytes(path: Path, most_bytes: int = MAX_FILE_BYTES) -> bytes:
    """Read a whole file, unpacked where gzip packed it.

    Raises
    ------
    RecordingError
        The file cannot be read, or has more than `most_bytes`.
    """
    try:
        return read_content(path, most_bytes)
    except ContentError as error:
        raise RecordingError(path, str(error)) from None


def text_of(path: Path, content: bytes) -> Text:
    """The text that bytes of a file are.

    Raises
    ------
    RecordingError
        They are no text.
    """
    try:
        return decoded(content, eight_bit=True)
    except ContentError as error:
        raise RecordingError(path, str(error)) from None


def read_text(path: Path) -> str:
    """Read a whole file as text.

    Raises
    ------
    RecordingError
        The file cannot be read, is no text, or has more than `MAX_FILE_BYTES`.
    """
    return text_of(path, read_bytes(path)).text
