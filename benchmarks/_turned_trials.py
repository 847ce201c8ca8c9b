"""Random plans at every angle, judged by shapely."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
from benchmarks import _four_answers as four
from benchmarks._turned_plans import KINDS, ROOMS_M, Plan, random_plan
from benchmarks._turned_scenes import Case, Turn
from benchmarks._turned_tables import RECAST, Recast, Tables, recast
from rich import box
from rich.table import Table

from esplanade.commandline.progress import progress
from esplanade.planning import LayeredGrid

LISTED: Final = 30
"""At most so many wrong answers are listed."""
_CELL_M: Final = 0.25


@dataclass
class Tally:
    """Answers and wrong ones, by kind of plan or by room, and by who answered."""

    asked: Counter[tuple[str, str]] = field(default_factory=Counter)
    wrong: Counter[tuple[str, str]] = field(default_factory=Counter)
    plans: Counter[str] = field(default_factory=Counter)
    with_way: Counter[str] = field(default_factory=Counter)

    def note(self, row: str, name: str, right: bool) -> None:
        """Note an answer."""
        self.asked[row, name] += 1
        self.wrong[row, name] += not right


def measure_plans(tables: Tables, scenes: int, seed: int, actor_angles: int) -> dict[str, Any]:
    """Print how often each is wrong about plans of each kind, and list what is wrong."""
    kinds, rooms = Tally(), Tally()
    listed: list[str] = []
    with recast(tables.with_recast) as theirs, progress(time_left=True) as bar:
        task = bar.add_task("plans", total=scenes * len(tables.angles))
        for number in range(scenes):
            random = np.random.default_rng([seed, number])
            plan = random_plan(random)
            rows = (kinds, plan.kind), (rooms, _room(plan))
            for tally, row in rows:
                tally.plans[row] += 1
                tally.with_way[row] += plan.has_way
            walked = random.permutation(len(tables.angles))[:actor_angles].tolist()
            for place, degrees in enumerate(tables.angles):
                turn = Turn(degrees, tuple(random.uniform(0.0, _CELL_M, 2).tolist()))
                for name, found in _answers(plan.turned(turn), place in walked, theirs).items():
                    right = found is plan.has_way
                    for tally, row in rows:
                        tally.note(row, name, right)
                    if not right and name != RECAST:
                        listed.append(_line(name, number, plan, turn))
                bar.advance(task)
    names = [*four.ANSWERS, *([RECAST] if tables.with_recast else [])]
    angles = len(tables.angles)
    _show(tables, f"plans at {angles} angles: wrong of all", kinds, KINDS, names)
    by_room = [f"{sign}{100 * room:g} cm" for sign in "-+" for room in ROOMS_M]
    _show(tables, "the same by the room on each side, at least", rooms, by_room, names)
    for line in listed[:LISTED]:
        tables.console.print(line, highlight=False)
    tables.wrong += len(listed)
    return {"kinds": _figures(kinds, KINDS, names), "rooms": _figures(rooms, by_room, names)}


def _room(plan: Plan) -> str:
    return f"{'+' if plan.has_way else '-'}{100 * plan.room_m:g} cm"


def _answers(case: Case, with_actor: bool, theirs: Recast | None) -> dict[str, bool]:
    grid = LayeredGrid.from_scene(case.scene)
    said = {
        name: answer(grid, case)
        for name, answer in four.ANSWERS.items()
        if with_actor or name != "actor"
    }
    return said if theirs is None else {**said, RECAST: theirs.finds(case)}


def _line(name: str, number: int, plan: Plan, turn: Turn) -> str:
    said = "misses a way" if plan.has_way else "finds what is no way"
    x, y = turn.aside_m
    where = f"{turn.degrees:g} degrees, moved by {x:.6f}, {y:.6f}"
    return f"{name} {said}: plan {number} ({plan.kind}), {where}, radius {plan.radius_m:g} m"


def _figures(tally: Tally, rows: Iterable[str], names: Sequence[str]) -> dict[str, Any]:
    return {
        row: {
            "plans": tally.plans[row],
            "with a way": tally.with_way[row],
            **{
                name: {"asked": tally.asked[row, name], "wrong": tally.wrong[row, name]}
                for name in names
            },
        }
        for row in rows
    }


def _show(
    tables: Tables, title: str, tally: Tally, rows: Iterable[str], names: Sequence[str]
) -> None:
    table = Table(title=title, box=box.SIMPLE, padding=(0, 0, 0, 1))
    for name in ("", "plans", "with a way", *names):
        table.add_column(name, justify="right", no_wrap=True)
    for row in rows:
        if tally.plans[row]:
            cells = [f"{tally.wrong[row, name]} of {tally.asked[row, name]}" for name in names]
            table.add_row(row, str(tally.plans[row]), str(tally.with_way[row]), *cells)
    tables.console.print(table)
