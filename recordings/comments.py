"""Comments of a table: the rate, the unit of length and the columns that they name."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Final, NamedTuple

from esplanade.recordings.columns import find_columns
from esplanade.recordings.dialect import Line
from esplanade.recordings.errors import RecordingError
from esplanade.recordings.units import length_named, length_said, time_named

_NUMBER: Final = r"([-+]?[\d.]{1,20}(?:,\d{1,6})?(?:e[-+]?\d{1,3})?(?:\s?/\s?[\d.]{1,20})?)"
"""A number with a decimal point or comma, or a fraction."""
_GAP: Final = r"(?![a-z])[^\d+-]{0,20}"
_FRAMES: Final = (
    re.compile(rf"(?<![a-z])(?:frame[\s_-]?rate|fps){_GAP}{_NUMBER}", re.IGNORECASE),
    re.compile(rf"\b(?:recording|capture)[\s_]?(?:rate|frequency){_GAP}{_NUMBER}", re.IGNORECASE),
)
_SAMPLES: Final = re.compile(rf"\bsampl\w*[\s_]?(?:rate|frequency){_GAP}{_NUMBER}", re.IGNORECASE)
_ALONE: Final = re.compile(
    rf"{_NUMBER}\s*(?:fps|hz|frames?\s*(?:/|per)\s*s(?:ec(?:ond)?)?)\b", re.IGNORECASE
)
_SPAN: Final = rf"{_GAP}{_NUMBER}\s*(ms|milliseconds?|s|sec|seconds?)?\b"
_FRAMES_A_SECOND: Final = re.compile(
    rf"\bframes?\s*(?:/|a|per)\s*s(?:ec(?:ond)?)?{_GAP}{_NUMBER}", re.IGNORECASE
)
_FRAME_SPAN: Final = re.compile(
    rf"\bframe[\s_]?(?:interval|period|time|duration){_SPAN}", re.IGNORECASE
)
_SAMPLE_SPAN: Final = re.compile(
    rf"\b(?:sampl\w*[\s_]?(?:interval|period|time)|time[\s_]?step|delta[\s_]?t|dt){_SPAN}",
    re.IGNORECASE,
)
_LONGEST_SPAN_S: Final = 10.0
_MOST_A_SECOND: Final = 1e6
_SPACED_UNIT: Final = re.compile(r"(?<=\w)[ \t]+(?=[\[(])")
_NO_UNIT: Final = frozenset(("", "-", "1"))


class Said(NamedTuple):
    """Frames or samples a second and the unit of length, as comments say them."""

    fps: float | None = None
    unit: str | None = None
    samples_per_s: float | None = None


def said_in(path: Path, comments: Sequence[Line]) -> Said:
    """Look for a rate and a unit in the comments.

    Raises
    ------
    RecordingError
        The rate is none.
    """
    unit = next(filter(None, (length_said(line.text) for line in comments)), None)
    for form in _FRAMES:
        if (fps := _rate(path, comments, form)) is not None:
            return Said(fps, unit)
    if (found := _rate(path, comments, _SAMPLES)) is not None:
        return Said(None, unit, found)
    for form in (_ALONE, _FRAMES_A_SECOND):
        if (fps := _rate(path, comments, form)) is not None:
            return Said(fps, unit)
    if (span_s := _span(comments, _FRAME_SPAN)) is not None:
        return Said(1.0 / span_s, unit)
    span_s = _span(comments, _SAMPLE_SPAN)
    return Said(None, unit, None if span_s is None else 1.0 / span_s)


def header_in(comments: Sequence[Line], width: int) -> list[str] | None:
    """The cells of the last comment that names all columns, as PeTrack and JPSreport write it.

    A comment behind it may give the units.
    """
    for place in range(len(comments) - 1, -1, -1):
        for cells in _divided(comments[place].text):
            if 4 <= len(cells) <= width and not find_columns(cells).missing:
                return _with_units(cells, comments[place + 1 : place + 2])
    return None


def together(text: str) -> str:
    """The text of a header in which units in brackets are not apart from their names."""
    return _SPACED_UNIT.sub("", text)


def _divided(text: str) -> tuple[list[str], list[str]]:
    text = together(text.lstrip("#/%* \t"))
    return text.split(), [cell.strip() for cell in re.split(r"[,;\t|]", text)]


def _with_units(cells: list[str], behind: Sequence[Line]) -> list[str]:
    for line in behind:
        for units in _divided(line.text):
            plain = [unit.strip("[]()") for unit in units]
            known = [
                unit in _NO_UNIT or length_named(unit) is not None or time_named(unit) is not None
                for unit in plain
            ]
            if len(plain) == len(cells) and all(known) and any(map(length_named, plain)):
                return [
                    cell if unit in _NO_UNIT else f"{cell}/{unit}"
                    for cell, unit in zip(cells, plain, strict=True)
                ]
    return cells


def _rate(path: Path, comments: Sequence[Line], form: re.Pattern[str]) -> float | None:
    for line in comments:
        found = form.search(line.text)
        if not found or (fps := _value(found[1])) is None:
            continue
        if not 0.0 < fps < _MOST_A_SECOND:
            raise RecordingError(
                path, f"the frame rate is {found[1]}, expected more than 0", line.number
            )
        return fps
    return None


def _span(comments: Sequence[Line], form: re.Pattern[str]) -> float | None:
    """Seconds from one to the next; None where no comment gives a time that can be meant."""
    for line in comments:
        found = form.search(line.text)
        if not found or (span := _value(found[1])) is None:
            continue
        if found[2] is None and span >= 1.0:
            continue  # a number of steps
        span_s = span * (time_named(found[2] or "s") or 1.0)
        if 1.0 / _MOST_A_SECOND < span_s <= _LONGEST_SPAN_S:
            return span_s
    return None


def _value(text: str) -> float | None:
    above, _, below = text.replace(",", ".").partition("/")
    try:
        return float(above) / float(below or 1.0)
    except (ValueError, ZeroDivisionError):
        return None
