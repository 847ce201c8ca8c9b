"""Plans of other programs become scenes with the same floors, walls and doors."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from esplanade.cli import main
from esplanade.commandline.errors import UsageError
from esplanade.planning import LayeredGrid, Scene
from esplanade.planning.routes.find_path import PathStatus, find_path
from esplanade.planning.scene.rings import twice_area
from esplanade.planning.scene.scene_file import read_scene
from esplanade.scenery.plans.reading import read_plan
from esplanade.scenery.plans.scene_of_plan import STOREY_M, scene_of_plan

pytest.importorskip("shapely")

WKT = """# a hall with a bay, a pillar and a screen
POLYGON ((0 0, 20 0, 20 10, 12 10, 12 16, 8 16, 8 10, 0 10, 0 0), (4 4, 6 4, 6 6, 4 6, 4 4))
LINESTRING (10 0, 10 4)
"""
JUPEDSIM = """<geometry version="0.8" unit="m"><rooms><room id="0"><subroom id="0">
<polygon><vertex px="10" py="3"/><vertex px="10" py="0"/><vertex px="0" py="0"/>
<vertex px="0" py="8"/><vertex px="10" py="8"/><vertex px="10" py="5"/></polygon>
</subroom></room></rooms><transitions><transition id="3" caption="exit">
<vertex px="10" py="3"/><vertex px="10" py="5"/></transition></transitions></geometry>"""


def geojson(corner: tuple[float, float] = (0.0, 0.0), metres: float = 1.0) -> str:
    def at(x: float, y: float) -> list[float]:
        return [corner[0] + x * metres, corner[1] + y * metres]

    ring = [at(0, 0), at(20, 0), at(20, 10), at(0, 10), at(0, 0)]
    shapes = [
        ("Polygon", [ring], {}),
        ("LineString", [at(10, 4), at(10, 6)], {"kind": "door", "name": "gate"}),
        ("LineString", [at(10, 0), at(10, 4)], {"kind": "wall"}),
        ("Point", at(2, 2), {"name": "bar"}),
    ]
    features = [
        {"type": "Feature", "properties": p, "geometry": {"type": t, "coordinates": c}}
        for t, c, p in shapes
    ]
    return json.dumps({"type": "FeatureCollection", "features": features})


def scene_of(path: Path, text: str, encoding: str = "utf-8") -> Scene:
    path.write_text(text, encoding=encoding)
    return scene_of_plan([read_plan(path)], path.stem)


def areas(scene: Scene, cell_m: float = 0.25) -> list[float]:
    """The floor of each layer, m²."""
    grid = LayeredGrid.from_scene(scene, cell_m)
    known = np.isfinite(grid.layered.floors)
    counts = np.bincount(grid.layered.places["layer"][known])
    return [float(count * cell_m**2) for count in counts]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_wkt_says_where_one_can_walk(tmp_path: Path, encoding: str) -> None:
    scene = scene_of(tmp_path / "hall.wkt", WKT, encoding)
    assert scene.bounds == (0.0, 0.0, 20.0, 16.0)
    assert areas(scene) == [220.0]
    assert [(wall.start, wall.end) for wall in scene.walls] == [((10.0, 0.0), (10.0, 4.0))]


def test_geojson_has_doors_and_places(tmp_path: Path) -> None:
    scene = scene_of(tmp_path / "hall.geojson", geojson())
    assert areas(scene) == [200.0]
    (door,) = scene.doors
    assert (door.name, door.start, door.end) == ("gate", (10.0, 4.0), (10.0, 6.0))
    assert [(place.name, place.position) for place in scene.places] == [("bar", (2.0, 2.0))]


def test_degrees_become_metres_and_it_is_said(tmp_path: Path) -> None:
    path = tmp_path / "hall.geojson"
    path.write_text(geojson((6.96, 0.0), 1.0 / 111_319.49))
    storey = read_plan(path)
    assert "degrees" in storey.remarks[0]
    x0, y0, x1, y1 = storey.bounds()
    assert (x1 - x0, y1 - y0) == pytest.approx((20.0, 10.0), abs=1e-3)


def test_jupedsim_geometry_has_walls_and_transitions(tmp_path: Path) -> None:
    scene = scene_of(tmp_path / "room.xml", JUPEDSIM)
    assert len(scene.walls) == 5
    assert [(door.name, door.start) for door in scene.doors] == [("exit", (10.0, 3.0))]
    centimetres = JUPEDSIM.replace('unit="m"', 'unit="cm"')
    assert scene_of(tmp_path / "small.xml", centimetres).bounds == (0.0, 0.0, 1.0, 1.0)


def xml_of(*chains: str) -> str:
    """Polygons of JuPedSim, each of vertices as in `0,0 10,0`."""
    return "".join(
        f"<polygon>{''.join(vertex(corner) for corner in chain.split())}</polygon>"
        for chain in chains
    )


def vertex(corner: str) -> str:
    x, y = corner.split(",")
    return f'<vertex px="{x}" py="{y}"/>'


@pytest.mark.parametrize("kind", ["stair", "subroom"], ids=["stairs", "ramp"])
def test_jupedsim_rooms_lie_at_their_heights(tmp_path: Path, kind: str) -> None:
    hall = xml_of("10,3 10,0 0,0 0,8 10,8 10,5") + "<obstacles><obstacle>"
    hall += xml_of("4,4 5,4 5,5 4,5 4,4") + "</obstacle></obstacles>"
    flight = xml_of("10,3 17,3", "10,5 17,5")
    loft = xml_of("17,3 17,-1 24,-1 24,9 17,9 17,5")
    text = f"""<geometry version="0.8" unit="m"><rooms><room id="0">
    <subroom id="0" class="subroom" A_x="0" B_y="0" C_z="-3">{hall}</subroom>
    <subroom id="1" class="{kind}" A_x="0.428571" B_y="0" C_z="-7.285714">{flight}</subroom>
    <crossings><crossing id="0" subroom1_id="0" subroom2_id="1">{vertex("10,3")}{vertex("10,5")}
    </crossing></crossings></room>
    <room id="1"><subroom id="0" C_z="0">{loft}</subroom></room></rooms><transitions>
    <transition id="3" caption="up" room1_id="0" subroom1_id="1" room2_id="1" subroom2_id="0">
    {vertex("17,3")}{vertex("17,5")}</transition></transitions></geometry>"""
    scene = scene_of(tmp_path / "house.xml", text)
    assert scene.bounds == (0.0, -1.0, 24.0, 9.0)
    assert scene.origin_m == (0.0, 0.0, -3.0)
    assert [(door.name, door.offset_m) for door in scene.doors] == [("0 m up", 3.0)]
    assert len(scene.stairs) == (kind == "stair")
    floors = [wall.offset_m for wall in scene.walls if wall.start[0] > 17 or wall.end[0] > 17]
    assert set(floors) == {3.0}
    grid = LayeredGrid.from_scene(scene, 0.25)
    known = np.isfinite(grid.layered.floors)
    assert known.sum() * 0.0625 == pytest.approx(80 - 1 + 14 + 70, abs=0.5)
    assert np.nanmax(grid.layered.floors) == pytest.approx(3.0)
    path = find_path(grid, (2, 2, 0), (20, 4, 3))
    assert path.status is PathStatus.FOUND


def test_jupedsim_rooms_that_do_not_close_are_walls_on_open_ground(tmp_path: Path) -> None:
    open_ = JUPEDSIM.replace("<transition ", "<crossing ").replace('px="10" py="5"/></t', 'px="9" py="5"/></t')  # noqa: E501  # fmt: skip
    open_ = open_.replace("</transition>", "</crossing>").replace(
        'id="0">', 'id="0" class="stair" A_x="0.5" C_z="1">'
    )
    path = tmp_path / "room.xml"
    path.write_text(open_)
    storey = read_plan(path)
    assert storey.walkable is None
    assert storey.remarks == ["its rooms do not close: stairs are read as level rooms"]


def test_several_plans_are_storeys(tmp_path: Path) -> None:
    storeys = []
    for name in ("ground", "first"):
        path = tmp_path / f"{name}.wkt"
        path.write_text(WKT)
        storeys.append(read_plan(path))
    scene = scene_of_plan(storeys, "house")
    assert areas(scene) == [220.0, 220.0]
    assert {polygon.kind for polygon in scene.polygons} == {"floor", "wall"}
    assert max(wall.offset_m for wall in scene.walls) == STOREY_M


@pytest.mark.parametrize("yaw", [0.0, 0.5])
def test_a_ros_map_is_free_where_it_is_light(tmp_path: Path, yaw: float) -> None:
    pixels = np.full((40, 60), 254, dtype=np.uint8)
    pixels[:, :4] = pixels[:, -4:] = pixels[:4] = pixels[-4:] = 0
    pixels[10:14, 20:24] = 205
    Image.fromarray(pixels).save(tmp_path / "map.pgm")
    path = tmp_path / "map.yaml"
    path.write_text(
        f"image: map.pgm\nresolution: 0.25\norigin: [-3.0, 2.0, {yaw}]\nnegate: 0\n"
        "occupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )
    storey = read_plan(path)
    assert storey.walkable.area == pytest.approx((32 * 52 - 16) / 16)
    assert "0.7% of them are unknown" in storey.remarks[0]
    if not yaw:
        assert storey.walkable.bounds == pytest.approx((-2.0, 3.0, 11.0, 11.0))
        assert areas(scene_of_plan([storey], "map")) == [103.0]


def test_a_drawing_has_its_unit_layers_and_doors(tmp_path: Path) -> None:
    ezdxf = pytest.importorskip("ezdxf")
    drawing = ezdxf.new()
    drawing.header["$INSUNITS"] = 4
    for layer in ("A-WALL", "A-DOOR", "A-TEXT"):
        drawing.layers.add(layer)
    space = drawing.modelspace()
    ring = [(0, 0), (8000, 0), (8000, 6000), (0, 6000)]
    space.add_lwpolyline(ring, close=True, dxfattribs={"layer": "A-WALL"})
    space.add_circle((4000, 3000), 500, dxfattribs={"layer": "A-WALL"})
    space.add_line((2000, 0), (3000, 0), dxfattribs={"layer": "A-DOOR"})
    space.add_text("hall", dxfattribs={"layer": "A-TEXT"})
    path = tmp_path / "plan.dxf"
    drawing.saveas(path)
    storey = read_plan(path, ["a-wall"])
    assert storey.bounds() == pytest.approx((0.0, 0.0, 8.0, 6.0))
    assert storey.doors == [("door 1", ((2.0, 0.0), (3.0, 0.0)))]
    assert storey.remarks == ["passed over: 1 entities of layer A-TEXT"]
    assert len(scene_of_plan([storey], "plan").walls) > 10
    with pytest.raises(UsageError, match=r"plan.dxf: it has no layer walls; there are A-DOOR"):
        read_plan(path, ["walls"])


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.wkt", "POLYGON ((0 0, 1 1", "bracket"),
        ("a.wkt", "POLYGON ((0 0, x 1))", "geometry 1: .*ParseException"),
        ("a.wkt", "POLYGON ((0 0, 4 4, 4 0, 0 3, 0 0))", "crosses itself"),
        ("a.geojson", '{"type": "Feature", "geometry": {"type": "Dot"}}', "features.0"),
        ("a.geojson", "[" * 100_000, "deep|JSON|Expecting"),
        ("a.xml", "<rooms/>", "no <geometry>"),
        ("a.xml", "<!DOCTYPE a [<!ENTITY b 'c'>]><geometry/>", "document type"),
        ("a.yaml", "image: map.pgm\n", "resolution"),
        ("a.yaml", "image: [", "no YAML"),
        ("a.dxf", "no drawing", "no DXF"),
    ],
)
def test_what_is_no_plan_is_refused_by_name(
    tmp_path: Path, name: str, text: str, message: str
) -> None:
    path = tmp_path / name
    path.write_text(text)
    with pytest.raises(UsageError, match=rf"{name}: .*({message})"):
        read_plan(path)


def test_the_command_tells_floors_and_writes_a_scene(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "hall.wkt"
    path.write_text(WKT)
    out = tmp_path / "hall.json"
    assert main(["scene", "import", str(path), "--out", str(out), "--cell", "0.5"]) == 0
    told = capsys.readouterr().out
    assert "220.0 m² of floor in all" in told
    assert "3 polygons, 1 walls, 0 doors" in told
    assert out.with_suffix(".png").is_file()
    assert read_scene(out).spawns


def drawing_with_doors(path: Path) -> None:
    """A room whose door is a block: a leaf that stands open, its swing, and a threshold."""
    ezdxf = pytest.importorskip("ezdxf")
    drawing = ezdxf.new()
    drawing.header["$INSUNITS"] = 6
    for layer in ("A-WALL", "A-DOOR", "A-STAIR", "A-OLD"):
        drawing.layers.add(layer)
    drawing.layers.get("A-OLD").off()
    block = drawing.blocks.new("LEAF")
    block.add_line((0, 0), (0, 0.9))
    block.add_arc((0, 0), 0.9, 0, 90)
    space = drawing.modelspace()
    space.add_lwpolyline(
        [(2.9, 0), (8, 0), (8, 6), (0, 6), (0, 0), (2, 0)], dxfattribs={"layer": "A-WALL"}
    )
    space.add_blockref("LEAF", (2, 0), dxfattribs={"layer": "A-DOOR"})
    space.add_line((0, 3), (8, 3), dxfattribs={"layer": "A-OLD"})
    for k in range(5):
        space.add_line((5 + 0.3 * k, 4), (5 + 0.3 * k, 5), dxfattribs={"layer": "A-STAIR"})
    space.add_linear_dim(base=(0, 8), p1=(0, 6), p2=(8, 6)).render()
    drawing.saveas(path)


def test_a_door_is_where_its_leaf_closes(tmp_path: Path) -> None:
    path = tmp_path / "plan.dxf"
    drawing_with_doors(path)
    storey = read_plan(path)
    ((_, (hinge, end)),) = storey.doors
    assert hinge == pytest.approx((2.0, 0.0), abs=1e-6)
    assert end == pytest.approx((2.9, 0.0), abs=0.01)
    assert len(storey.walls) == 5
    told = " ".join(storey.remarks)
    assert "1 entities of layer A-OLD, which is off" in told
    assert "5 lines of stairs (layer A-STAIR), taken as level floor" in told
    assert "1 entities of type DIMENSION" in told


def test_blocks_within_blocks_fill_no_memory(tmp_path: Path) -> None:
    ezdxf = pytest.importorskip("ezdxf")
    drawing = ezdxf.new()
    inner = drawing.blocks.new("B0")
    inner.add_line((0, 0), (1, 0))
    for k in range(1, 12):
        block = drawing.blocks.new(f"B{k}")
        for _ in range(10):
            block.add_blockref(f"B{k - 1}", (0, 0))
    drawing.modelspace().add_blockref("B11", (0, 0))
    path = tmp_path / "bomb.dxf"
    drawing.saveas(path)
    with pytest.raises(UsageError, match="draws more than 50000 lines"):
        read_plan(path)


def test_a_drawing_of_another_program_is_named(tmp_path: Path) -> None:
    path = tmp_path / "plan.dxf"
    path.write_bytes(b"AC1027\0\0\0\0\0")
    with pytest.raises(UsageError, match="DWG, which is not read: save it as DXF"):
        read_plan(path)


def test_a_line_of_stairs_leads_to_the_storey_above(tmp_path: Path) -> None:
    ring = [[0, 0], [20, 0], [20, 10], [0, 10], [0, 0]]
    floor = {
        "type": "Feature",
        "properties": {},
        "geometry": {"type": "Polygon", "coordinates": [ring]},
    }
    flight = {
        "type": "Feature",
        "properties": {"kind": "stairs", "width_m": 2.0},
        "geometry": {"type": "LineString", "coordinates": [[4, 5], [12, 5]]},
    }
    storeys = []
    for name in ("ground", "first"):
        path = tmp_path / f"{name}.geojson"
        path.write_text(json.dumps({"type": "FeatureCollection", "features": [floor, flight]}))
        storeys.append(read_plan(path))
    scene = scene_of_plan(storeys, "house")
    (stairs,) = scene.stairs
    assert (stairs.start, stairs.end, stairs.top_m) == ((4.0, 5.0), (12.0, 5.0), STOREY_M)
    assert "no storey above" in " ".join(storeys[1].remarks)
    upper = [p for p in scene.polygons if p.kind == "floor"]
    assert sum(abs(twice_area(p.points)) / 2 for p in upper) == pytest.approx(200.0 - 16.0)


def test_corners_that_are_not_finite_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "far.wkt"
    path.write_text("LINESTRING (0 0, 10 0)\nLINESTRING (0 0, 1e400 5)\n")
    with pytest.raises(UsageError, match=r"a corner of it is not finite|geometry 2"):
        read_plan(path)
