"""Mesh files as people have them: what is read all the same, and what is refused by name."""

import gzip
from pathlib import Path

import numpy as np
import pytest
import trimesh

from esplanade.planning import Body, LayeredGrid, PathStatus, find_path
from esplanade.planning.routes.potential import Potential
from esplanade.planning.scene.mesh_file import MeshError, read_mesh, read_triangles
from tests.planning.ground.test_meshes import block, house, written
from tests.planning.worlds import of_all

BELOW, ABOVE = (6.0, 2.0, 0.0), (6.0, 2.0, 2.7)
LENGTH_M = 13.52


def obj_of(vertices: np.ndarray, faces: np.ndarray) -> str:
    corners = "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in vertices.tolist())
    return corners + "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in faces.tolist())


def spoiled(how: str) -> tuple[np.ndarray, np.ndarray]:
    """The house with flaws that meshes have and that change nothing."""
    mesh = house()
    vertices, faces = np.asarray(mesh.vertices), np.asarray(mesh.faces)
    match how:
        case "every face twice":
            faces = np.concatenate([faces, faces])
        case "faces of no area":
            faces = np.concatenate([faces, [[0, 0, 1], [1, 1, 1], [2, 3, 2]]])
        case "faces of three corners in a line":
            line = [[3.0, 3.0, 1.0], [4.0, 3.0, 1.0], [5.0, 3.0, 1.0]]
            faces = np.concatenate([faces, [len(vertices) + np.arange(3)]])
            vertices = np.concatenate([vertices, line])
        case "faces that look both ways":
            faces = np.concatenate([faces, faces[:, ::-1]])
        case "corners a hair apart":
            vertices = vertices + np.random.default_rng(0).normal(0.0, 1e-6, vertices.shape)
        case "parts one millimetre apart":
            vertices = vertices + np.random.default_rng(0).normal(0.0, 5e-4, vertices.shape)
    return vertices, faces


@pytest.mark.parametrize(
    "how",
    of_all(
        [
            "none",
            "every face twice",
            "faces of no area",
            "faces of three corners in a line",
            "faces that look both ways",
            "corners a hair apart",
            "parts one millimetre apart",
        ]
    ),
)
def test_flaws_of_meshes_change_no_way(tmp_path, how) -> None:
    path = tmp_path / "house.obj"
    path.write_text(obj_of(*spoiled(how)))
    grid = LayeredGrid.from_mesh(path, up="z")
    assert grid.layers == 2
    way = find_path(grid, BELOW, ABOVE)
    assert way.status is PathStatus.FOUND
    assert way.length_m == pytest.approx(LENGTH_M, abs=0.15)


@pytest.mark.parametrize("far_m", of_all([1e5, 1e3, 9e5]))
def test_far_from_its_origin_a_house_is_the_same(tmp_path, far_m) -> None:
    mesh = house()
    path = tmp_path / "far.obj"
    path.write_text(obj_of(np.add(mesh.vertices, (far_m, -far_m, 0.0)), np.asarray(mesh.faces)))
    grid = LayeredGrid.from_mesh(path, up="z")
    ends = [tuple(np.add(end, (far_m, -far_m, 0.0)).tolist()) for end in (BELOW, ABOVE)]
    way = find_path(grid, *ends)
    assert way.length_m == pytest.approx(LENGTH_M, abs=0.01)
    left = Potential(grid, ends[1][:2], ends[1][2], 0.25).distance([ends[0][:2]], [0.0])
    # The potential measures on the plan, the path up the stairs too.
    assert LENGTH_M - 1.4 < left[0] < LENGTH_M


@pytest.mark.parametrize("thick_m", [0.001, 0.02, 0.3])
def test_thin_floors_are_floors(tmp_path, thick_m) -> None:
    slabs = [block(0, 0, z - thick_m, 6, 4, z) for z in (0.0, 2.7)]
    grid = LayeredGrid.from_mesh(written(tmp_path, trimesh.util.concatenate(slabs)), up="z")
    assert grid.layers == 2
    heights = grid.layered.floors[np.isfinite(grid.layered.floors)].astype(float)
    assert set(heights.round(3).tolist()) == {0.0, 2.7}
    for z in (0.0, 2.7):
        assert find_path(grid, (1.0, 1.0, z), (5.0, 3.0, z)).status is PathStatus.FOUND
    assert find_path(grid, (1.0, 1.0, 0.0), (5.0, 3.0, 2.7)).status is PathStatus.NO_WAY


def test_names_in_any_encoding_do_no_harm(tmp_path) -> None:
    mesh = house()
    path = tmp_path / "old.obj"
    text = obj_of(np.asarray(mesh.vertices), np.asarray(mesh.faces)).replace("\n", "\r\n")
    path.write_bytes(
        "# Geb\u00e4ude\r\nmtllib absent.mtl\r\no K\u00fcche\r\n".encode("latin-1") + text.encode()
    )
    assert len(read_triangles(path, "z")) == len(mesh.faces)


def test_a_house_is_the_same_in_every_format(tmp_path) -> None:
    ours = np.sort(read_triangles(written(tmp_path, house()), "z").reshape(-1, 9), axis=0)
    for suffix in ("stl", "ply", "off", "glb", "gltf"):
        if suffix == "gltf":
            files = trimesh.Scene(house()).export(file_type="gltf")
            for name, data in files.items():
                (tmp_path / name).write_bytes(data)
            path = tmp_path / "model.gltf"
        else:
            path = written(tmp_path, house(), f"house.{suffix}")
        found = np.sort(read_triangles(path, "z").reshape(-1, 9), axis=0)
        assert found == pytest.approx(ours, abs=1e-5)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("v 0 0 0\nv 1 0 0\nf 1 2\n", "holds no triangles"),
        ("v 0 0 0\nv 4 0 0\nv 0 0 4\nf 1 3 2\nf 1 2 9\n", "is out of bounds"),
        ("v 0 0 0\nv 1 0 0\nl 1 2\n", "holds no triangles"),
        ("v 2e6 0 0\nv 2000004 0 0\nv 2e6 0 4\nf 1 3 2\n", "lies 2e.06 m from its origin"),
        ("\x00\x01\x02", "is no text"),
    ],
)
def test_what_is_no_mesh_is_refused_in_words(tmp_path, text, message) -> None:
    path = tmp_path / "wrong.obj"
    path.write_text(text)
    with pytest.raises(MeshError, match=rf"wrong.obj: .*({message})"):
        read_triangles(path)


def test_far_away_a_mesh_is_moved_to_the_origin_on_request(tmp_path) -> None:
    mesh = house()
    path = tmp_path / "utm.obj"
    path.write_text(
        obj_of(np.add(mesh.vertices, (411_000.25, 5_650_000.5, 93.0)), np.asarray(mesh.faces))
    )
    with pytest.raises(MeshError, match=r"utm.obj: it lies 5.65.* --recentre"):
        read_triangles(path, "z")
    found = read_mesh(path, "z", recentre=True)
    assert found.offset_m == (411_004.0, 5_650_004.0, 93.0)
    moved = np.sort((found.triangles + found.offset_m).reshape(-1, 9), axis=0)
    corners = np.add(mesh.vertices, (411_000.25, 5_650_000.5, 93.0))[mesh.faces]
    assert moved == pytest.approx(np.sort(corners.reshape(-1, 9), axis=0), abs=1e-6)


def test_errors_name_the_file_that_was_asked_for(tmp_path) -> None:
    for name in ("absent.obj", "absent.glb"):
        with pytest.raises(MeshError, match=rf"^{name}: there is no such file$"):
            read_triangles(tmp_path / name)
    path = tmp_path / "model.dwg"
    path.write_bytes(b"AC1032")
    with pytest.raises(MeshError, match=r"model.dwg: .dwg is not read; there are .*obj"):
        read_triangles(path)


def test_the_format_is_found_by_content(tmp_path) -> None:
    for suffix in ("stl", "ply", "off", "glb"):
        path = written(tmp_path, house(), f"house.{suffix}")
        other = path.with_suffix(".mesh" if suffix != "stl" else ".STL")
        path.rename(other)
        assert len(read_triangles(other, "z")) == len(house().faces)


def test_who_stands_inside_a_hollow_wall_is_let_out(tmp_path) -> None:
    rooms = [
        block(0, 0, -0.2, 8, 4, 0),
        block(3.9, 0, 0, 3.92, 4, 2.5),
        block(4.1, 0, 0, 4.12, 4, 2.5),
    ]
    grid = LayeredGrid.from_mesh(written(tmp_path, trimesh.util.concatenate(rooms)), up="z")
    inside = (4.0, 2.0, 0.0)
    for goal in ((1.0, 2.0, 0.0), (7.0, 2.0, 0.0)):
        assert find_path(grid, inside, goal).status is PathStatus.FOUND
        assert find_path(grid, goal, inside, Body.child()).status is PathStatus.FOUND
    beside = (3.75, 2.0, 0.0)
    assert find_path(grid, beside, (7.0, 2.0, 0.0)).status is PathStatus.NO_WAY


def test_an_object_shown_many_times_is_read_as_the_library_places_it(tmp_path: Path) -> None:
    """Turned, stretched, sheared, mirrored and as it is, below nodes that move as well."""
    rng = np.random.default_rng(4)
    scene = trimesh.Scene()
    scene.add_geometry(trimesh.creation.box((1.0, 2.0, 3.0)), geom_name="box", node_name="n0")
    scene.add_geometry(house(), geom_name="house", node_name="house")
    for k in range(1, 40):
        matrix = np.eye(4)
        if k % 4:
            matrix[:3, :3] = rng.normal(size=(3, 3)) if k % 4 > 1 else np.diag([-1.0, 1.0, 1.0])
        matrix[:3, 3] = rng.uniform(-20.0, 20.0, 3)
        above = f"n{k - 1}" if k % 7 == 1 else None
        scene.graph.update(f"n{k}", above, matrix=matrix, geometry="box")
    path = tmp_path / "many.glb"
    path.write_bytes(scene.export(file_type="glb"))
    library = trimesh.load_scene(path, process=False).dump()
    placed = np.concatenate([part.vertices[part.faces] for part in library]).reshape(-1, 9)
    ours = read_triangles(path, up="z").reshape(-1, 9)
    assert len(ours) == len(placed)
    for row in placed[::7]:
        assert np.abs(ours - row).max(axis=1).min() < 1e-4


def test_a_file_beyond_the_bound_is_not_read(tmp_path: Path) -> None:
    path = tmp_path / "huge.obj"
    with path.open("wb") as file:
        file.truncate(2**40)
    with pytest.raises(MeshError, match=r"huge.obj: it has more than 384 MiB"):
        read_mesh(path)


def test_a_comment_may_say_the_unit(tmp_path: Path) -> None:
    square = "v 0 0 0\nv 100 0 0\nv 100 0 -100\nf 1 2 3\n"
    path = tmp_path / "a.obj"
    path.write_text(f"# Exported by a modeller\n# File units = centimeters\n{square}")
    found = read_mesh(path)
    assert np.ptp(found.triangles[..., 0]) == pytest.approx(1.0)
    assert found.told == ("its unit is that of its comment: centimeters",)
    assert np.ptp(read_mesh(path, metres_a_unit=0.1).triangles[..., 0]) == pytest.approx(10.0)
    path.write_text(f"# units: many\n{square}")
    assert np.ptp(read_mesh(path).triangles[..., 0]) == pytest.approx(100.0)


def test_a_mesh_may_be_packed_by_gzip(tmp_path: Path) -> None:
    path = tmp_path / "a.OBJ.gz"
    path.write_bytes(gzip.compress(b"v 0 0 0\nv 10 0 0\nv 10 0 -10\nf 1 2 3\n"))
    assert len(read_mesh(path).triangles) == 1
    path.write_bytes(path.read_bytes()[:-9])
    with pytest.raises(MeshError, match=r"a.OBJ.gz: .* its gzip is damaged"):
        read_mesh(path)
