import numpy as np
import pytest

from esplanade.actors.locomotion.body.skeleton import FOOT, TRACK_HALF_WIDTH
from esplanade.actors.locomotion.planted.footprints import StepFootprints
from esplanade.actors.locomotion.planted.step import step_targets
from tests.actors.locomotion import walks
from tests.naive import planted as naive

WALKS = {
    "0.2": ([0.2] * 6, 2.1),
    "0.4": ([0.4] * 6, 3.2),
    "0.6": ([0.6] * 6, 6.6),
    "0.74": ([0.74] * 6, 11.5),
    "mixed": ([0.0, 0.3, 0.5, 0.2, 0.6, 0.4, 0.2, 0.0], 6.4),
    "one leg only": ([0.5, 0.0] * 4, 4.5),
    "none": ([0.0] * 4, 1e-9),
}


@pytest.fixture(scope="module", params=WALKS)
def straight(request):
    lengths, fastest = WALKS[request.param]
    return walks.walk(walks.straight(lengths)), fastest


def test_feet_land_on_their_footprints(straight):
    walked, _ = straight
    assert walks.landing_error(walked) < 1e-9


def test_feet_on_the_ground_do_not_slide(straight):
    walked, _ = straight
    assert walks.slide(walked) < 1e-6


def test_legs_reach_their_targets(straight):
    walked, _ = straight
    assert walked.missed.max() == 0.0
    assert np.abs(walked.heels[:, :, 1] - walked.targets.swing_ankle).max() < 1e-9


def test_a_step_begins_as_the_one_before_ends(straight):
    walked, _ = straight
    place, speed = walks.gaps(walked)
    assert place < 1e-9
    assert speed < 1e-3


def test_feet_stay_above_the_ground(straight):
    walked, _ = straight
    assert walks.depth(walked) < 1e-9


def test_hips_never_go_back(straight):
    walked, _ = straight
    assert np.diff(walked.targets.root[..., 0], axis=1).min() > -1e-15


def test_joints_are_not_hurried(straight):
    walked, fastest = straight
    assert walks.top_speed(walked) < fastest


def test_standing_knees_do_not_lock(straight):
    walked, _ = straight
    assert np.degrees(walked.joints[:, :, 0, 3].min()) > 12.0


def test_a_swinging_foot_clears_the_ground():
    walked = walks.walk(walks.straight([0.5] * 4), 200)
    middle = slice(130, 170)
    assert min(walked.heels[2, middle, 1, 2].min(), walked.toes[2, middle, 1, 2].min()) > 0.003


def test_the_heel_comes_down_first_and_the_toe_leaves_last():
    targets = step_targets(walks.straight([0.6] * 4), np.array([0.0, 0.4, 1.0]))
    assert np.degrees(targets.swing_pitch[2, -1]) > 5.0
    assert targets.standing_pitch[2, 0] == pytest.approx(targets.swing_pitch[1, -1])
    assert targets.standing_pitch[2, 1] == pytest.approx(0.0)
    assert np.degrees(targets.standing_pitch[2, 2]) < -5.0
    assert targets.swing_pitch[3, 0] == pytest.approx(targets.standing_pitch[2, -1])


def test_standing_is_both_feet_flat_under_a_still_body():
    targets = step_targets(walks.straight([0.0]), np.linspace(0.0, 1.0, 5))
    for values in targets[:-2]:
        assert np.ptp(values, axis=1) == pytest.approx(np.zeros_like(values[:, 0]), abs=1e-12)
    assert targets.root[0, 0] == pytest.approx((0.0, 0.0, 0.993))
    assert targets.swing_pitch[0, 0] == targets.standing_pitch[0, 0] == 0.0


def test_legs_of_any_length_walk_alike():
    tall, small = (
        step_targets(
            StepFootprints(
                np.array([False]),
                np.array([[-0.4 * leg, -2 * TRACK_HALF_WIDTH * leg, 0.0, 0.0]]),
                np.zeros((1, 4)),
                np.array([[0.5 * leg, -2 * TRACK_HALF_WIDTH * leg, 0.0, 0.0]]),
                np.array([leg]),
            ),
            np.linspace(0.0, 1.0, 9),
        )
        for leg in (1.0, 0.8)
    )
    assert small.root == pytest.approx(0.8 * tall.root)
    assert small.swing_ankle == pytest.approx(0.8 * tall.swing_ankle)
    assert small.swing_pitch == pytest.approx(tall.swing_pitch)


def test_a_step_does_not_depend_on_where_it_is_and_which_way_it_goes():
    footprints = walks.arc(1.2, 0.5, 3)
    turned, (x, y, z) = 2.4, (31.0, -12.0, 5.0)
    cos, sin = np.cos(turned), np.sin(turned)

    def moved(prints):
        out = prints.copy()
        out[:, 0] = x + cos * prints[:, 0] - sin * prints[:, 1]
        out[:, 1] = y + sin * prints[:, 0] + cos * prints[:, 1]
        out[:, 2:] += z, turned
        return out

    u = np.linspace(0.0, 1.0, 7)
    here = step_targets(footprints, u)
    there = step_targets(
        footprints._replace(
            lifted=moved(footprints.lifted),
            standing=moved(footprints.standing),
            landing=moved(footprints.landing),
        ),
        u,
    )
    for place in ("root", "swing_ankle"):
        expected = moved(getattr(here, place).reshape(-1, 3) @ np.eye(3, 4))[:, :3]
        assert getattr(there, place).reshape(-1, 3) == pytest.approx(expected)
    assert there.yaw == pytest.approx(here.yaw + turned)
    assert there.swing_heading == pytest.approx(here.swing_heading + turned)
    assert there.standing_pitch == pytest.approx(here.standing_pitch)


def test_left_and_right_are_mirror_images():
    footprints = walks.arc(1.2, 0.5, 3)
    flip = np.array([1.0, -1.0, 1.0, -1.0])
    mirrored = StepFootprints(
        ~footprints.on_right,
        footprints.lifted * flip,
        footprints.standing * flip,
        footprints.landing * flip,
        footprints.leg_m,
    )
    u = np.linspace(0.0, 1.0, 7)
    here, there = step_targets(footprints, u), step_targets(mirrored, u)
    assert there.root == pytest.approx(here.root * flip[:3])
    assert there.yaw == pytest.approx(-here.yaw)
    assert there.roll == pytest.approx(-here.roll)
    assert there.lean == pytest.approx(here.lean)
    assert there.torsion == pytest.approx(-here.torsion)
    assert there.shoulders == pytest.approx(here.shoulders[..., ::-1])
    assert there.elbows == pytest.approx(here.elbows[..., ::-1])


def test_the_arm_swings_against_the_leg_on_its_side():
    targets = step_targets(walks.straight([0.6] * 4), np.array([1.0]))
    for step, right in enumerate(targets.shoulders[1:, 0, 1] > targets.shoulders[1:, 0, 0], 1):
        assert right == walks.straight([0.6] * 4).on_right[step]


def test_shares_may_differ_from_step_to_step():
    footprints = walks.straight([0.3, 0.5, 0.4])
    all_of_them = step_targets(footprints, np.array([0.1, 0.5, 0.9]))
    one_each = step_targets(footprints, np.array([[0.1], [0.5], [0.9]]))
    for step in range(3):
        assert one_each.root[step, 0] == pytest.approx(all_of_them.root[step, step])


def scattered(count):
    """Steps with footprints anywhere that feet may get to, two in five of them uneven."""
    rng = np.random.default_rng(8)
    right = rng.random(count) < 0.5
    side = np.where(right, 1.0, -1.0)

    def footprints():
        place = rng.uniform((-0.4, -0.15, -0.2, -0.9), (0.65, 0.3, 0.2, 0.9), (count, 4))
        place[:, 1] = side * (place[:, 1] + 2.0 * TRACK_HALF_WIDTH)
        place[:, 2] *= rng.random(count) < 0.4
        return place

    return StepFootprints(right, footprints(), np.zeros((count, 4)), footprints(), np.ones(count))


@pytest.mark.parametrize(
    "footprints",
    [
        scattered(500),
        walks.straight([0.0, 0.3, 0.74, 0.2, 0.0]),
        walks.arc(0.8, 0.5, 4),
        walks.staircase(0.189, 0.333, 4),
        walks.staircase(-0.189, 0.333, 4),
    ],
    ids=["scattered", "straight", "bend", "up", "down"],
)
def test_kernels_say_what_whole_arrays_say(footprints):
    footprints = footprints._replace(leg_m=np.linspace(0.8, 1.1, len(footprints.on_right)))
    u = np.linspace(0.0, 1.0, 31)
    for found, expected in zip(
        step_targets(footprints, u), naive.step_targets(footprints, u), strict=True
    ):
        assert found == pytest.approx(expected, abs=1e-11)


def test_anything_that_footprints_may_be_gives_a_step():
    """All is finite, legs reach, and steps join."""
    footprints = scattered(1000)
    right = footprints.on_right
    walked = walks.walk(footprints, 40)
    assert all(np.all(np.isfinite(values)) for values in walked.targets)
    assert walked.missed.max() < 1e-9
    assert walks.landing_error(walked) < 1e-9
    assert walks.slide(walked) < 1e-9
    after = step_targets(
        StepFootprints(
            ~right, footprints.standing, footprints.landing, footprints.standing, footprints.leg_m
        ),
        np.array([0.0]),
    )
    ends = walked.targets
    for name in ("root", "yaw", "lean", "roll", "torsion", "shoulders", "elbows"):
        assert getattr(ends, name)[:, -1] == pytest.approx(getattr(after, name)[:, 0], abs=1e-9)
    assert ends.swing_pitch[:, -1] == pytest.approx(after.standing_pitch[:, 0], abs=1e-9)
    assert ends.standing_pitch[:, -1] == pytest.approx(after.swing_pitch[:, 0], abs=1e-9)


def test_lengths_beyond_the_longest_step_are_made_by_hips_between_the_feet():
    targets = step_targets(walks.straight([0.86, 0.86]), np.array([0.0, 1.0]))
    behind = 0.86 - targets.root[0, 1, 0]
    assert 0.35 < behind < 0.5
    assert np.all(np.isfinite(targets.root))
    assert behind > FOOT


def test_what_is_no_number_is_told():
    footprints = walks.straight([0.3])
    with pytest.raises(ValueError, match="not a finite number"):
        step_targets(footprints._replace(landing=np.full((1, 4), np.nan)), np.zeros(1))
    with pytest.raises(ValueError, match="longer than 0"):
        step_targets(footprints._replace(leg_m=np.zeros(1)), np.zeros(1))
