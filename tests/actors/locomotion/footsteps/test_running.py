"""Bodies too fast to walk run: feet keep up with them, and stay where they are put."""

import numpy as np
import pytest

from tests.actors.locomotion.footsteps.test_walkers import (
    check_continuous,
    check_planted,
    deviations,
)
from tests.actors.locomotion.parade import TICK_S, Parade


def speed_up(parade: Parade, speed_mps: float) -> None:
    """Go along +x, faster from tick to tick, up to a speed."""
    parade.stand()
    for speed in np.linspace(0.3, speed_mps, 10):
        parade.go((float(speed), 0.0))


def in_flight(parade: Parade) -> list[np.ndarray]:
    """Whether each body has neither foot on the ground, (N,) in every frame."""
    return [np.isnan(frame.slide_m).all(axis=1) for frame in parade.frames()]


@pytest.mark.parametrize("speed", [2.5, 3.0])
def test_hips_keep_up_with_a_body_that_runs(speed: float) -> None:
    parade = Parade(6)
    speed_up(parade, speed)
    parade.go((speed, 0.0), ticks=80)
    assert np.percentile(deviations(parade).reshape(-1, 6)[90:], 99) < 0.1
    assert parade.walkers.lost == 0
    check_continuous(parade)
    check_planted(parade)
    flown = np.mean(in_flight(parade)[180:], axis=0)
    assert (flown > 0.1).all()
    assert (flown < 0.5).all()


def test_nobody_runs_at_a_walk() -> None:
    parade = Parade(8)
    speed_up(parade, 1.6)
    parade.go((1.6, 0.0), ticks=60)
    parade.go((0.0, 1.6), ticks=40)
    assert not any(begun.steps.flight.any() for begun in parade.begun)


def test_runners_take_bends_and_feet_do_not_slide() -> None:
    parade = Parade(5)
    speed_up(parade, 2.5)
    for tick in range(80):
        angle = tick * TICK_S * 2.5 / 5.0
        parade.go((2.5 * np.cos(angle), 2.5 * np.sin(angle)))
    assert np.percentile(deviations(parade).reshape(-1, 5)[90:], 99) < 0.25
    check_continuous(parade)
    check_planted(parade)


def test_a_runner_who_stops_stands_on_both_feet() -> None:
    parade = Parade(4)
    speed_up(parade, 2.8)
    parade.go((2.8, 0.0), ticks=37)
    parade.go((0.0, 0.0), ticks=60)
    check_continuous(parade)
    check_planted(parade)
    *_, last = parade.frames()
    off = np.hypot(*(last.pose.root - last.bodies)[:, :2].T)
    assert off.max() < 0.08
    assert np.abs(last.pose.pitches).max() < 0.05
    assert (last.pose.root[:, 2] > 0.95 * parade.sizes.leg_m).all()


def test_steps_grow_with_the_speed_beyond_those_of_a_walk() -> None:
    lengths = []
    for speed in (1.8, 2.3, 2.7):
        parade = Parade(1)
        speed_up(parade, speed)
        parade.go((speed, 0.0), ticks=60)
        last = parade.begun[-1].steps
        apart = last.landing[0, :2] - last.standing[0, :2]
        lengths.append(float(np.hypot(*apart)) / parade.sizes.leg_m[0])
    assert lengths[0] < 0.8 < lengths[1] < lengths[2]
