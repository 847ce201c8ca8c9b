"""The same text as programs save it: encodings, ends of lines, blank lines, fillings, gzip."""

import gzip
from collections.abc import Callable
from typing import Final

SAVED: Final[dict[str, Callable[[str], bytes]]] = {
    "UTF-8 with a mark": lambda text: text.encode("utf-8-sig"),
    "UTF-16": lambda text: text.encode("utf-16"),
    "UTF-16, little end": lambda text: text.encode("utf-16-le"),
    "UTF-16, big end": lambda text: text.encode("utf-16-be"),
    "UTF-32": lambda text: text.encode("utf-32"),
    "ends of Windows": lambda text: text.replace("\n", "\r\n").encode(),
    "ends of old Macs": lambda text: text.replace("\n", "\r").encode(),
    "UTF-16 in gzip": lambda text: gzip.compress(text.encode("utf-16")),
    "no last end": lambda text: text.rstrip("\n").encode(),
    "spaces at ends": lambda text: text.replace("\n", " \n").encode(),
    "zeros behind": lambda text: text.encode() + bytes(100),
    "Ctrl-Z behind": lambda text: text.encode() + b"\x1a",
    "blank lines": lambda text: ("\n\n" + text.replace("\n", "\n\n")).encode(),
}


def text_of(content: bytes) -> str | None:
    """The text that a file is; None for bytes, and for what is packed."""
    if content.startswith((b"\x1f\x8b", b"SQLite", b"PK", b"glTF", b"AutoCAD Binary")):
        return None
    for encoding in ("utf-8-sig", "utf-16", "utf-32-le"):
        try:
            text = content.decode(encoding)
        except UnicodeDecodeError:
            continue
        if "\0" not in text:
            return text
    return None


def some_of(number: int, each: int = 4) -> list[str]:
    """Some of the ways, others for every number, so that a few files try all of them."""
    names = list(SAVED)
    return [names[(each * number + k) % len(names)] for k in range(each)]
