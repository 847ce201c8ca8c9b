"""Two forms of films from above, in pixels: Grand Central's triples and Edinburgh's lists."""

import re
from pathlib import Path
from typing import Final

import numpy as np

from esplanade.recordings.dialect import Table
from esplanade.recordings.errors import RecordingError
from esplanade.recordings.rows import Rows, number, people
from esplanade.recordings.units import PIXELS

_TRACK: Final = re.compile(r"TRACK\.([A-Za-z]*\d+)\s*=\s*\[(.*)\]\s*;?")
_PROPERTIES: Final = "Properties."


def looks_like_triples(table: Table) -> bool:
    """Whether each line is one number, in threes of x, y and frame."""
    return len(table.lines) % 3 == 0 and all(line.text.isdecimal() for line in table.lines)


def read_triples(table: Table) -> Rows:
    """Read the samples of one person of Grand Central Station."""
    block = np.array([float(line.text[:18]) for line in table.lines]).reshape(-1, 3)
    return Rows(
        format="Grand Central",
        lines=np.array([line.number for line in table.lines[::3]], np.int64),
        ids=["1"],
        who=np.zeros(len(block), np.int64),
        clock=block[:, 2],
        x=block[:, 0],
        y=-block[:, 1],
        counts_frames=True,
        usual_fps=25.0,
        usual_from="as that film has",
        unit=PIXELS,
        unit_from="as its form has it",
    )


def looks_like_lists(table: Table) -> bool:
    """Whether the lines are properties and tracks of Edinburgh's Informatics Forum."""
    return table.lines[0].text.startswith((_PROPERTIES, "TRACK."))


def read_lists(path: Path, table: Table) -> Rows:
    """Read tracks, each in a line as `TRACK.R1=[[x y frame];[x y frame]];`.

    Raises
    ------
    RecordingError
        A line is none of these.
    """
    names: list[str] = []
    lines: list[int] = []
    values: list[tuple[float, ...]] = []
    for line in table.lines:
        if line.text.startswith(_PROPERTIES):
            continue
        found = _TRACK.fullmatch(line.text.strip())
        if found is None:
            fault = f"{line.text!r:.40} is no TRACK.ID=[[x y frame];..]"
            raise RecordingError(path, fault, line.number)
        for part in found[2].split(";"):
            cells = part.strip(" []").split()
            if len(cells) != 3:
                raise RecordingError(path, f"{part!r:.40} is no [x y frame]", line.number)
            names.append(found[1])
            lines.append(line.number)
            named = zip(("x", "y", "frame"), cells, strict=True)
            values.append(tuple(number(path, line.number, column, cell) for column, cell in named))
    ids, who = people(names)
    block = np.array(values, np.float64).reshape(-1, 3)
    return Rows(
        format="Edinburgh tracks",
        lines=np.array(lines, np.int64),
        ids=ids,
        who=who,
        clock=block[:, 2],
        x=block[:, 0],
        y=-block[:, 1],
        counts_frames=True,
        usual_fps=9.0,
        usual_from="as that film has",
        unit=PIXELS,
        unit_from="as its form has it",
    )
