"""Recorded people among actors: they make room, come back, and keep off walls."""

from itertools import pairwise

import numpy as np
import pytest

from esplanade.pedestrians import ReactingCrowd, SocialForce, Walk
from tests.pedestrians.worlds import STANDING_ACTOR, TICK_S, crowded, straight


def walked(walk: Walk, ticks: int, actor: list[float] | None) -> np.ndarray:
    """Places of the first person, tick by tick."""
    places = []
    for _ in range(ticks):
        walk.step([] if actor is None else [actor])
        places.append(walk.positions[0])
    return np.array(places)


def test_a_person_steps_aside_for_an_actor_and_comes_back() -> None:
    crowd = ReactingCrowd([straight((-10, 0), (16, 0))], [0], TICK_S)
    walk = crowd.begin(0)
    places = walked(walk, 190, STANDING_ACTOR)
    assert np.hypot(*places.T).min() > 0.4
    aside = np.abs(places[:, 1])
    assert 0.3 < aside.max() < 1.0
    assert aside[:40].max() < 0.02
    assert aside[-1] < 0.005
    assert abs(walk.late_s[0]) < 0.02
    assert walk.displacement_m[0] == pytest.approx(
        np.linalg.norm(places - crowd.paths.places[1:191], axis=1).max()
    )


def test_a_standing_person_makes_room_and_takes_the_place_again() -> None:
    walk = ReactingCrowd([np.zeros((400, 2))], [0], TICK_S).begin(0)
    farthest = 0.0
    for tick in range(390):
        walk.step([[-6.0 + 0.13 * tick, 0.1, 1.3, 0.0, 0.25]])
        farthest = max(farthest, float(np.hypot(*walk.positions[0])))
    assert 0.2 < farthest < 1.0
    assert walk.positions[0].tolist() == [0.0, 0.0]


def test_somebody_held_up_goes_on_along_the_own_path_and_makes_up_time() -> None:
    """The way turns around the end of a wall, behind which the recording is already."""
    path = np.concatenate([straight((-6, 0), (2, 0)), straight((2, 0), (2, 12))[1:]])
    wall = [[1.0, 0.5, 1.0, 20.0]]
    walk = ReactingCrowd([path], [0], TICK_S, walls=wall).begin(0)
    late = []
    for tick in range(len(path) - 2):
        walk.step([[0.5, 0.0, 0.0, 0.0, 0.25], [0.5, -0.9, 0, 0, 0.25]] if tick < 70 else [])
        late.append(float(walk.late_s[0]))
    assert max(late) > 0.5
    assert late[-1] < 0.4 * max(late)
    assert walk.positions[0, 0] > 1.5


def test_walls_are_not_crossed() -> None:
    """Actors press thirty people against the walls of a corridor."""
    rng = np.random.default_rng(3)
    starts = np.column_stack([rng.uniform(-6, 6, 30), rng.uniform(-0.7, 0.7, 30)])
    paths = [
        straight((x, y), (x + 9.0 * (1 if k % 2 else -1), y)) for k, (x, y) in enumerate(starts)
    ]
    walls = [[-30, -1, 30, -1], [-30, 1, 30, 1]]
    walk = ReactingCrowd(paths, [0] * 30, TICK_S, walls=walls).begin(0)
    for tick in range(65):
        actors = [[-9 + 0.17 * tick + 2.0 * k, 0.3 * k - 0.9, 1.7, 0.0, 0.9] for k in range(7)]
        walk.step(actors)
        assert np.abs(walk.positions[:, 1]).max() < 1.0
    assert walk.displacement_m.max() > 0.5


def test_whoever_walks_through_a_wall_in_the_recording_is_not_held_up_by_it() -> None:
    walls = [[1.0, -5.0, 1.0, 5.0]]
    crowd = ReactingCrowd([straight((-5, 0), (10, 0))], [0], TICK_S, walls=walls)
    assert crowd.passes.tolist() == [[True]]
    places = walked(crowd.begin(0), 100, STANDING_ACTOR)
    assert places[-1, 0] > 5.0


def test_stronger_reactions_impose_more() -> None:
    path = straight((-10, 0), (10, 0))
    imposed = []
    for reaction in (0.0, 0.3, 1.0, 2.0):
        walk = ReactingCrowd([path], [0], TICK_S, reaction=reaction).begin(0)
        walked(walk, 150, STANDING_ACTOR)
        imposed.append(float(walk.displacement_m[0]))
    assert imposed == sorted(imposed)
    assert imposed[0] == 0.0 < imposed[1]


def test_people_make_room_for_people_who_make_room() -> None:
    """The one beside has no actor within sight of any consequence, but a neighbour who evades."""
    two = [straight((-10, 0), (10, 0)), straight((-10, -0.6), (10, -0.6))]
    pair, alone = ReactingCrowd(two, [0, 0], TICK_S), ReactingCrowd(two[1:], [0], TICK_S)
    beside, single = pair.begin(0), alone.begin(0)
    for _ in range(140):
        beside.step([[0.0, 0.2, 0.0, 0.0, 0.25]])
        single.step([[0.0, 0.2, 0.0, 0.0, 0.25]])
    assert beside.displacement_m[1] > single.displacement_m[0] + 0.02


def test_nothing_draws_a_person_to_where_somebody_was() -> None:
    """One of two who walk together is away: the other keeps the recorded way."""
    two = [straight((-10, 0), (10, 0)), straight((-10, -0.7), (10, -0.7))]
    crowd = ReactingCrowd(two, [0, 0], TICK_S)
    walk = crowd.begin(0, without={0})
    for _ in range(140):
        walk.step()
    assert walk.displacement_m.max() == 0.0


def test_an_actor_that_walks_like_the_person_it_stands_in_for_imposes_nothing() -> None:
    paths = [
        straight((-8, 0), (8, 0)),
        straight((8, 0.6), (-8, 0.6)),
        straight((-8, -0.7), (8, -1)),
    ]
    crowd = ReactingCrowd(paths, [0, 0, 0], TICK_S)
    walk, other = crowd.begin(0, {0}), crowd.begin(0, {0})
    for here, there in pairwise(paths[0]):
        actor = [[*here, *((there - here) / TICK_S), 0.25]]
        walk.step(actor, [0])
        other.step(actor)
    assert walk.displacement_m.max() == 0.0
    assert other.displacement_m[1:].min() > 0.1


def test_a_wider_body_imposes_more() -> None:
    imposed = []
    for radius_m in (0.25, 0.9):
        walk = ReactingCrowd([straight((-10, 0.2), (10, 0.2))], [0], TICK_S).begin(0)
        walked(walk, 150, [0.0, 0.0, 0.0, 0.0, radius_m])
        imposed.append(float(walk.displacement_m[0]))
    assert imposed[1] > 1.5 * imposed[0]


def test_people_come_and_go_as_they_were_recorded() -> None:
    crowd = crowded(seed=2)
    walk = crowd.begin(20, without={3})
    for _ in range(60):
        walk.step([STANDING_ACTOR])
        there = (crowd.paths.first <= walk.tick) & (walk.tick <= crowd.last)
        there[3] = False
        assert walk.present.tolist() == np.flatnonzero(there).tolist()
    someone = int(walk.present[0])
    walk.leave_out(someone)
    walk.step([STANDING_ACTOR])
    assert someone not in walk.present
    assert walk.displacement_m[someone] == 0.0


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        ({"reaction": -1.0}, "reaction: -1.0 is not from 0 to 10"),
        ({"reaction": float("nan")}, "reaction"),
        ({"walls": [[0, 0, 1]]}, "walls are rows"),
        ({"first_ticks": [0, 1]}, "1 trajectories, but 2 first ticks"),
        ({"trajectories": [[[0.0, np.inf]]]}, "not finite"),
        ({"tick_s": 0.0}, "tick_s"),
    ],
)
def test_wrong_inputs_are_refused(change: dict[str, object], fault: str) -> None:
    right = {"trajectories": [np.zeros((3, 2))], "first_ticks": [0], "tick_s": TICK_S}
    with pytest.raises(ValueError, match=fault):
        ReactingCrowd(**(right | change))  # type: ignore[arg-type]


def test_wrong_actors_are_refused() -> None:
    walk = ReactingCrowd([np.zeros((9, 2))], [0], TICK_S).begin(0)
    with pytest.raises(ValueError, match="not finite"):
        walk.step([[0, 0, np.nan, 0, 0.25]])
    with pytest.raises(ValueError, match="a radius is negative"):
        walk.step([[0, 0, 0, 0, -0.1]])
    with pytest.raises(ValueError, match="stand_ins"):
        walk.step([STANDING_ACTOR], [1])
    with pytest.raises(ValueError, match="unseen: 2 is not from 0 to 1"):
        SocialForce(unseen=2)
