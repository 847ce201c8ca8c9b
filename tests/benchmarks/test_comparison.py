"""The comparison of two planners on the same pairs, and the reasons of disagreements."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import pytest
from benchmarks._comparison import MOVED, NO_GROUND, UNEXPLAINED, compare, random_pairs
from benchmarks._pairs import Answer, Finders

FLOOR = np.array(
    [[[0, 0, 0], [30, 0, 0], [30, 4, 0]], [[0, 0, 0], [30, 4, 0], [0, 4, 0]]], dtype=float
)


@dataclass(frozen=True)
class Corridor:
    """A planner that goes straight along x, up to a barrier or the end of the ground."""

    barrier_m: float = np.inf
    end_m: float = 30.0
    rule: str = "gate"
    eased_to_m: float = np.inf
    shift_m: float = 0.0

    @property
    def build_figures(self) -> dict[str, float]:
        return {}

    def build(self) -> None:
        pass

    def stands(self, points: np.ndarray) -> np.ndarray:
        return points[:, 0] <= self.end_m

    def find_paths(self, pairs: np.ndarray) -> list[Answer]:
        answers = []
        for pair in pairs:
            first, last = self.stands(pair).tolist()
            crossed = (pair[:, 0] > self.barrier_m).sum() == 1
            refuses = crossed or not (first and last)
            points = np.empty((0, 3)) if refuses else pair + np.array([self.shift_m, 0.0, 0.0])
            answers.append(Answer((first, last), points, 2.0))
        return answers

    def relaxed(self) -> Iterator[tuple[str, "Corridor"]]:
        yield "colour", self
        yield self.rule, replace(self, barrier_m=self.eased_to_m)


def pairs(*along: tuple[float, float]) -> np.ndarray:
    return np.array([[[a, 2, 0], [b, 2, 0]] for a, b in along], dtype=float)


def test_disagreements_have_a_reason_and_a_place() -> None:
    asked = pairs((1, 5), (1, 19), (25, 1), (1, 29))
    found = compare(Corridor(barrier_m=10.0), Corridor(end_m=28.0), asked)
    assert found.count(Finders.BOTH) == 1
    assert found.count(Finders.NEITHER) == 1
    assert found.count(Finders.ONLY_OURS) == 0
    assert [refusal.number for refusal in found.disagreements] == [1, 2]
    for refusal in found.disagreements:
        assert (refusal.finders, refusal.why) == (Finders.ONLY_THEIRS, "gate")
        assert refusal.gap == pytest.approx((10.0, 2.0, 0.0), abs=0.15)


def test_disagreements_that_no_rule_explains_are_reported() -> None:
    found = compare(Corridor(), Corridor(barrier_m=10.0, eased_to_m=12.0), pairs((1, 19), (1, 11)))
    assert [(d.finders, d.why) for d in found.disagreements] == [
        (Finders.ONLY_OURS, UNEXPLAINED),
        (Finders.ONLY_OURS, "gate"),
    ]


def test_missing_ground_needs_no_further_reason() -> None:
    (refusal,) = compare(Corridor(end_m=28.0), Corridor(), pairs((1, 29.5))).disagreements
    assert refusal.why == NO_GROUND
    assert refusal.gap == (29.5, 2.0, 0.0)


def test_a_path_between_the_positions_of_the_other_planner_is_reported() -> None:
    asked = pairs((9.5, 19))
    theirs = replace(Corridor(), shift_m=1.0)
    (refusal,) = compare(Corridor(barrier_m=10.0), theirs, asked).disagreements
    assert refusal.why == MOVED


def test_figures_tell_of_all_pairs() -> None:
    found = compare(Corridor(barrier_m=10.0), Corridor(), pairs((1, 5), (1, 19), (3, 9)))
    figures = found.figures()
    assert figures["pairs"] == 3
    assert (figures["both"], figures["only theirs"]) == (2, 1)
    assert figures["length ratio"]["p50"] == pytest.approx(1.0)
    assert figures["us"]["p95"] == 2.0


def test_pairs_lie_where_at_least_one_can_stand() -> None:
    planners = Corridor(end_m=6.0), Corridor(end_m=15.0)
    drawn = random_pairs(FLOOR, planners, 100, seed=0)
    assert drawn.shape == (100, 2, 3)
    assert 6.0 < drawn[..., 0].max() <= 15.0
    assert np.array_equal(drawn, random_pairs(FLOOR, planners, 100, seed=0))
    assert not np.array_equal(drawn, random_pairs(FLOOR, planners, 100, seed=1))
