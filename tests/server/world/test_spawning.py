import numpy as np
import pytest

from esplanade.planning import Polygon, Scene, Spawn
from esplanade.server.world.spawning import NoRoomError, Spawning
from tests.server.worlds import FIELD, ROOM, grid_of


def spawning(scene: Scene, seed: int = 1) -> Spawning:
    grid = grid_of(scene)
    return Spawning(scene, grid, 0.25, np.random.SeedSequence(seed))


def test_newcomers_stand_within_a_spawn_point() -> None:
    door = spawning(ROOM)
    for _ in range(50):
        x, y, z = door.place(None)
        assert np.hypot(x - 3.0, y - 3.0) <= 1.0
        assert z == 0.0


def test_the_same_seed_gives_the_same_places() -> None:
    one, same, other = spawning(FIELD, 5), spawning(FIELD, 5), spawning(FIELD, 6)
    places = [one.place(None) for _ in range(10)]
    assert places == [same.place(None) for _ in range(10)]
    assert places != [other.place(None) for _ in range(10)]


@pytest.mark.parametrize("at", [(10.0, 5.0, 0.0), (-50.0, 1e5, 0.0), (10.0, 5.0, 9.0)])
def test_a_wished_place_gives_way_to_walls_bounds_and_floors(
    at: tuple[float, float, float],
) -> None:
    x, y, z = spawning(ROOM).place(at)
    assert grid_of(ROOM).is_free([(x, y)], [z], 0.25)[0]
    assert z == 0.0


def test_a_scene_without_room_is_refused() -> None:
    block = Polygon(
        points=((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)), height_m=2.0, kind="water"
    )
    scene = Scene.open_space((0.0, 0.0, 4.0, 4.0), polygons=[block], name="stone")
    with pytest.raises(NoRoomError, match="'stone' has no free place"):
        spawning(scene)


TWO_DOORS = ROOM.model_copy(
    update={
        "spawns": (
            Spawn(position=(3.0, 3.0), radius_m=1.0),
            Spawn(position=(10.0, 17.0), radius_m=1.5),
        )
    }
)


def test_a_wish_that_is_not_granted_chooses_the_nearest_spawn_point() -> None:
    door = spawning(TWO_DOORS)
    for _ in range(50):
        x, y, _ = door.place((18.0, 18.0, 0.0), anywhere=False)
        assert np.hypot(x - 10.0, y - 17.0) <= 1.5
        x, y, _ = door.place((0.0, 0.0, 0.0), anywhere=False)
        assert np.hypot(x - 3.0, y - 3.0) <= 1.0


def test_a_place_of_arrival_is_within_the_spawn_point_where_a_wall_takes_half_of_it() -> None:
    beside = Spawn(position=(9.9, 5.0), radius_m=1.0)
    door = spawning(ROOM.model_copy(update={"spawns": (beside,)}))
    for _ in range(50):
        x, y, _ = door.place(None)
        assert np.hypot(x - 9.9, y - 5.0) <= 1.0
        assert abs(x - 10.0) >= 0.24


def test_without_spawn_points_a_wish_is_no_way_in() -> None:
    places = [spawning(FIELD, seed).place((1.0, 1.0, 0.0), anywhere=False) for seed in range(8)]
    assert max(np.hypot(x - 1.0, y - 1.0) for x, y, _ in places) > 50.0
