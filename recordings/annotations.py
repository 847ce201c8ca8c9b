"""Forms of well-known sets that no header names: boxes in films, and people seen by lasers."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from esplanade.recordings.cells import read_cells
from esplanade.recordings.dialect import Dialect, Line, Table
from esplanade.recordings.errors import RecordingError
from esplanade.recordings.rows import Rows, number, people
from esplanade.recordings.units import PIXELS

_WHOLE: Final = re.compile(r"-?[0-9]{1,15}")
_DATED: Final = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d[:.]\d+")
_PEOPLE: Final = ("ped", "pedestrian", "human", "man", "woman", "person", "people")
_AS_FORM: Final = "as its form has it"


class _Form(NamedTuple):
    """A form that the cells of the first line show, and what reads it."""

    shows: Callable[[Dialect, list[str]], bool]
    read: Callable[[Path, Table, Dialect], Rows]


def looks_annotated(dialect: Dialect, line: Line) -> bool:
    """Whether the line is one of these forms."""
    return _form_of(dialect, line) is not None


def read_annotated(path: Path, table: Table, dialect: Dialect) -> Rows:
    """Read the samples of people; those of others are left out.

    Raises
    ------
    RecordingError
        A line does not fit.
    """
    form = _form_of(dialect, table.lines[0])
    if form is None:
        raise RecordingError(path, "it has none of the known forms", table.lines[0].number)
    return form.read(path, table, dialect)


def _form_of(dialect: Dialect, line: Line) -> _Form | None:
    cells = dialect.cells(line.text)
    return next((form for form in _FORMS if form.shows(dialect, cells)), None)


def _numbers(dialect: Dialect, cells: list[str]) -> bool:
    return all(dialect.is_number(cell) for cell in cells)


def _is_whole(cell: str) -> bool:
    return bool(_WHOLE.fullmatch(cell))


def _is_stanford(dialect: Dialect, cells: list[str]) -> bool:
    return len(cells) == 10 and _numbers(dialect, cells[:9]) and cells[9].strip('"').isalpha()


def _stanford(path: Path, table: Table, dialect: Dialect) -> Rows:
    """Stanford Drone: boxes in pixels, of which the middle counts; those marked lost do not."""
    names = "id xmin ymin xmax ymax frame lost occluded generated kind"
    places = {name: place for place, name in enumerate(names.split())}
    cells, others = read_cells(
        path, table.lines, dialect, places, len(places), names,
        lambda kind: kind.strip('"').lower() == "pedestrian",
    )  # fmt: skip
    numbers = cells.numbers
    seen = numbers["lost"] == 0.0
    remarks = [f"{others} samples of bikers, carts and others are left out"] if others else []
    lost = int(np.count_nonzero(~seen))
    if lost:
        remarks.append(f"{lost} samples that are marked as lost are left out")
    return Rows(
        format="Stanford Drone annotations",
        lines=cells.lines[seen],
        ids=cells.ids,
        who=cells.who[seen],
        clock=numbers["frame"][seen],
        x=(numbers["xmin"] + numbers["xmax"])[seen] / 2.0,
        y=-(numbers["ymin"] + numbers["ymax"])[seen] / 2.0,
        counts_frames=True,
        usual_fps=30.0,
        usual_from="as Stanford's videos have",
        unit=PIXELS,
        unit_from=_AS_FORM,
        remarks=tuple(remarks),
        dropped=others + lost,
    )


def _is_town_centre(dialect: Dialect, cells: list[str]) -> bool:
    flags = len(cells) == 12 and all(cell in ("0", "1") for cell in cells[2:4])
    return flags and dialect.delimiter == "," and _numbers(dialect, cells)


def _town_centre(path: Path, table: Table, dialect: Dialect) -> Rows:
    """Town Centre: boxes of heads and bodies in pixels; one stands at the foot of the body's."""
    names = [
        "id",
        "frame",
        "head",
        "body",
        "head_left",
        "head_top",
        "head_right",
        "head_bottom",
        "left",
        "top",
        "right",
        "bottom",
    ]
    places = {name: place for place, name in enumerate(names)}
    cells, _ = read_cells(path, table.lines, dialect, places, len(names), ",".join(names))
    numbers = cells.numbers
    seen = numbers["body"] == 1.0
    hidden = int(np.count_nonzero(~seen))
    return Rows(
        format="Town Centre annotations",
        lines=cells.lines[seen],
        ids=cells.ids,
        who=cells.who[seen],
        clock=numbers["frame"][seen],
        x=(numbers["left"] + numbers["right"])[seen] / 2.0,
        y=-numbers["bottom"][seen],
        counts_frames=True,
        usual_fps=25.0,
        usual_from="as that film has",
        unit=PIXELS,
        unit_from=_AS_FORM,
        remarks=(f"{hidden} samples whose body is not valid are left out",) if hidden else (),
        dropped=hidden,
    )


def _is_challenge(dialect: Dialect, cells: list[str]) -> bool:
    if dialect.delimiter != "," or len(cells) not in (9, 10) or not _numbers(dialect, cells):
        return False
    return all(map(_is_whole, cells[:2])) and min(map(float, cells[4:6])) > 0.0


def _challenge(path: Path, table: Table, dialect: Dialect) -> Rows:
    """MOTChallenge: boxes in pixels; one stands at the foot, and not all of them count."""
    names = ["frame", "id", "left", "top", "width", "height", "counts", "class", "seen", "more"]
    width = len(dialect.cells(table.lines[0].text))
    places = {name: place for place, name in enumerate(names[:width])}
    cells, _ = read_cells(path, table.lines, dialect, places, width, ",".join(names[:width]))
    numbers = cells.numbers
    counts = numbers["counts"] != 0.0
    if width == 9:
        counts &= numbers["class"] == 1.0
    others = int(np.count_nonzero(~counts))
    return Rows(
        format="MOTChallenge annotations",
        lines=cells.lines[counts],
        ids=cells.ids,
        who=cells.who[counts],
        clock=numbers["frame"][counts],
        x=(numbers["left"] + 0.5 * numbers["width"])[counts],
        y=-(numbers["top"] + numbers["height"])[counts],
        counts_frames=True,
        unit=PIXELS,
        unit_from=_AS_FORM,
        remarks=(f"{others} samples that do not count or are no people are left out",)
        if others
        else (),
        dropped=others,
    )


def _is_kitti(dialect: Dialect, cells: list[str]) -> bool:
    rest = [*cells[:2], *cells[3:]]
    return len(cells) in (17, 18) and cells[2].isalpha() and _numbers(dialect, rest)


def _kitti(path: Path, table: Table, dialect: Dialect) -> Rows:
    """KITTI: metres to the right of a camera and ahead of it; the camera is on a car."""
    width = len(dialect.cells(table.lines[0].text))
    places = {"frame": 0, "id": 1, "kind": 2, "x": 13, "y": 15}
    cells, others = read_cells(
        path, table.lines, dialect, places, width, "frame id type ..",
        lambda kind: kind.lower() in ("pedestrian", "person", "person_sitting"),
    )  # fmt: skip
    remarks = ["places are as seen from a car: where it moved, these are not people's own ways"]
    if others:
        remarks.append(f"{others} samples of vehicles and others are left out")
    return Rows(
        format="KITTI labels",
        lines=cells.lines,
        ids=cells.ids,
        who=cells.who,
        clock=cells.numbers["frame"],
        x=cells.numbers["x"],
        y=cells.numbers["y"],
        counts_frames=True,
        usual_fps=10.0,
        usual_from="as KITTI has",
        unit="m",
        unit_from=_AS_FORM,
        remarks=tuple(remarks),
        dropped=others,
    )


def _is_traf(_: Dialect, cells: list[str]) -> bool:
    if len(cells) < 7 or not all(map(_is_whole, cells[:6])) or not cells[6][:1].isalpha():
        return False
    return len(cells) == 2 + 5 * int(cells[1])


def _traf(path: Path, table: Table, dialect: Dialect) -> Rows:
    """TRAF: a frame a line, with x, y, width, height and name of everyone in it, in pixels."""
    names: list[str] = []
    lines: list[int] = []
    samples: list[tuple[float, float, float]] = []
    others = 0
    for line in table.lines:
        cells = [cell for cell in dialect.cells(line.text) if cell]
        if len(cells) < 2 or (len(cells) - 2) % 5:
            fault = f"expected a frame, a count and five columns for each, not {len(cells)} columns"
            raise RecordingError(path, fault, line.number)
        frame = number(path, line.number, "frame", cells[0])
        for place in range(2, len(cells), 5):
            name = cells[place + 4]
            if name.rstrip("0123456789").lower() not in _PEOPLE:
                others += 1
                continue
            columns = zip(("x", "y", "width", "height"), cells[place : place + 4], strict=True)
            x, y, wide, high = (number(path, line.number, c, cell) for c, cell in columns)
            names.append(name)
            lines.append(line.number)
            samples.append((frame, x + 0.5 * wide, -(y + high)))
    ids, who = people(names)
    block = np.array(samples, np.float64).reshape(-1, 3)
    return Rows(
        format="TRAF annotations",
        lines=np.array(lines, np.int64),
        ids=ids,
        who=who,
        clock=block[:, 0],
        x=block[:, 1],
        y=block[:, 2],
        counts_frames=True,
        usual_fps=10.0,
        usual_from="as TRAF has",
        unit=PIXELS,
        unit_from=_AS_FORM,
        remarks=(f"{others} samples of vehicles and others are left out",) if others else (),
        dropped=others,
    )


def _is_atc(dialect: Dialect, cells: list[str]) -> bool:
    if len(cells) != 8 or not _numbers(dialect, cells):
        return False
    return float(dialect.plain(cells[0])) > 1e8 and _is_whole(cells[1])


def _atc(path: Path, table: Table, dialect: Dialect) -> Rows:
    """ATC: time, id, x, y and height in millimetres, speed, and two angles."""
    places = {"time": 0, "id": 1, "x": 2, "y": 3}
    names = "time,id,x,y,z,speed,angle,facing"
    cells, _ = read_cells(path, table.lines, dialect, places, 8, names)
    return Rows(
        format="ATC",
        lines=cells.lines,
        ids=cells.ids,
        who=cells.who,
        clock=cells.numbers["time"],
        x=cells.numbers["x"],
        y=cells.numbers["y"],
        times_named=True,
        unit="mm",
        unit_from=_AS_FORM,
    )


def _is_dated(_: Dialect, cells: list[str]) -> bool:
    return len(cells) == 5 and bool(_DATED.fullmatch(cells[0]))


def _dated(path: Path, table: Table, dialect: Dialect) -> Rows:
    """Crowds of a station (CFF): moment, place, x and y in millimetres, id."""
    places = {"time": 0, "x": 2, "y": 3, "id": 4}
    cells, _ = read_cells(path, table.lines, dialect, places, 5, "time;place;x;y;id")
    return Rows(
        format="CFF station",
        lines=cells.lines,
        ids=cells.ids,
        who=cells.who,
        clock=cells.numbers["time"],
        x=cells.numbers["x"],
        y=cells.numbers["y"],
        times_named=True,
        unit="mm",
        unit_from=_AS_FORM,
    )


_FORMS: Final = (
    _Form(_is_stanford, _stanford),
    _Form(_is_town_centre, _town_centre),
    _Form(_is_challenge, _challenge),
    _Form(_is_kitti, _kitti),
    _Form(_is_traf, _traf),
    _Form(_is_atc, _atc),
    _Form(_is_dated, _dated),
)
