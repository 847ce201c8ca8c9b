"""Readers: what the word behind an option may be, and the value that it means.

A reader is called with the word. It returns the value, or raises `argparse.ArgumentTypeError`
with a message that says what is expected.
"""

import os
import re
from argparse import ArgumentTypeError
from math import isfinite
from pathlib import Path
from typing import Any, Final

SEED_LIMIT: Final = 2**32 - 1
_UNITS_S: Final = {"s": 1.0, "m": 60.0, "h": 3600.0, "d": 24 * 3600.0}
_FLAGS: Final = {
    **dict.fromkeys(("yes", "true", "on", "1"), True),
    **dict.fromkeys(("no", "false", "off", "0"), False),
}
_DIGITS: Final = re.compile(r"[0-9]{1,6}")
_MOMENT: Final = re.compile(r"(\d{1,4}:)?(\d{1,4}:)?\d{1,9}(\.\d{1,6})?", re.ASCII)


class Number:
    """A number within limits; with `above`, the lower limit itself is not within them."""

    metavar = "X"
    kind = "number"

    def __init__(self, least: float, most: float, *, above: bool = False) -> None:
        self.least, self.most, self.above = least, most, above

    def __call__(self, text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            raise self._refusal(text) from None
        too_low = value <= self.least if self.above else value < self.least
        if too_low or not value <= self.most or not self._fits(value):
            raise self._refusal(text)
        return value

    @property
    def range(self) -> str:
        """The limits in words."""
        least = f"{'above ' if self.above else ''}{self.least:.10g}"
        return f"{least} to {self.most:.10g}" if isfinite(self.most) else f"{least} or more"

    @property
    def limits(self) -> dict[str, Any]:
        """The limits as pydantic has them."""
        found: dict[str, Any] = {"gt" if self.above else "ge": self.least}
        return found | ({"le": self.most} if isfinite(self.most) else {})

    def _fits(self, value: float) -> bool:
        return isfinite(value)

    def _refusal(self, text: str) -> ArgumentTypeError:
        words = self.range if self.range.endswith("more") or self.above else f"from {self.range}"
        return ArgumentTypeError(f"{text!r} is no {self.kind} {words}")


class Whole(Number):
    """A whole number within limits; without `most`, every one from `least` on."""

    metavar = "N"
    kind = "whole number"

    def __init__(self, least: int, most: float = float("inf")) -> None:
        super().__init__(least, most)

    def __call__(self, text: str) -> int:
        return int(super().__call__(text))

    def _fits(self, value: float) -> bool:
        return value.is_integer()


class Span:
    """A span of time, such as 90s, 15m, 1h or 30d; the value is in seconds."""

    metavar = "SPAN"

    def __call__(self, text: str) -> float:
        unit = _UNITS_S.get(text[-1:])
        if unit is None or not _DIGITS.fullmatch(text[:-1]):
            raise ArgumentTypeError(f"{text!r} is no span of time such as 90s, 15m, 1h or 30d")
        return int(text[:-1]) * unit


class Moment:
    """A moment after a beginning, such as 00:12:30, 12:30 or 750.5; the value is in seconds."""

    metavar = "TIME"

    def __call__(self, text: str) -> float:
        if not _MOMENT.fullmatch(text):
            raise ArgumentTypeError(f"{text!r} is no moment such as 00:12:30, 12:30 or 750.5")
        seconds = 0.0
        for part in text.split(":"):
            seconds = 60.0 * seconds + float(part)
        return seconds


class Text:
    """Any text."""

    metavar = "TEXT"

    def __call__(self, text: str) -> str:
        return text


class Flag:
    """On or off; the option alone means on."""

    metavar = "yes|no"
    alone = True

    def __call__(self, text: str) -> bool:
        value = _FLAGS.get(text.lower())
        if value is None:
            raise ArgumentTypeError(f"{text!r} is neither yes nor no")
        return value


class Choice:
    """One of some words; the parser compares, and suggests the nearest."""

    def __init__(self, *choices: str) -> None:
        self.choices = choices
        self.metavar = "|".join(choices)

    def __call__(self, text: str) -> str:
        return text


class InputFile:
    """A file that is there and can be read; with `folders`, a folder too."""

    metavar = "FILE"

    def __init__(self, *, folders: bool = False) -> None:
        self.folders = folders

    def __call__(self, text: str) -> Path:
        path = Path(text)
        try:
            path.stat()
        except (OSError, ValueError) as error:
            why = getattr(error, "strerror", None) or error
            raise ArgumentTypeError(f"{text}: cannot be read: {why}") from None
        if path.is_dir() and not self.folders:
            raise ArgumentTypeError(f"{text}: cannot be read: this is a folder, not a file")
        if not os.access(path, os.R_OK):
            raise ArgumentTypeError(f"{text}: cannot be read: permission denied")
        return path


class OutputFile:
    """A file to be written, in a folder that is there; with `suffix`, of this kind."""

    metavar = "FILE"

    def __init__(self, suffix: str = "") -> None:
        self.suffix = suffix

    def __call__(self, text: str) -> Path:
        path = Path(text)
        if not path.parent.is_dir():
            raise ArgumentTypeError(f"there is no folder {path.parent}")
        if path.is_dir():
            raise ArgumentTypeError(f"{text} is a folder, not a file")
        if self.suffix and path.suffix != self.suffix:
            raise ArgumentTypeError(f"{path.name} is no {self.suffix} file")
        return path


class Folder:
    """A folder, which is made when it is not there."""

    metavar = "DIR"

    def __call__(self, text: str) -> Path:
        path = Path(text)
        above = next((each for each in (path, *path.parents) if each.exists()), path)
        if not above.is_dir():
            raise ArgumentTypeError(f"{above} is a file, not a folder")
        return path
