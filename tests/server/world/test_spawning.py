import numpy as np
import pytest

from esplanade.planning import Polygon, Scene
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
