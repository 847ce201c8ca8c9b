import math
from itertools import pairwise

import numpy as np
import pytest

from esplanade.actors.locomotion.footsteps.course import AHEAD, Course
from esplanade.actors.locomotion.footsteps.walkers import JUMP_M
from esplanade.planning import Polygon, Scene, Stairs
from esplanade.planning.compiled.arrays import Floats
from tests.actors.locomotion.parade import TICK_S, Parade

MM = 1e-3


def deviations(parade: Parade) -> Floats:
    """Distances of drawn hips from bodies, on the map, at 60 frames a second."""
    return np.array([np.hypot(*(f.pose.root - f.bodies)[:, :2].T) for f in parade.frames()]).ravel()


def check_continuous(parade: Parade) -> None:
    root, ankles, knees = parade.jumps()
    assert root.max() < 0.3 * MM
    assert ankles.max() < 0.3 * MM
    assert knees.max() < 3.0 * MM


def check_planted(parade: Parade) -> None:
    slide = np.concatenate([frame.slide_m.ravel() for frame in parade.frames()])
    assert np.nanmax(slide) < 0.3 * MM


def keyboard(count: int, seed: int) -> Floats:
    """Velocities (N, 2), tick by tick, of people who press and let go of arrow keys at 1.4 m/s."""
    random = np.random.default_rng(seed)
    ticks = 500
    velocities = np.zeros((ticks, count, 2))
    for person in range(count):
        tick, way = 0, 0
        while tick < ticks:
            until = tick + int(random.integers(10, 70))
            if random.random() < 0.8:
                way += int(random.choice([-4, -2, -2, -1, -1, 0, 1, 1, 2, 2]))
                angle = way * np.pi / 4.0
                velocities[tick:until, person] = 1.4 * np.cos(angle), 1.4 * np.sin(angle)
            tick = until
    return velocities


def test_a_body_that_stands_takes_no_step() -> None:
    parade = Parade(3)
    parade.stand()
    parade.go((0.0, 0.0), ticks=100)
    (first,) = parade.begun
    assert (first.steps.ticks == 0).all()
    assert deviations(parade).max() < 1.0 * MM


def test_an_even_walk_has_even_steps_that_cover_what_the_body_covers() -> None:
    parade = Parade(8)
    parade.stand()
    parade.go((1.3, 0.0), ticks=200)
    for slot in range(parade.count):
        mine = [(b.tick, b.steps.take(b.slots == slot)) for b in parade.begun if slot in b.slots][
            4:
        ]
        assert not any(steps.re_aimed.any() for _, steps in mine)
        lengths = [float(s.landing[0, 0] - s.standing[0, 0]) for _, s in mine]
        sides = [bool(s.on_right[0]) for _, s in mine]
        walked = [1.3 * TICK_S * int(s.ticks[0]) for _, s in mine]
        np.testing.assert_allclose(lengths, walked, atol=1.0 * MM)
        assert all(a != b for a, b in pairwise(sides))
    assert len({len(b.slots) for b in parade.begun}) > 1, "not everyone keeps the same step"
    check_continuous(parade)
    check_planted(parade)


def test_the_last_step_ends_at_the_goal() -> None:
    parade = Parade(6)
    parade.stand()
    along = np.minimum(np.arange(120) * 1.2 * TICK_S, 4.37)
    way = np.zeros((6, 120, 3))
    for slot in range(6):
        way[slot, :, 0], way[slot, :, 1] = along * np.cos(slot), along * np.sin(slot)
    parade.follow(np.concatenate([way, np.repeat(way[:, -1:], 40, axis=1)], axis=1))
    (*_, last) = parade.frames()
    off = np.linalg.norm((last.pose.root - last.bodies)[:, :2], axis=1)
    assert off.max() < 1.0 * MM
    np.testing.assert_allclose(last.pose.pitches, 0.0, atol=0.03)
    feet = last.pose.ankles.mean(axis=1)[:, :2] - last.bodies[:, :2]
    assert np.hypot(*feet.T).max() < 0.09
    check_continuous(parade)
    check_planted(parade)


def test_a_body_that_stops_draws_its_feet_together() -> None:
    parade = Parade(20)
    parade.stand()
    for slot in range(20):  # so that everyone is caught at another moment
        stopped = np.where(np.arange(20)[:, None] < slot, (0.0, 0.0), (1.4, 0.0))
        parade.go(stopped, ticks=1 if slot else 40)
    parade.go((0.0, 0.0), ticks=60)
    (*_, last) = parade.frames()
    apart = last.pose.ankles[:, 0] - last.pose.ankles[:, 1]
    width = 0.2 * parade.sizes.leg_m
    assert np.abs(np.linalg.norm(apart, axis=1) - width).max() < 0.17
    assert np.hypot(*(last.pose.root - last.bodies)[:, :2].T).max() < 1.0 * MM
    check_continuous(parade)
    check_planted(parade)


@pytest.mark.parametrize("turned", [0.6, -1.5, 3.1])
def test_turning_in_place_turns_the_feet_and_goes_nowhere(turned: float) -> None:
    parade = Parade(4)
    parade.stand()
    parade.go((0.0, 0.0), ticks=10)
    parade.headings = np.full(4, turned)
    parade.go((0.0, 0.0), ticks=90)
    (*_, last) = parade.frames()
    off = (last.pose.headings - turned + np.pi) % (2.0 * np.pi) - np.pi
    assert np.abs(off).max() < 0.36
    assert deviations(parade).max() < 0.05
    check_continuous(parade)
    check_planted(parade)


@pytest.mark.parametrize("velocity", [(0.0, 0.28), (0.0, -0.28), (-0.28, 0.0)])
def test_slow_steps_go_sideways_and_back_without_turning(velocity: tuple[float, float]) -> None:
    parade = Parade(4)
    parade.stand()
    parade.go(velocity, ticks=160, turn=False)
    for frame in parade.frames():
        assert np.abs((frame.pose.headings + np.pi) % (2.0 * np.pi) - np.pi).max() < 0.2
    assert np.percentile(deviations(parade), 99) < 0.1
    for begun in parade.begun:
        # Nobody steps across the other foot.
        across = begun.steps.landing[:, 1] - begun.steps.standing[:, 1]
        assert (np.where(begun.steps.on_right, across, -across) > 0.05).all()
    check_continuous(parade)
    check_planted(parade)


def test_sudden_turns_and_stops_are_drawn_without_a_jump() -> None:
    parade = Parade(16)
    parade.stand()
    before = (0.0, 0.0)
    for velocity in ((1.4, 0.0), (-1.4, 0.0), (0.0, 1.4), (0.0, 0.0), (1.0, 1.0), (1.0, -1.0)):
        for slot in range(16):
            early = np.arange(16)[:, None] <= slot
            parade.go(np.where(early, velocity, before))
        parade.go(velocity, ticks=20)
        before = velocity
    assert any(begun.steps.re_aimed.any() for begun in parade.begun)
    check_continuous(parade)
    check_planted(parade)
    frames = list(parade.frames())
    hips = np.array([frame.pose.root for frame in frames])
    assert np.linalg.norm(np.diff(hips, axis=0), axis=2).max() < 0.1
    assert parade.walkers.lost == 0


def test_a_body_that_turns_in_every_tick_still_walks() -> None:
    """Each re-aiming leaves less of a step, and the rest must not come to nothing."""
    parade = Parade(16)
    parade.stand()
    random = np.random.default_rng(5)
    for _ in range(200):
        angle = random.uniform(0.0, 2.0 * np.pi, 16)
        parade.go(3.0 * np.stack([np.cos(angle), np.sin(angle)], axis=1))
    assert any(begun.steps.re_aimed.any() for begun in parade.begun)
    assert all(np.isfinite(begun.steps.keys).all() for begun in parade.begun)
    check_planted(parade)


def test_drawn_bodies_stay_near_people_at_a_keyboard() -> None:
    parade = Parade(16)
    parade.stand()
    for velocities in keyboard(16, seed=3):
        parade.go(velocities)
    off = deviations(parade)
    assert np.percentile(off, 95) < 0.15
    assert np.percentile(off, 99) < 0.27
    assert parade.walkers.lost == 0
    check_continuous(parade)
    check_planted(parade)


@pytest.mark.parametrize("degrees", [0.0, 30.0, 45.0, 77.0])
def test_feet_are_put_on_treads(degrees: float) -> None:
    angle = math.radians(degrees)
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    start, end = ((float(x), float(y)) for x, y in ((2.0, 0.0), (5.0, 0.0)) @ turn.T)
    stairs = Stairs(start=start, end=end, width_m=3.0, top_m=1.75, steps=10)
    scene = Scene(name="stairs", bounds=(-12.0, -12.0, 12.0, 12.0), stairs=(stairs,))
    parade = Parade(6, scene)
    across = np.linspace(-1.0, 1.0, 6)
    x = np.arange(110) * 0.9 * TICK_S
    way = np.zeros((6, 110, 3))
    way[..., 0], way[..., 1] = x, across[:, None]
    way[..., :2] = way[..., :2] @ turn.T
    way[..., 2] = 0.175 * np.clip(np.ceil((x - 2.0) / 0.3), 0.0, 10.0)
    parade.positions = way[:, 0].copy()
    parade.headings[:] = angle
    parade.stand()
    parade.follow(way)
    foot_m = parade.sizes.foot_m
    on_stairs = 0
    for begun in parade.begun:
        landing = begun.steps.landing
        assert np.abs(landing[:, 2] - begun.steps.standing[:, 2]).max() < 0.176, "tread by tread"
        heel = (landing[:, :2] @ turn)[:, 0]
        toe = heel + 0.85 * foot_m[begun.slots] * np.cos(landing[:, 3] - angle)
        inside = (heel > 2.0) & (toe < 4.99)
        for along in (heel, toe):
            tread = np.floor((along[inside] - 2.0) / 0.3) + 1.0
            np.testing.assert_allclose(landing[inside, 2], 0.175 * tread, atol=MM)
        on_stairs += int(inside.sum())
    assert on_stairs > 40
    check_continuous(parade)
    check_planted(parade)
    hips = np.array([frame.pose.root for frame in parade.frames()])
    assert np.linalg.norm(np.diff(hips, axis=0), axis=2).max() < 0.07
    for frame in parade.frames():
        air = np.isnan(frame.slide_m)
        flat = parade.ground.height(frame.pose.ankles[air][:, :2], frame.pose.ankles[air][:, 2])
        under = frame.pose.ankles[air][:, 2] - flat
        assert np.nanmin(under, initial=0.0) > -0.05


@pytest.mark.parametrize("down", [True, False])
def test_feet_catch_up_with_a_body_that_goes_over_the_side_of_a_flight(down: bool) -> None:
    block = Polygon(points=((0.0, -2.0), (3.0, -2.0), (3.0, 2.0), (0.0, 2.0)), height_m=0.9)
    scene = Scene(name="block", bounds=(-12.0, -12.0, 12.0, 12.0), polygons=(block,))
    parade = Parade(4, scene)
    x = np.linspace(2.0, 7.0, 80) if down else np.linspace(-4.0, 2.8, 110)
    way = np.zeros((4, len(x), 3))
    way[..., 0], way[..., 1] = x, np.linspace(-1.0, 1.0, 4)[:, None]
    way[..., 2] = np.where((x > 0.0) & (x < 3.0), 0.9, 0.0)
    parade.positions = way[:, 0].copy()
    parade.stand()
    parade.follow(way)
    assert parade.walkers.lost == 0
    last = parade.walkers.steps.landing
    np.testing.assert_allclose(last[:, 2], way[:, -1, 2], atol=MM)
    assert np.abs(last[:, 0] - way[:, -1, 0]).max() < 0.9


def test_a_body_that_jumps_stands_anew_there() -> None:
    parade = Parade(2)
    parade.stand()
    parade.go((1.3, 0.0), ticks=30)
    parade.positions[1] += (JUMP_M + 2.0, 0.0, 0.0)
    parade.go((0.0, 0.0))
    assert parade.walkers.lost == 1
    assert parade.begun[-1].steps.ticks.min() == 0 or parade.begun[-2].steps.ticks.min() == 0
    parade.go((0.0, 0.0), ticks=60)
    (*_, last) = parade.frames()
    np.testing.assert_allclose(last.pose.root[:, :2], last.bodies[:, :2], atol=1.0 * MM)


def test_same_bodies_take_the_same_steps() -> None:
    walks = []
    for _ in range(2):
        parade = Parade(5, seed=4)
        parade.stand()
        for velocities in keyboard(5, seed=1)[:150]:
            parade.go(velocities)
        walks.append(parade.begun)
    assert len(walks[0]) == len(walks[1])
    for one, other in zip(*walks, strict=True):
        np.testing.assert_array_equal(one.slots, other.slots)
        for a, b in zip(one.steps, other.steps, strict=True):
            np.testing.assert_array_equal(a, b)


def test_a_course_that_is_no_number_is_an_error_and_no_step() -> None:
    parade = Parade(1)
    parade.stand()
    with pytest.raises(ValueError, match="finite"):
        parade.update(Course(np.zeros(1), np.full((1, AHEAD, 3), np.nan)))
