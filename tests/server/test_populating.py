import pytest

from esplanade.planning import LayeredGrid, Scene
from esplanade.server.populating import NAMES, populate
from tests.server.worlds import ROOM, grid_of

PLACES = [
    {"name": name, "position": position}
    for name, position in [("n", (5, 9)), ("e", (9, 5)), ("s", (5, 1)), ("w", (1, 5))]
]
SQUARE = Scene.model_validate({"bounds": [0, 0, 10, 10], "places": PLACES})


def behaviours(scene: Scene, count: int, seed: int = 1) -> tuple[list[str], list[str]]:
    population, names = populate(LayeredGrid.from_scene(scene), scene, count, 0.05, seed)
    population.close()
    kinds = [population.explain(actor_id).behaviour for actor_id in names]
    return kinds, list(names.values())


def test_most_wander_one_patrols_and_one_guides_where_there_are_places() -> None:
    kinds, _ = behaviours(SQUARE, 6)
    assert kinds == ["wander", "patrol", "guide", "wander", "wander", "wander"]


def test_without_places_all_wander() -> None:
    kinds, _ = behaviours(Scene.open_space((0.0, 0.0, 10.0, 10.0)), 4)
    assert kinds == ["wander"] * 4


def test_names_are_told_apart_and_follow_the_seed() -> None:
    _, names = behaviours(ROOM, 60)
    assert len(set(names)) == 60
    assert set(names[: len(NAMES)]) == set(NAMES)
    assert behaviours(ROOM, 5, seed=2)[1] == behaviours(ROOM, 5, seed=2)[1]
    assert behaviours(ROOM, 5, seed=2)[1] != behaviours(ROOM, 5, seed=3)[1]


def test_a_scene_too_small_for_its_actors_says_so() -> None:
    scene = Scene.open_space((0.0, 0.0, 2.0, 2.0))
    with pytest.raises(ValueError, match="no free place for another actor"):
        populate(grid_of(scene), scene, 100, 0.05, 1)
