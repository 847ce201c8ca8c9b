from typing import NamedTuple

import numpy as np
import pytest

from esplanade.actors.locomotion.body.skeleton import TRACK_HALF_WIDTH
from esplanade.actors.locomotion.footsteps._foothold_kernels import (
    Foothold,
    HeelTable,
    choose_foothold,
)
from esplanade.actors.locomotion.footsteps._ground_kernels import GroundArrays, new_covering
from esplanade.actors.locomotion.footsteps.course import Course
from esplanade.actors.locomotion.footsteps.walkers import heel_table
from esplanade.planning import Polygon, Scene
from esplanade.planning.compiled.arrays import Floats
from esplanade.planning.compiled.jit import kernel
from tests.actors.locomotion.courses import LEG, course, standing_on
from tests.actors.locomotion.parade import FIELD, Parade


class Chosen(NamedTuple):
    """A foothold: what it is to reach, and its footprint (4,)."""

    goals: Foothold
    landing: Floats


@kernel
def choose(
    ahead: Floats,
    facing: float,
    on_right: bool,
    standing: Floats,
    leg_m: float,
    whole_s: float,
    heels: HeelTable,
    ground: GroundArrays,
    landing: Floats,
) -> Foothold:
    return choose_foothold(
        ahead,
        facing,
        on_right,
        standing,
        leg_m,
        whole_s,
        whole_s,
        heels,
        ground,
        new_covering(ground),
        landing,
    )


def chosen(
    way: Course, footprint: Floats, right: bool = True, scene: Scene = FIELD, whole_s: float = 0.5
) -> Chosen:
    ground, landing = Parade(1, scene).ground, np.empty(4)
    facing, leg_m = float(way.headings[0]), float(LEG[0])
    goals = choose(
        way.ahead[0],
        facing,
        right,
        footprint[0],
        leg_m,
        whole_s,
        heel_table(),
        ground.arrays,
        landing,
    )
    return Chosen(goals, landing)


def test_feet_land_half_a_step_ahead_on_their_own_side() -> None:
    footprint = standing_on(0.3, -0.09)
    found = chosen(course((1.2, 0.0)), footprint)
    np.testing.assert_allclose(found.goals[:2], [0.6, 0.0])
    ahead = found.landing[0] - 0.6
    assert 0.2 < ahead < 0.42
    assert found.landing[1] == pytest.approx(TRACK_HALF_WIDTH * 0.9, abs=1e-4)
    left = chosen(course((1.2, 0.0)), standing_on(0.3, 0.09), right=False)
    np.testing.assert_allclose(left.landing * [1.0, -1.0, 1.0, 1.0], found.landing)


def test_places_of_a_turned_world_are_turned() -> None:
    angle = 2.1
    c, s = np.cos(angle), np.sin(angle)
    one = chosen(course((1.0, 0.3)), standing_on(0.2, -0.09))
    other = chosen(
        course((c - 0.3 * s, s + 0.3 * c)),
        standing_on(0.2 * c + 0.09 * s, 0.2 * s - 0.09 * c, angle),
    )
    turned = one.landing[:2] @ np.array([[c, s], [-s, c]])
    np.testing.assert_allclose(other.landing[:2], turned, atol=2e-4)
    assert other.goals.heading == pytest.approx(one.goals.heading + angle)


@pytest.mark.parametrize("turn", np.linspace(-3.1, 3.1, 9))
@pytest.mark.parametrize("right", [True, False])
def test_feet_turn_further_outwards_and_never_cross(turn: float, right: bool) -> None:
    side = 1.0 if right else -1.0
    footprint = standing_on(0.0, -0.09 * side)
    found = chosen(course((0.0, 0.0), turn), footprint, right)
    turned = found.landing[3]
    assert -1.0 - 1e-9 <= side * turned <= 1.6 + 1e-9
    assert turned * turn >= 0.0
    middle = 0.5 * turned
    across = np.array([-np.sin(middle), np.cos(middle)]) @ (found.landing - footprint[0])[:2]
    assert side * across > TRACK_HALF_WIDTH * 0.9


def test_nobody_puts_a_foot_over_an_edge_or_into_a_wall() -> None:
    podium = Polygon(
        points=((-1.0, -5.0), (0.7, -5.0), (0.7, 5.0), (-1.0, 5.0)), height_m=1.5, kind="floor"
    )
    scene = Scene(name="podium", bounds=(-10.0, -10.0, 10.0, 10.0), polygons=(podium,))
    up = standing_on(0.1, -0.09, z=1.5)
    way = course((1.2, 0.0))
    way.ahead[..., 2] = 1.5
    found = chosen(way, up, scene=scene)
    assert found.landing[2] == pytest.approx(1.5)
    assert found.landing[0] < 0.7
