"""Text of mesh files: any encoding that programs write, any end of line."""

import codecs
from typing import Final

_MARKS: Final = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
"""Byte order marks; the mark of UTF-32 begins with that of UTF-16."""
_LOOKED_AT: Final = 1024


def decoded(data: bytes, strict: bool = False) -> str:
    """The text of a file with `\\n` at the end of each line, and without byte order marks.

    Without a mark it is UTF-16 where every other byte is zero, else UTF-8, else Latin-1: names and
    comments may be in any encoding, and all that counts is ASCII. With `strict` it is not Latin-1.

    Raises
    ------
    ValueError
        The file is not text.
    """
    encoding = _encoding(data)
    # Looked at first, since a large file of bytes would take long to decode.
    if encoding == "utf-8" and b"\0" in data[:_LOOKED_AT]:
        raise ValueError("it is no text, but bytes")
    try:
        text = data.decode(encoding)
    except UnicodeDecodeError as error:
        if strict and encoding == "utf-8":
            line = data.count(b"\n", 0, error.start) + 1
            raise ValueError(f"line {line} is no UTF-8: {error.reason}") from None
        if encoding != "utf-8":
            raise ValueError(f"it is no text, although it begins as {encoding} does") from None
        text = data.decode("latin-1")
    if "\0" in text[:_LOOKED_AT]:
        raise ValueError("it is no text, but bytes")
    return text.replace("\ufeff", "").replace("\r\n", "\n").replace("\r", "\n")


def _encoding(data: bytes) -> str:
    for mark, encoding in _MARKS:
        if data.startswith(mark):
            return encoding
    start = data[:_LOOKED_AT]
    zeros = [start[parity::2].count(0) for parity in (0, 1)]
    most = 0.4 * len(start) / 2
    if zeros[1] > most and not zeros[0]:
        return "utf-16-le"
    if zeros[0] > most and not zeros[1]:
        return "utf-16-be"
    return "utf-8"


def shown(line: str) -> str:
    """A line as messages quote it: short, and without control characters."""
    text = " ".join(line.split())
    return repr(text if len(text) <= 40 else text[:39] + "…")
