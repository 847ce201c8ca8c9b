"""Text of a file: the byte order mark is heeded, UTF-16 and UTF-32 too, and line ends are one."""

import codecs
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Final, NamedTuple

from esplanade.files.content import MAX_TEXT_BYTES, ContentError, read_content

_MARKS: Final = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
_HEAD_BYTES: Final = 4096
_LOOKED_AT: Final = 1024
_MANY_ZEROS: Final = 0.4
_FEW_ZEROS: Final = 0.05
MAX_LINES: Final = 8_000_000
_CONTROLS: Final = re.compile(rb"[\x00-\x08\x0e-\x1a\x1c-\x1f]")
"""Bytes that no text in eight bits holds."""


class Text(NamedTuple):
    """Decoded text with `\\n` at the end of its lines, and what is to be said of its encoding."""

    text: str
    remark: str = ""


def read_text(path: Path, most_bytes: int = MAX_TEXT_BYTES, *, eight_bit: bool = False) -> str:
    """Read a whole file as text, as `decoded` does.

    Raises
    ------
    ContentError
        The file cannot be read, holds too much, or is no text.
    """
    return decoded(read_content(path, most_bytes), eight_bit=eight_bit).text


def decoded(content: bytes, *, eight_bit: bool = False) -> Text:
    """Decode by the byte order mark, else by where the zeros of UTF-16 are, else as UTF-8.

    With `eight_bit`, what is no UTF-8 but has no control characters is taken for Windows-1252, as
    spreadsheets still write it, and a remark says so. Zeros at the end, with which some programs
    fill a block, the mark of the end of old files (Ctrl-Z) and marks between joined files are left
    out.

    Raises
    ------
    ContentError
        It is no text of these.
    """
    encoding = _encoding(content)
    if encoding.startswith("utf-8"):
        content = content.rstrip(b"\0") if content.endswith(b"\0") else content
        # Looked at first, since a large file of bytes would take long to decode.
        if b"\0" in content[:_LOOKED_AT]:
            raise ContentError("is no text, but bytes")
    try:
        return Text(_lines(content.decode(encoding)))
    except UnicodeDecodeError as error:
        if encoding == "utf-8" and eight_bit and not _CONTROLS.search(content):
            text = _lines(content.decode("cp1252", errors="replace"))
            return Text(text, f"byte {error.start} is no UTF-8: read as Windows-1252")
        name = "UTF-8" if encoding.startswith("utf-8") else encoding.upper()
        line = content.count(b"\n", 0, error.start) + 1
        where = f"byte {error.start}, line {line}" if name == "UTF-8" else f"byte {error.start}"
        raise ContentError(f"is not {name} text ({where})") from None


def shown(line: str) -> str:
    """A line as messages quote it: short, and without control characters."""
    text = " ".join(line.split())
    return repr(text if len(text) <= 40 else text[:39] + "…")


def check_lines(text: str, most: int = MAX_LINES) -> None:
    """Check that a text has no more lines than are gone through in some seconds.

    Raises
    ------
    ContentError
        It has more.
    """
    if len(text) > most and text.count("\n") > most:
        raise ContentError(f"has more than {most} lines, the most that is read")


def lines_of(text: str) -> Iterator[str]:
    """The lines of a text one by one, without a list of all of them."""
    begin = 0
    while (end := text.find("\n", begin)) >= 0:
        yield text[begin:end]
        begin = end + 1
    yield text[begin:]


def _encoding(content: bytes) -> str:
    for mark, encoding in _MARKS:
        if content.startswith(mark):
            return encoding
    head = content[: _HEAD_BYTES - _HEAD_BYTES % 2]
    if len(head) < 4 or b"\0" not in head:
        return "utf-8"
    return _wide_encoding(head) or "utf-8"


def _wide_encoding(head: bytes) -> str | None:
    """UTF-32 or UTF-16 by where zeros are: ASCII has three in four bytes there, or one in two."""
    quarters = [head[k::4].count(0) / max(1, len(head[k::4])) for k in range(4)]
    shares = [(quarters[k] + quarters[k + 2]) / 2 for k in range(2)]
    for name, zeros, letters in (
        ("utf-32-le", min(quarters[1:]), quarters[0]),
        ("utf-32-be", min(quarters[:3]), quarters[3]),
        ("utf-16-le", shares[1], shares[0]),
        ("utf-16-be", shares[0], shares[1]),
    ):
        if zeros > _MANY_ZEROS and letters < _FEW_ZEROS:
            return name
    return None


def _lines(text: str) -> str:
    text = text.replace("\ufeff", "").rstrip("\x1a")
    return text.replace("\r\n", "\n").replace("\r", "\n") if "\r" in text else text
