"""The checks in the gallery find impossible positions, causes of contacts, and lost trips."""

from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from benchmarks._contact_causes import ContactCauses, SeenBody, contact_causes
from benchmarks._lost_trips import LostTrips
from benchmarks._position_checks import clearances, inside, unsupported
from benchmarks.gallery import position_figures

from esplanade.actors import Navigator, Outcome
from esplanade.planning import LayeredGrid, Place, Scene, Wall
from esplanade.planning.scene.scene_file import read_scene
from esplanade.server.loading import DEFAULT_SCENE
from esplanade.server.world.zone import Zone
from tests.server.worlds import ROOM

GALLERY = read_scene(DEFAULT_SCENE)


def one(*point: float) -> np.ndarray:
    return np.array([point], dtype=np.float64)


def point_of(place: Place) -> tuple[float, float, float]:
    return (*place.position, place.z_m)


@pytest.mark.parametrize("place", GALLERY.places, ids=lambda place: place.name)
def test_every_place_is_a_place_to_be(place: Place) -> None:
    point = one(*point_of(place))
    assert not unsupported(GALLERY, point).any()
    assert not inside(GALLERY, point).any()
    assert clearances(GALLERY, point)[0] >= 0.2


@pytest.mark.parametrize(
    ("point", "fault"),
    [
        ((20.0, 12.5, 2.0), unsupported),  # between the passage and the bridge
        ((20.0, 16.0, 3.5), unsupported),  # above the court
        ((22.0, 18.0, 0.0), inside),  # in the stairs
        ((22.0, 18.0, 2.4), unsupported),  # above them
        ((2.25, 7.5, 0.0), inside),  # in a wall
        ((18.0, 11.5, 3.5), inside),  # in a railing
        ((30.0, 28.0, 0.0), inside),  # in the ramp
        ((50.0, 0.0, 0.0), unsupported),  # beyond the bounds
    ],
)
def test_where_nobody_can_be_is_found(point, fault) -> None:
    assert fault(GALLERY, one(*point)).all()


def test_stairs_and_ramps_carry() -> None:
    stairs = np.array([[16.0, 14.5 + 0.3 * k + 0.15, 0.175 * (k + 1)] for k in range(10)])
    ramp = np.array([[x, 28.0, 1.75 * (37.0 - x) / 14.0] for x in np.linspace(23.5, 36.5, 20)])
    for points in (stairs, ramp):
        assert not unsupported(GALLERY, points).any()
        assert not inside(GALLERY, points).any()


def test_distances_are_those_to_what_stops_a_body() -> None:
    points = np.array([[9.5, 4.0, 0.0], [9.0, 14.5, 0.0], [12.0, 18.0, 0.0]])
    assert clearances(ROOM, points) == pytest.approx([0.5, 1.0, 3.0], abs=0.02)


def test_figures_sum_it_up() -> None:
    rows = [[tick, 7.0, 2.0 + 0.1 * tick, 4.0, 0.0] for tick in range(10)]
    rows += [[tick, 8.0, 10.0, 4.0, 0.0] for tick in range(0, 10, 3)]
    figures = position_figures(ROOM, np.array(rows))
    assert figures["positions"] == 14
    assert figures["avatars"] == 2
    assert figures["share_at_0_m"] == 1.0
    assert figures["inside"] == 4  # this avatar stands in the wall
    assert figures["unsupported"] == 0
    assert figures["longest_move_m"] == pytest.approx(0.1)
    assert figures["steps_too_high"] == 0


ACTOR, PERSON, TICKS, WALK_M = 1, 2, 40, 0.065
BODIES = {ACTOR: SeenBody(True, 0.25), PERSON: SeenBody(False, 0.25)}


def walked(actor_m: float, person_m: float, gap_m: float = 1.0, z_m: float = 0.0) -> np.ndarray:
    """An actor walks east and a person west, by so much a tick; who stands is sent once."""
    rows = []
    for tick in range(TICKS):
        for who, x, move_m, z in (
            (ACTOR, 0.0, actor_m, 0.0),
            (PERSON, gap_m, -person_m, z_m),
        ):
            if tick == 0 or move_m:
                rows.append((tick, who, x + tick * move_m, 0.0, z))
    return np.array(rows, dtype=np.float64)


@pytest.mark.parametrize(
    ("seen", "causes"),
    [
        (walked(0.0, WALK_M), ContactCauses(1, 1, 1, 0, 1)),
        (walked(-0.3 * WALK_M, WALK_M), ContactCauses(1, 1, 1, 0, 1)),
        (walked(WALK_M, 0.0), ContactCauses(1, 0, 0, 1, 0)),
        (walked(0.9 * WALK_M, WALK_M, 4.0), ContactCauses(1, 0, 0, 0, 1)),
        (walked(0.01 * WALK_M, WALK_M, 1.5), ContactCauses(1, 0, 1, 0, 1)),
        (walked(WALK_M, WALK_M, 1.5, z_m=3.5), ContactCauses()),
        (walked(0.0, WALK_M, 9.0), ContactCauses()),
    ],
    ids=["stands", "backs away", "walks", "both", "the slower hardly", "on two floors", "apart"],
)
def test_contacts_have_their_causes(seen, causes) -> None:
    assert contact_causes(seen, BODIES, 0.05) == causes


def test_lost_trips_are_named_and_judged() -> None:
    corners = [(6.0, 6.0), (9.0, 6.0), (9.0, 9.0), (6.0, 9.0)]
    sides = zip(corners, corners[1:] + corners[:1], strict=True)
    closet = Place(name="closet", position=(7.5, 7.5))
    scene = Scene(
        bounds=(0.0, 0.0, 10.0, 10.0),
        walls=tuple(Wall(start=start, end=end) for start, end in sides),
        places=(closet,),
    )
    nav = Navigator(LayeredGrid.from_scene(scene), tick_s=0.1)
    zone = SimpleNamespace(scene=scene, grid=nav.grid, agents=nav.table)
    trips = LostTrips(cast(Zone, zone))
    nav.add_actor("a", (2.0, 2.0), closet.position)
    for _ in range(40):
        nav.observe({})
        state = nav.tick()["a"]
        trips.note()
    assert state.outcome is Outcome.NO_WAY
    assert trips.figures() == {"no_way_to": "closet 1", "no_way_though_there_is": 0}
    nav.set_goal("a", (4.0, 2.0))
    trips.note()
    nav.table.trips.no_path_s[0] = 3.0  # as if it found none
    trips.note()
    assert trips.figures()["no_way_though_there_is"] == 1
    nav.close()
