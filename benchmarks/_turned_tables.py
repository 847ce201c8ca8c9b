"""Tables of doors, flights and ramps by width: the number of turns at which each finds the way."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Final

import numpy as np
from benchmarks import _four_answers as four
from benchmarks._detour import Detour, NavMeshSettings
from benchmarks._scene_triangles import triangles_of
from benchmarks._turned_scenes import Case, Point, Turn, doorway, flight, low_flight, ramp
from rich import box
from rich.console import Console
from rich.table import Table

from esplanade.commandline.progress import progress
from esplanade.planning import Body, LayeredGrid

RECAST: Final = "Recast"
RECAST_CELL_M: Final = 0.05
TWO_OFFSETS: Final = ((0.0, 0.0), (0.13, 0.065))
FOUR_OFFSETS: Final = ((0.0, 0.0), (0.05, 0.11), (0.125, 0.0), (0.19, 0.07))
MARGIN_M: Final = 0.1
"""Flights, ramps and doors are passable if they are wider than the body by this."""

Answer = Callable[[LayeredGrid, Case], bool]


@dataclass
class Tables:
    """Where tables are printed, and what all of them have in common."""

    console: Console
    angles: Sequence[float]
    with_recast: bool
    wrong: int = 0
    """Answers of ours that were wrong so far."""

    def turns(self, offsets: Sequence[Point], angles: Sequence[float] | None = None) -> list[Turn]:
        """Every angle with every offset."""
        chosen = self.angles if angles is None else angles
        return [Turn(angle, offset) for angle in chosen for offset in offsets]


class Recast:
    """A navigation mesh for one case after the other, in one process for each radius."""

    def __init__(self) -> None:
        self._processes: dict[float, Detour] = {}

    def finds(self, case: Case) -> bool:
        """Whether it finds the way there and back."""
        triangles = triangles_of(case.scene)
        detour = self._processes.get(case.body.radius_m)
        if detour is None:
            detour = Detour(triangles, recast_settings(case.body))
            self._processes[case.body.radius_m] = detour
        else:
            detour.rebuild(triangles)
        pairs = np.array([(case.start, case.goal), (case.goal, case.start)])
        return all(answer.found for answer in detour.find_paths(pairs))

    def close(self) -> None:
        """End the processes."""
        for detour in self._processes.values():
            detour.__exit__()


@contextmanager
def recast(wanted: bool) -> Iterator[Recast | None]:
    """Recast while it is needed; None if it is not wanted."""
    made = Recast() if wanted else None
    try:
        yield made
    finally:
        if made is not None:
            made.close()


def recast_settings(body: Body) -> NavMeshSettings:
    """The same body for Recast."""
    return NavMeshSettings(body.radius_m, body.height_m, body.step_on_m, cell_m=RECAST_CELL_M)


# --- the tables -------------------------------------------------------------------------------

_KEYS: Final[dict[str, Answer]] = {**four.ANSWERS, "keys": four.keys}


def flights(tables: Tables) -> dict[str, Any]:
    """Flights of eight steps, and of treads of other depths, at two offsets."""
    widths = (0.45, 0.6, 0.7, 0.8, 0.9, 1.0, 1.2, 1.5, 2.0)
    rows = {f"{width:.2f} m": partial(_flight, width, 8, 0.3) for width in widths}
    for steps, tread in ((8, 0.25), (8, 0.35), (16, 0.3), (40, 0.3)):
        name = f"0.90 m, {steps} of {tread:.2f} m"
        rows[name] = partial(_flight, 0.9, steps, tread)
    expected = [float(name.split()[0]) >= 0.5 + MARGIN_M for name in rows]
    return _measure(tables, "flights", rows, expected, tables.turns(TWO_OFFSETS), _KEYS)


def _flight(width_m: float, steps: int, tread_m: float, turn: Turn) -> Case:
    return flight(turn, width_m, Body.adult(), steps, tread_m)


def doors(tables: Tables) -> dict[str, Any]:
    """Doors in a wall, at four offsets; one of two equal angles, 0 and 90, is left out."""
    widths = (0.45, 0.56, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9)
    rows = {f"{width:.2f} m": partial(_door, width) for width in widths}
    angles = [angle for angle in tables.angles if angle < 90.0]
    turns = tables.turns(FOUR_OFFSETS, angles)
    return _measure(tables, "doors", rows, [w > 0.5 for w in widths], turns, four.ANSWERS)


def _door(width_m: float, turn: Turn) -> Case:
    return doorway(turn, width_m, Body.adult())


def ramps(tables: Tables) -> dict[str, Any]:
    """Ramps up to a floor, at two offsets."""
    widths = (0.45, 0.6, 0.7, 0.9, 1.2, 2.0)
    rows = {f"{width:.2f} m": partial(_ramp, width) for width in widths}
    turns = tables.turns(TWO_OFFSETS)
    return _measure(tables, "ramps", rows, [w >= 0.6 for w in widths], turns, _KEYS)


def _ramp(width_m: float, turn: Turn) -> Case:
    return ramp(turn, width_m, Body.adult())


def edges(tables: Tables) -> dict[str, Any]:
    """Flights of low steps for bodies that may stay on edges for M cells.

    M is counted from the smallest with which the tool finds a way. People have the M of adults, so
    only the other three are asked.
    """
    rows = {
        f"{steps} steps, {more:+d}": partial(_low_flight, steps, more)
        for steps in (12, 24, 36)
        for more in (-1, 0, 1, 2, 4, 8)
    }
    answers = {name: each for name, each in four.ANSWERS.items() if name != "person"}
    expected = [not row.endswith("-1") for row in rows]
    ours = replace(tables, with_recast=False)
    figures = _measure(ours, "edges", rows, expected, tables.turns(((0.0, 0.0),)), answers)
    tables.wrong = ours.wrong
    return figures


def _low_flight(steps: int, more: int, turn: Turn) -> Case:
    grid = LayeredGrid.from_scene(low_flight(turn, steps, Body.adult()).scene)
    most = next(
        cells
        for cells in range(2, 8 * steps)
        if four.tool(grid, low_flight(turn, steps, Body(edge_cells=cells)))
    )
    return low_flight(turn, steps, Body(edge_cells=most + more))


def _measure(
    tables: Tables,
    title: str,
    rows: dict[str, Callable[[Turn], Case]],
    expected: Sequence[bool] | None,
    turns: Sequence[Turn],
    answers: dict[str, Answer],
) -> dict[str, Any]:
    """Print how many of the turns each answer finds the way at; return the same figures.

    Without what is expected, answers that differ from the tool's are counted as wrong.
    """
    names = [*answers, *([RECAST] if tables.with_recast else [])]
    table = Table(title=f"{title}: {len(turns)} each", box=box.SIMPLE, padding=(0, 0, 0, 1))
    for name in ("", "way", *names, "wrong"):
        table.add_column(name, justify="right", no_wrap=True)
    figures: dict[str, Any] = {}
    with recast(tables.with_recast) as theirs, progress(time_left=True) as bar:
        task = bar.add_task(title, total=len(rows) * len(turns))
        for number, (row, made) in enumerate(rows.items()):
            found = dict.fromkeys(names, 0)
            wrong = 0
            for turn in turns:
                case = made(turn)
                grid = LayeredGrid.from_scene(case.scene)
                said = {name: answer(grid, case) for name, answer in answers.items()}
                right = said["tool"] if expected is None else expected[number]
                wrong += sum(one is not right for one in said.values())
                if theirs is not None:
                    said[RECAST] = theirs.finds(case)
                for name, one in said.items():
                    found[name] += one
                bar.advance(task)
            tables.wrong += wrong
            figures[row] = {**found, "wrong": wrong, "turns": len(turns)}
            way = "" if expected is None else "yes" if expected[number] else "no"
            table.add_row(row, way, *(str(found[name]) for name in names), str(wrong))
    tables.console.print(table)
    return figures
