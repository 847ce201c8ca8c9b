import numpy as np
import pytest

from esplanade.actors.locomotion.body.skeleton import TRACK_HALF_WIDTH
from esplanade.actors.locomotion.footsteps.course import Course
from esplanade.actors.locomotion.footsteps.footholds import Footholds, choose_footholds
from esplanade.planning import Polygon, Scene
from esplanade.planning.compiled.arrays import Floats
from tests.actors.locomotion.courses import LEG, course, standing_on
from tests.actors.locomotion.parade import FIELD, Parade


def chosen(
    way: Course, footprint: Floats, right: bool = True, scene: Scene = FIELD, whole_s: float = 0.5
) -> Footholds:
    ground = Parade(1, scene).ground
    seconds = np.array([whole_s])
    return choose_footholds(way, np.array([right]), footprint, LEG, seconds, seconds, ground)


def test_feet_land_half_a_step_ahead_on_their_own_side() -> None:
    footprint = standing_on(0.3, -0.09)
    found = chosen(course((1.2, 0.0)), footprint)
    np.testing.assert_allclose(found.hips, [[0.6, 0.0]])
    ahead = found.landing[0, 0] - 0.6
    assert 0.2 < ahead < 0.42
    assert found.landing[0, 1] == pytest.approx(TRACK_HALF_WIDTH * 0.9, abs=1e-4)
    left = chosen(course((1.2, 0.0)), standing_on(0.3, 0.09), right=False)
    np.testing.assert_allclose(left.landing[0] * [1.0, -1.0, 1.0, 1.0], found.landing[0])


def test_places_of_a_turned_world_are_turned() -> None:
    angle = 2.1
    c, s = np.cos(angle), np.sin(angle)
    one = chosen(course((1.0, 0.3)), standing_on(0.2, -0.09))
    other = chosen(
        course((c - 0.3 * s, s + 0.3 * c)),
        standing_on(0.2 * c + 0.09 * s, 0.2 * s - 0.09 * c, angle),
    )
    turned = one.landing[:, :2] @ np.array([[c, s], [-s, c]])
    np.testing.assert_allclose(other.landing[:, :2], turned, atol=2e-4)
    assert other.heading[0] == pytest.approx(one.heading[0] + angle)


@pytest.mark.parametrize("turn", np.linspace(-3.1, 3.1, 9))
@pytest.mark.parametrize("right", [True, False])
def test_feet_turn_further_outwards_and_never_cross(turn: float, right: bool) -> None:
    side = 1.0 if right else -1.0
    footprint = standing_on(0.0, -0.09 * side)
    found = chosen(course((0.0, 0.0), turn), footprint, right)
    turned = found.landing[0, 3]
    assert -1.0 - 1e-9 <= side * turned <= 1.6 + 1e-9
    assert turned * turn >= 0.0
    middle = 0.5 * turned
    across = np.array([-np.sin(middle), np.cos(middle)]) @ (found.landing - footprint)[0, :2]
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
    assert found.landing[0, 2] == pytest.approx(1.5)
    assert found.landing[0, 0] < 0.7
