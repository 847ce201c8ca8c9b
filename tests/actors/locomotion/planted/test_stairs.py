import numpy as np
import pytest

from esplanade.actors.locomotion.body.skeleton import FOOT
from esplanade.actors.locomotion.planted import _stairs_kernels as stairs
from esplanade.actors.locomotion.planted.step import step_targets
from tests.actors.locomotion import walks

TREAD = 0.333
RISE = 0.189


def treads(rise):
    """Ground of stairs whose footprints are in the middle of their treads."""
    nosing = (TREAD - FOOT) / 2.0
    return lambda place: np.floor((place[..., 0] + nosing) / TREAD) * rise


@pytest.fixture(scope="module", params=[RISE, -RISE], ids=["up", "down"])
def flight(request):
    return walks.walk(walks.staircase(request.param, TREAD, 8)), request.param


def test_feet_land_and_stay(flight):
    walked, _ = flight
    assert walks.landing_error(walked) < 1e-9
    assert walks.slide(walked) < 1e-6
    assert walked.missed.max() < 1e-12


def test_feet_clear_every_nosing(flight):
    walked, rise = flight
    assert walks.depth(walked, treads(rise)) < 1e-9


def test_steps_join(flight):
    walked, _ = flight
    place, speed = walks.gaps(walked)
    assert place < 1e-9
    assert speed < 0.05


def test_joints_are_not_hurried(flight):
    walked, _ = flight
    assert walks.top_speed(walked) < 12.6


def test_knees_bend_as_on_stairs(flight):
    walked, rise = flight
    most = np.degrees(walked.joints[..., 3].max())
    assert (75.0 < most < 95.0) if rise > 0.0 else (95.0 < most < 114.0)


FLIGHTS = [
    ([0, 0, 0, 1, 2, 3, 3, 3], TREAD, RISE),
    ([3, 3, 3, 2, 1, 0, 0, 0], TREAD, RISE),
    ([0, 0, 1, 1, 1, 2, 2, 2], TREAD, RISE),
    ([2, 2, 1, 1, 1, 0, 0, 0], TREAD, RISE),
    ([0, 1, 2, 3, 4, 5, 6], 0.25, 0.16),
    ([6, 5, 4, 3, 2, 1, 0], 0.25, 0.16),
    ([0, 1, 2, 3, 4, 5, 6], 0.3, 0.2),
    ([6, 5, 4, 3, 2, 1, 0], 0.3, 0.2),
    ([0, 1, 2, 3, 4, 5], 0.4, 0.14),
    ([5, 4, 3, 2, 1, 0], 0.4, 0.14),
]


@pytest.mark.parametrize(("levels", "tread", "rise"), FLIGHTS)
def test_onto_stairs_and_off_again(levels, tread, rise):
    """Flat, steep and landings in between: feet land, and none gets into a tread."""
    footprints = walks.step_footprints(
        [(k * tread, walks.aside(k), rise * level, 0.0) for k, level in enumerate(levels)]
    )
    walked = walks.walk(footprints, 500)
    nosing = (tread - FOOT) / 2.0
    heights = rise * np.array([*levels, levels[-1]])

    def ground(place):
        on = np.floor((place[..., 0] + nosing) / tread).astype(int)
        return heights[np.minimum(on, len(levels))]

    assert walked.missed.max() < 1e-9
    assert walks.landing_error(walked) < 1e-9
    assert walks.slide(walked) < 1e-6
    assert walks.depth(walked, ground) < 1e-9
    assert walks.gaps(walked)[0] < 1e-9
    assert walks.top_speed(walked) < 13.5


@pytest.mark.parametrize("rise", [-0.25, -0.1, 0.1, 0.25])
def test_one_foot_after_the_other_on_the_same_tread(rise):
    heights = [0, 0, 1, 1, 2, 2]
    footprints = walks.step_footprints(
        [(TREAD * level, walks.aside(k), rise * level, 0.0) for k, level in enumerate(heights)]
    )
    walked = walks.walk(footprints, 500)
    assert walked.missed.max() < 1e-9
    assert walks.landing_error(walked) < 1e-9
    assert walks.gaps(walked)[0] < 1e-9


def test_a_ramp_is_walked_as_level_ground():
    slope = 0.04
    footprints = walks.step_footprints(
        [(0.4 * k, walks.aside(k), slope * 0.4 * k, 0.0) for k in range(8)]
    )
    level = step_targets(
        walks.step_footprints([(0.4 * k, walks.aside(k), 0.0, 0.0) for k in range(8)]),
        np.linspace(0.0, 1.0, 21),
    )
    ramp = step_targets(footprints, np.linspace(0.0, 1.0, 21))
    assert np.abs(ramp.swing_pitch - level.swing_pitch).max() < 0.2
    assert ramp.root[-1, -1, 2] - ramp.root[0, 0, 2] == pytest.approx(slope * 0.4 * 6, abs=0.005)


@pytest.mark.parametrize(("front", "height"), [(0.2, 0.1), (0.0, 0.0), (-0.2, -0.17)])
def test_what_stands_for_level_ground(front, height):
    assert stairs.ground_height(0.0, front) == pytest.approx(height)


@pytest.mark.parametrize("after", [0.2, -0.2])
def test_the_body_changes_height_late(after):
    assert stairs.ground_during_step(0.0, after, 0.3) == 0.0
    assert stairs.ground_during_step(0.0, after, 0.65) == pytest.approx(after / 2)
    assert stairs.ground_during_step(0.0, after, 1.0) == pytest.approx(after)


@pytest.mark.parametrize(("rise", "share"), [(0.0, 0.0), (0.04, 0.5), (-0.04, 0.5), (0.2, 1.0)])
def test_how_far_a_rise_counts_as_stairs(rise, share):
    assert stairs.unevenness(rise) == pytest.approx(share)


def test_the_rear_heel_is_never_above_its_toe():
    assert stairs.heel_height(0.02, 0.1, 0.0) == pytest.approx(0.12)
    assert stairs.heel_height(0.02, 0.5, 0.0) < FOOT
