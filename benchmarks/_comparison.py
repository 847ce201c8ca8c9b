"""One mesh walked over by two planners: the same pairs asked of both, and why they disagree."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final, Protocol, Self

import numpy as np
from benchmarks._pairs import (
    Answer,
    Bools,
    Floats,
    Verdict,
    ground_points,
    last_reached,
    length_ratios,
    pairs_of,
    spread,
    verdict,
)

NO_GROUND: Final = "no ground at an end"
MOVED: Final = "an end moved elsewhere"
"""From the places that the other chose for both ends, who refused finds a way too."""
UNEXPLAINED: Final = "unexplained"
_CANDIDATES: Final = 4
_WARM_UP: Final = 50


class Planner(Protocol):
    """Finds ways on a mesh for one body."""

    @property
    def made(self) -> Mapping[str, float]:
        """What it took to import the mesh."""

    def make(self) -> None:
        """Import the mesh again."""

    def stands(self, points: Floats) -> Bools:
        """Whether there is ground near each of the points (N, 3)."""

    def ways(self, pairs: Floats) -> list[Answer]:
        """What is said of every pair, float64 (N, 2, 3)."""

    def eased(self) -> Iterator[tuple[str, Self]]:
        """Every rule by which a way may be refused, and a planner that eases it."""


@dataclass(frozen=True)
class Disagreement:
    """A pair of which only one planner finds a way, why, and where the other gets no further."""

    number: int
    who: Verdict
    why: str
    start: tuple[float, ...]
    goal: tuple[float, ...]
    gap: tuple[float, ...]


@dataclass(frozen=True)
class Comparison:
    """Two planners' answers to the same pairs, float64 (N, 2, 3)."""

    pairs: Floats
    ours: list[Answer]
    theirs: list[Answer]
    disagreements: list[Disagreement]

    def count(self, who: Verdict) -> int:
        """Of how many pairs the named find a way."""
        return sum(found is who for found in map(verdict, self.ours, self.theirs))

    def figures(self) -> dict[str, Any]:
        """All counts and measures: ratios of ours over theirs, times in microseconds."""
        return {
            "pairs": len(self.pairs),
            **{str(who): self.count(who) for who in Verdict},
            "length ratio": spread(length_ratios(self.ours, self.theirs)),
            "us": spread([answer.us for answer in self.ours]),
            "us, theirs": spread([answer.us for answer in self.theirs]),
        }


def random_pairs(mesh: Floats, planners: tuple[Planner, Planner], count: int, seed: int) -> Floats:
    """Pairs (count, 2, 3) of points that are ground to at least one of two planners.

    `mesh` are triangles, float64 (T, 3, 3).
    """
    random = np.random.default_rng(seed)
    points = ground_points(mesh, _CANDIDATES * count, random)
    known = planners[0].stands(points) | planners[1].stands(points)
    return pairs_of(points, known, count, random)


def compare(ours: Planner, theirs: Planner, pairs: Floats) -> Comparison:
    """Let both import the mesh and answer, warm, and find out why they disagree."""
    for planner in (ours, theirs):
        planner.make()
        planner.ways(pairs[-_WARM_UP:])
    mine, others = ours.ways(pairs), theirs.ways(pairs)
    refusals = [
        *explained(Verdict.ONLY_THEIRS, ours, pairs, mine, others),
        *explained(Verdict.ONLY_OURS, theirs, pairs, others, mine),
    ]
    return Comparison(pairs, mine, others, sorted(refusals, key=lambda refusal: refusal.number))


def explained(
    who: Verdict, refusing: Planner, pairs: Floats, refused: list[Answer], found: list[Answer]
) -> list[Disagreement]:
    """Every pair that one planner refuses though the other has found a way: `who` names that one.

    Who refuses is asked again with one rule eased at a time, and the first that brings a way is
    the reason.
    """
    answers = enumerate(zip(refused, found, strict=True))
    numbers = [n for n, (no, yes) in answers if yes.found and not no.found]
    moved = [found[n].points[[0, -1]] for n in numbers]
    again = refusing.ways(np.array(moved)) if moved else []
    why = {n: MOVED for n, answer in zip(numbers, again, strict=True) if answer.found}
    why |= {n: NO_GROUND for n in numbers if n not in why and not all(refused[n].stands)}
    if len(why) < len(numbers):
        for rule, eased in refusing.eased():
            left = [n for n in numbers if n not in why]
            again = eased.ways(pairs[left]) if left else []
            why |= {n: rule for n, answer in zip(left, again, strict=True) if answer.found}
            if len(why) == len(numbers):
                break
    return [
        Disagreement(
            number=n,
            who=who,
            why=why.get(n, UNEXPLAINED),
            start=tuple(pairs[n, 0].tolist()),
            goal=tuple(pairs[n, 1].tolist()),
            gap=tuple(_gap(refusing, refused[n], found[n]).tolist()),
        )
        for n in numbers
    ]


def _gap(refusing: Planner, refused: Answer, found: Answer) -> Floats:
    """Where on the way that was found who refuses gets no further, (3,)."""
    way = found.points
    if not all(refused.stands):
        end: Floats = way[-1] if refused.stands[0] else way[0]
        return end

    def reaches(point: Floats) -> bool:
        return refusing.ways(np.stack([way[0], point])[None])[0].found

    return last_reached(way, reaches)
