"""The plan of a scene, storey by storey: what stands where."""

from typing import Final

from esplanade.planning import LayeredGrid, Scene
from esplanade.server.live.ground_plan import ground_plan

STOREYS_M: Final = (0.0, 3.5)


def _square(kind: str, offset_m: float, height_m: float) -> dict[str, object]:
    points = [(4.0, 4.0), (6.0, 4.0), (6.0, 6.0), (4.0, 6.0)]
    return {"kind": kind, "offset_m": offset_m, "height_m": height_m, "points": points}


def _kinds(*polygons: dict[str, object]) -> list[list[str]]:
    scene = Scene.model_validate(
        {"name": "house", "bounds": (0.0, 0.0, 10.0, 10.0), "polygons": polygons}
    )
    kinds: list[list[str]] = ground_plan(scene, LayeredGrid.from_scene(scene), STOREYS_M)["kinds"]
    return kinds


def test_what_grows_past_a_storey_is_on_the_one_that_it_stands_on() -> None:
    assert _kinds(_square("plant", 0.0, 6.0)) == [["plant"], []]
    assert _kinds(_square("furniture", 3.5, 1.0)) == [[], ["furniture"]]
    assert _kinds(_square("furniture", 1.1, 1.3)) == [["furniture"], []]


def test_walls_and_buildings_are_on_all_storeys_that_they_pass() -> None:
    assert _kinds(_square("building", 0.0, 8.0)) == [["building"], ["building"]]
    assert _kinds(_square("wall", 3.5, 2.8)) == [[], ["wall"]]
