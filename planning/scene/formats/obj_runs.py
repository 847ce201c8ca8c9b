"""Runs of lines of OBJ that are all alike, read at once: plain vertices, plain faces of one size.

Most lines of a large file are such. Whatever is written otherwise is left to who goes line by line.
"""

from __future__ import annotations

import re
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

_LEAST_LINES: Final = 16
"""Fewer lines are as fast one by one."""
_PIECE: Final = 2**20
"""Characters of a run that are looked at together."""
_NUMBER: Final = r"[ \t]+[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?"
_VERTICES: Final = re.compile(rf"(?:v(?:{_NUMBER}){{3}}[ \t]*\n)++")
_CORNER: Final = r"[ \t]+[1-9][0-9]{0,6}(?:/[0-9]*){0,2}"
_FACES: Final = {n: re.compile(rf"(?:f(?:{_CORNER}){{{n}}}[ \t]*\n)++") for n in (3, 4)}
_BESIDE: Final = re.compile(r"/[0-9/]*")
"""Numbers of textures and normals in a corner."""
_KEYS: Final = str.maketrans("vf\n", "   ")


class Run(NamedTuple):
    """Lines that are alike, and their numbers one after the other."""

    numbers: NDArray[np.float64]
    lines: int
    end: int
    """Where the next line begins."""
    corners: int
    """Corners of each face; 0 for vertices."""


def run_at(text: str, begin: int) -> Run | None:
    """The run that begins at a line; None where there is none that is worth it."""
    key = text[begin : begin + 2]
    if key == "v ":
        return _read(text, begin, _VERTICES, 0)
    if key == "f ":
        corners = text.count(" ", begin, max(begin, text.find("\n", begin)))
        return _read(text, begin, _FACES[corners], corners) if corners in _FACES else None
    return None


def _read(text: str, begin: int, pattern: re.Pattern[str], corners: int) -> Run | None:
    found = pattern.match(text, begin, min(len(text), begin + _PIECE))
    if found is None:
        return None
    lines = text.count("\n", begin, found.end())
    if lines < _LEAST_LINES:
        return None
    plain = found[0]
    if corners and "/" in plain:
        plain = _BESIDE.sub("", plain)
    numbers = np.fromstring(plain.translate(_KEYS), sep=" ")
    if len(numbers) != lines * (corners or 3):
        return None
    return Run(numbers, lines, found.end(), corners)
