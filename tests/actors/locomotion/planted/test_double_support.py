import numpy as np
import pytest

from esplanade.actors.locomotion.body.skeleton import TRACK_HALF_WIDTH
from esplanade.actors.locomotion.gait.step_length import pose_table
from esplanade.actors.locomotion.planted import _double_support_kernels as double_support
from esplanade.actors.locomotion.planted.footprints import Footprint
from esplanade.actors.locomotion.planted.step import step_targets
from tests.actors.locomotion import walks

BENDS = [(0.3, 3.0), (0.3, 1.5), (0.3, 1.0), (0.3, 0.6), (0.5, 3.0), (0.5, 1.5), (0.5, 1.0)]
OTHERS = {
    "backward 0.2": (walks.backward(0.2, 6), 3.5),
    "backward 0.4": (walks.backward(0.4, 6), 5.0),
    "sideways 0.3": (walks.sideways(0.3, 6), 4.5),
    "sideways 0.5": (walks.sideways(0.5, 6), 6.0),
    "on the spot 30": (walks.on_the_spot(30.0, 6), 3.5),
    "on the spot 60": (walks.on_the_spot(60.0, 6), 3.5),
}


def check(walked, fastest):
    assert walked.missed.max() < 1e-12
    assert walks.landing_error(walked) < 1e-9
    assert walks.slide(walked) < 1e-6
    assert walks.depth(walked) < 1e-9
    place, speed = walks.gaps(walked)
    assert place < 1e-9
    assert speed < 0.05
    assert walks.top_speed(walked) < fastest


@pytest.mark.parametrize(("length", "radius"), BENDS)
def test_bends(length, radius):
    check(walks.walk(walks.arc(radius, length, 6)), 3.5 if length < 0.4 else 5.0)


@pytest.mark.parametrize("name", OTHERS)
def test_other_ways(name):
    footprints, fastest = OTHERS[name]
    check(walks.walk(footprints), fastest)


def test_hips_follow_the_bend():
    """Hips stay near the circle that footprints go along, and the pelvis faces along it."""
    targets = step_targets(walks.arc(1.5, 0.5, 6), np.linspace(0.0, 1.0, 21))
    x, y = targets.root[..., 0], targets.root[..., 1] - 1.5
    assert np.hypot(x, y) == pytest.approx(np.full_like(x, 1.5), abs=0.055)
    along = np.arctan2(x, -y)
    assert np.abs(np.angle(np.exp(1j * (targets.yaw - along)))).max() < 0.1


def test_hip_yaw_takes_up_the_turn():
    walked = walks.walk(walks.arc(1.0, 0.5, 6), 200)
    assert 20.0 < np.degrees(np.abs(walked.joints[..., 0]).max()) < 32.0


def test_on_the_spot_the_body_turns_and_stays():
    targets = step_targets(walks.on_the_spot(30.0, 6), np.array([0.0, 1.0]))
    assert np.degrees(targets.yaw[:, 1]) == pytest.approx((15.0, 30.0, 45.0, 60.0, 75.0, 90.0))
    assert np.abs(targets.root[:, :, :2]).max() < 0.05


def test_the_back_of_a_circle_is_no_border():
    """Headings either side of a half turn are next to each other."""
    footprints = walks.on_the_spot(30.0, 16)
    wrapped = [
        np.column_stack([prints[:, :3], (prints[:, 3] + np.pi) % (2.0 * np.pi) - np.pi])
        for prints in (footprints.lifted, footprints.standing, footprints.landing)
    ]
    u = np.linspace(0.0, 1.0, 5)
    here = step_targets(footprints, u)
    there = step_targets(
        footprints._replace(lifted=wrapped[0], standing=wrapped[1], landing=wrapped[2]), u
    )
    assert there.root == pytest.approx(here.root)
    assert np.exp(1j * there.yaw) == pytest.approx(np.exp(1j * here.yaw))


POSES = pose_table()


def test_the_pelvis_comes_down_where_a_leg_is_too_short():
    rear = Footprint(0.0, -TRACK_HALF_WIDTH, 0.0, 0.0)
    narrow = Footprint(0.0, TRACK_HALF_WIDTH, 0.0, 0.0)
    wide = Footprint(0.0, TRACK_HALF_WIDTH + 0.5, 0.0, 0.0)
    assert double_support.double_support_pose(rear, narrow, 1.0, POSES).lowered == 0.0
    pose = double_support.double_support_pose(rear, wide, 1.0, POSES)
    assert np.hypot(0.25, 0.993 - pose.lowered) == pytest.approx(0.9935)
    assert (pose.x, pose.y) == pytest.approx((0.0, 0.25))


def test_a_pose_between_straight_footprints_is_that_of_the_curves():
    rear = Footprint(0.0, -TRACK_HALF_WIDTH, 0.0, 0.0)
    front = Footprint(0.5, TRACK_HALF_WIDTH, 0.0, 0.0)
    pose = double_support.double_support_pose(rear, front, 1.0, POSES)
    assert pose.rv == pytest.approx(0.329832, abs=1e-5)
    assert pose.pace == pytest.approx(pose.rv)
    assert pose.y == pytest.approx(0.0)
    assert (pose.speed_x, pose.speed_y) == pytest.approx((0.56, 0.0))
    assert pose.turning == 0.0


def test_cubics_have_the_ends_and_slopes_they_are_given():
    curve = [double_support.hermite(u, 1.0, 2.0, 5.0, -3.0) for u in (0.0, 1e-6, 1.0 - 1e-6, 1.0)]
    assert (curve[0], curve[3]) == pytest.approx((1.0, 5.0))
    assert (curve[1] - curve[0]) / 1e-6 == pytest.approx(2.0, abs=1e-4)
    assert (curve[3] - curve[2]) / 1e-6 == pytest.approx(-3.0, abs=1e-4)
