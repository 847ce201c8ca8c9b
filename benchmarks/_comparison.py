"""A comparison of two planners on the same pairs of points, with reasons for disagreements."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final, Protocol, Self

import numpy as np
from benchmarks._pairs import (
    Answer,
    Bools,
    Finders,
    Floats,
    finders_of,
    ground_points,
    last_reached,
    length_ratios,
    pairs_of,
    spread,
)

NO_GROUND: Final = "no ground at an end"
MOVED: Final = "an end moved elsewhere"
"""The planner that found no path finds one between the ends that the other planner chose."""
UNEXPLAINED: Final = "unexplained"
_CANDIDATES: Final = 4
_WARM_UP: Final = 50


class Planner(Protocol):
    """Finds paths on a mesh for one body."""

    @property
    def build_figures(self) -> Mapping[str, float]:
        """The time and memory of the import of the mesh, by name."""

    def build(self) -> None:
        """Import the mesh again."""

    def stands(self, points: Floats) -> Bools:
        """Whether there is ground near each of the points (N, 3)."""

    def find_paths(self, pairs: Floats) -> list[Answer]:
        """The answer to every pair, float64 (N, 2, 3), metres."""

    def relaxed(self) -> Iterator[tuple[str, Self]]:
        """Yield every rule by which a path may be refused, and a planner that relaxes it."""


@dataclass(frozen=True)
class Disagreement:
    """A pair for which only one planner finds a path, with the reason.

    `gap` is the point on that path up to which the other planner gets. Points are (x, y, z) in
    metres.
    """

    number: int
    finders: Finders
    why: str
    start: tuple[float, ...]
    goal: tuple[float, ...]
    gap: tuple[float, ...]


@dataclass(frozen=True)
class Comparison:
    """The answers of two planners to the same pairs, float64 (N, 2, 3), metres."""

    pairs: Floats
    ours: list[Answer]
    theirs: list[Answer]
    disagreements: list[Disagreement]

    def count(self, finders: Finders) -> int:
        """The number of pairs for which exactly these planners find a path."""
        return sum(found is finders for found in map(finders_of, self.ours, self.theirs))

    def figures(self) -> dict[str, Any]:
        """All counts and measures; ratios are ours over theirs, times are in microseconds."""
        return {
            "pairs": len(self.pairs),
            **{str(finders): self.count(finders) for finders in Finders},
            "length ratio": spread(length_ratios(self.ours, self.theirs)),
            "us": spread([answer.us for answer in self.ours]),
            "us, theirs": spread([answer.us for answer in self.theirs]),
        }


def random_pairs(mesh: Floats, planners: tuple[Planner, Planner], count: int, seed: int) -> Floats:
    """Random pairs of points on which a body can stand according to at least one planner.

    `mesh` holds the triangles, float64 (T, 3, 3), metres. The result is (count, 2, 3), metres.
    """
    random = np.random.default_rng(seed)
    points = ground_points(mesh, _CANDIDATES * count, random)
    known = planners[0].stands(points) | planners[1].stands(points)
    return pairs_of(points, known, count, random)


def compare(ours: Planner, theirs: Planner, pairs: Floats) -> Comparison:
    """Compare two planners that are compiled, and find the reason of every disagreement."""
    for planner in (ours, theirs):
        planner.build()
        planner.find_paths(pairs[-_WARM_UP:])
    mine, others = ours.find_paths(pairs), theirs.find_paths(pairs)
    refusals = [
        *explain_refusals(Finders.ONLY_THEIRS, ours, pairs, mine, others),
        *explain_refusals(Finders.ONLY_OURS, theirs, pairs, others, mine),
    ]
    return Comparison(pairs, mine, others, sorted(refusals, key=lambda refusal: refusal.number))


def explain_refusals(
    finders: Finders, refusing: Planner, pairs: Floats, refused: list[Answer], found: list[Answer]
) -> list[Disagreement]:
    """Find the reason for every pair that one planner refuses and the other solves.

    The refusing planner answers again with one rule relaxed at a time. The first rule that makes
    it find a path is the reason. `finders` says which planner found the path.
    """
    answers = enumerate(zip(refused, found, strict=True))
    numbers = [n for n, (no, yes) in answers if yes.found and not no.found]
    moved = [found[n].points[[0, -1]] for n in numbers]
    again = refusing.find_paths(np.array(moved)) if moved else []
    why = {n: MOVED for n, answer in zip(numbers, again, strict=True) if answer.found}
    why |= {n: NO_GROUND for n in numbers if n not in why and not all(refused[n].stands)}
    if len(why) < len(numbers):
        for rule, relaxed in refusing.relaxed():
            left = [n for n in numbers if n not in why]
            again = relaxed.find_paths(pairs[left]) if left else []
            why |= {n: rule for n, answer in zip(left, again, strict=True) if answer.found}
            if len(why) == len(numbers):
                break
    return [
        Disagreement(
            number=n,
            finders=finders,
            why=why.get(n, UNEXPLAINED),
            start=tuple(pairs[n, 0].tolist()),
            goal=tuple(pairs[n, 1].tolist()),
            gap=tuple(_gap(refusing, refused[n], found[n]).tolist()),
        )
        for n in numbers
    ]


def _gap(refusing: Planner, refused: Answer, found: Answer) -> Floats:
    """The last point of the found path that the refusing planner reaches, (3,), metres."""
    path = found.points
    if not all(refused.stands):
        end: Floats = path[-1] if refused.stands[0] else path[0]
        return end

    def reaches(point: Floats) -> bool:
        return refusing.find_paths(np.stack([path[0], point])[None])[0].found

    return last_reached(path, reaches)
