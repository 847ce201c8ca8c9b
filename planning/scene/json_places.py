"""Places in JSON text: the line and column at which a value or a key begins."""

from __future__ import annotations

import json
import re
from bisect import bisect_right
from collections.abc import Iterable
from typing import Any, Final

Path = tuple[str | int, ...]
Spot = tuple[int, int]
"""Line and column, both from 1."""

_SPACE: Final = re.compile(r"[ \t\n\r]*")
_DECODER: Final = json.JSONDecoder(strict=False)


def find_places(text: str, paths: Iterable[Path]) -> dict[Path, Spot]:
    """Where the value of each path begins; that of what holds it where there is none.

    Values that no path leads into are passed over at the speed of the decoder. The text must be
    JSON.
    """
    wanted: dict[Any, Any] = {}
    paths = list(paths)
    for path in paths:
        branch = wanted
        for step in path:
            branch = branch.setdefault(step, {})
    found: dict[Path, int] = {}
    _walk(text, _space(text, 0), (), wanted, found)
    breaks = [place for place, letter in enumerate(text) if letter == "\n"] if found else []
    spots = {}
    for path in paths:
        known = path
        while known and known not in found:
            known = known[:-1]
        place = found[known]
        line = bisect_right(breaks, place - 1)
        spots[path] = line + 1, place - (breaks[line - 1] if line else -1)
    return spots


def _space(text: str, place: int) -> int:
    match = _SPACE.match(text, place)
    return match.end() if match else place


def _walk(text: str, place: int, path: Path, wanted: dict[Any, Any], found: dict[Path, int]) -> int:
    """Note where a value begins, and those within it; returns where it ends."""
    found[path] = place
    if not wanted or text[place] not in "[{":
        return _DECODER.raw_decode(text, place)[1]
    in_object = text[place] == "{"
    place = _space(text, place + 1)
    number = 0
    while text[place] not in "]}":
        step: str | int = number
        if in_object:
            step, place = _DECODER.raw_decode(text, place)
            place = _space(text, _space(text, place) + 1)
        branch = wanted.get(step)
        if branch is None:
            place = _DECODER.raw_decode(text, place)[1]
        else:
            place = _walk(text, place, (*path, step), branch, found)
        place = _space(text, place)
        if text[place] == ",":
            place = _space(text, place + 1)
        number += 1
    return place + 1
