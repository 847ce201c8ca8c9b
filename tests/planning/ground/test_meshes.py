"""Floors of meshes: against their naive twin, and what is said of files that hold none."""

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from esplanade.planning import Body, LayeredGrid, PathStatus, find_path
from esplanade.planning.ground.floors import floors_of_mesh
from esplanade.planning.ground.meshes import barriers_of_triangles, surfaces_of_triangles
from esplanade.planning.scene.mesh_file import MeshError, read_triangles
from tests.naive import surfaces as naive
from tests.planning.ground.test_surfaces import ODD_M, columns_of, links_of
from tests.planning.worlds import holds

TOGETHER_M = 0.0101
"""Faces closer together than this are one."""


def block(x0, y0, z0, x1, y1, z1) -> trimesh.Trimesh:
    return trimesh.creation.box(bounds=((x0, y0, z0), (x1, y1, z1)))


def house() -> trimesh.Trimesh:
    """Two floors, 8 m x 6 m, joined by stairs of 15 treads; a wall with a doorway below."""
    rise, tread = 0.18, 0.28
    parts = [
        block(0, 0, -0.2, 8, 6, 0),
        block(0, 0, 2.5, 8, 4, 2.7),
        block(0, 4, 2.5, 1, 6, 2.7),
        block(5.2, 4, 2.5, 8, 6, 2.7),
        block(4.0, 0, 0, 4.15, 1.1, 2.5),
        block(4.0, 2.0, 0, 4.15, 4, 2.5),
    ]
    parts += [
        block(1.0 + k * tread, 4.5, 0, 1.0 + (k + 1) * tread, 5.5, (k + 1) * rise)
        for k in range(15)
    ]
    return trimesh.util.concatenate(parts)


def written(tmp_path, mesh, name="house.obj"):
    path = tmp_path / name
    mesh.export(path)
    return path


@st.composite
def soups(draw) -> np.ndarray:
    """Triangles anyhow, a few of them near to level."""
    east = st.integers(0, 48).map(lambda v: v / 8 + 0.0137)
    north = st.integers(0, 48).map(lambda v: v / 8 + 0.0291)
    heights = st.sampled_from([0.0, 0.1, 0.5, 1.5, 3.0])
    corner = st.tuples(east, north, heights)
    return np.array(draw(st.lists(st.tuples(corner, corner, corner), min_size=1, max_size=8)))


def flat(triangles: np.ndarray) -> bool:
    a, b, c = triangles.transpose(1, 0, 2)
    return bool((np.abs(np.cross(b - a, c - a)[:, 2]) < 1e-3).any())


@holds(60, 5)
@given(soups())
def test_surfaces_are_those_of_the_twin(triangles) -> None:
    if flat(triangles):
        return
    try:
        surfaces = surfaces_of_triangles(triangles, 2.0 * ODD_M)
    except MeshError:
        return
    expected = naive.columns_of_triangles(triangles, surfaces.raster)
    found = columns_of(surfaces)
    for (j, i), column in expected.items():
        cross = ((j, i), (j, i - 1), (j, i + 1), (j - 1, i), (j + 1, i))
        if any(_close_hits(expected.get(cell, [])) for cell in cross):
            continue
        assert [z for z, _ in found[j, i]] == pytest.approx([z for z, _ in column], abs=TOGETHER_M)
    assert links_of(surfaces) == naive.links(found)
    layers = set(zip(surfaces.layers, surfaces.rows, surfaces.columns, strict=True))
    assert len(layers) == len(surfaces)


def _close_hits(column: naive.Column) -> bool:
    return any(ceiling - floor < 1.01 for floor, ceiling in column)


def test_a_house_has_two_floors_and_stairs_between(tmp_path) -> None:
    grid = LayeredGrid.from_mesh(written(tmp_path, house()), up="z")
    for body in (Body.adult(), Body.child()):
        up = find_path(grid, (6.0, 2.0, 0.0), (6.0, 2.0, 2.7), body)
        assert up.status is PathStatus.FOUND
        assert up.points[-1, 2] == pytest.approx(2.7, abs=1e-3)
        assert np.abs(np.diff(up.points[:, 2])).max() <= body.step_on_m
    low = Body(radius_m=0.2, step_on_m=0.15)
    assert find_path(grid, (6.0, 2.0, 0.0), (6.0, 2.0, 2.7), low).status is not PathStatus.FOUND


def test_walls_thinner_than_a_cell_stop_everybody(tmp_path) -> None:
    room = trimesh.util.concatenate([block(0, 0, -0.2, 4, 4, 0), block(2.01, 0, 0, 2.06, 4, 2.5)])
    grid = LayeredGrid.from_mesh(written(tmp_path, room), up="z")
    path = find_path(grid, (1.0, 2.0, 0.0), (3.0, 2.0, 0.0), Body.child())
    assert path.status is not PathStatus.FOUND
    assert not grid.is_free([(2.03, 2.0)], [0], 0.1)[0]


def test_a_doorway_is_as_wide_as_it_is(tmp_path) -> None:
    grid = LayeredGrid.from_mesh(written(tmp_path, house()), up="z")
    rows = grid.barriers
    jambs = rows[
        (rows["bottom_m"] < 1.0) & (rows["top_m"] > 1.5) & (np.abs(rows["x0"] - 4.075) < 0.08)
    ]
    ys = np.sort(np.concatenate([jambs["y0"], jambs["y1"]]))
    assert ys[ys < 1.5].max() == pytest.approx(1.1, abs=1e-6)
    assert ys[ys > 1.5].min() == pytest.approx(2.0, abs=1e-6)


def test_slopes_up_to_45_degrees_carry_and_need_no_steps() -> None:
    for rise, carried in ((0.9, True), (1.1, False)):
        slope = np.array(
            [
                [[0, 0, 0], [4, 0, 4 * rise], [4, 4, 4 * rise]],
                [[0, 0, 0], [4, 4, 4 * rise], [0, 4, 0]],
            ]
        )
        ground = np.array([[[-2, 0, 0], [0, 0, 0], [0, 4, 0]], [[-2, 0, 0], [0, 4, 0], [-2, 4, 0]]])
        triangles = np.concatenate([slope, ground]).astype(float)
        surfaces = surfaces_of_triangles(triangles)
        assert (surfaces.floors.max() > 1.0) == carried
        rows = barriers_of_triangles(triangles, surfaces, surfaces.layered())
        assert (len(rows) == 0) == carried


def test_a_floor_of_two_faces_is_a_floor_and_what_stands_on_one_buries_it() -> None:
    plate = np.array([[[0, 0, 1], [4, 0, 1], [4, 4, 1]], [[0, 0, 1], [4, 4, 1], [0, 4, 1]]], float)
    both = np.concatenate([plate, plate[:, ::-1]])
    assert set(surfaces_of_triangles(both).floors.tolist()) == {1.0}
    standing = np.asarray(block(0, 0, 1, 4, 4, 3).triangles)
    assert set(surfaces_of_triangles(np.concatenate([plate, standing])).floors.tolist()) == {3.0}


@pytest.mark.parametrize("gap_m", [0.05, 0.2, 0.6])
@pytest.mark.parametrize("across", ["east", "north"])
@pytest.mark.parametrize("wall", [False, True])
def test_gaps_between_rooms_are_stepped_across_but_not_through_walls(
    tmp_path, gap_m, across, wall
) -> None:
    """Floors drawn room by room, the gap between them over the centres of cells."""
    edge = 4.125 - 0.5 * gap_m, 4.125 + 0.5 * gap_m
    parts = [block(0, 0, -0.2, edge[0], 4, 0), block(edge[1], 0, -0.2, 8, 4, 0)]
    if wall:
        parts.append(block(*[edge[0], 0, -0.2], *[edge[1], 4, 2.5]))
    rooms = trimesh.util.concatenate(parts)
    if across == "north":
        rooms.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, (0, 0, 1)))
    grid = LayeredGrid.from_mesh(written(tmp_path, rooms), up="z")
    ends = [(1.0, 2.0, 0.0), (7.0, 2.0, 0.0)]
    if across == "north":
        ends = [(-y, x, z) for x, y, z in ends]
    status = find_path(grid, *ends).status
    assert (status is PathStatus.FOUND) == (gap_m < 0.5 and not wall)


def test_spirals_take_a_layer_for_each_turn() -> None:
    treads = []
    for k in range(48):
        a, b = k * np.pi / 8, (k + 1) * np.pi / 8
        p, q = (np.array([np.cos(t), np.sin(t)]) for t in (a, b))
        z = 0.15 * k
        ring = [np.append(v, z) for v in (p, 3 * p, 3 * q, q)]
        treads += [[ring[0], ring[1], ring[2]], [ring[0], ring[2], ring[3]]]
    surfaces = surfaces_of_triangles(np.array(treads))
    assert surfaces.layer_count == 3
    for layer in range(3):
        heights = surfaces.floors[surfaces.layers == layer]
        assert heights.max() - heights.min() == pytest.approx(15 * 0.15, abs=0.31)


def test_every_object_of_a_file_is_put_where_it_belongs(tmp_path) -> None:
    scene = trimesh.Scene()
    slab = block(0, 0, 0, 2, 1, 2)
    scene.add_geometry(slab, transform=trimesh.transformations.translation_matrix((5, 3, -7)))
    turned = trimesh.transformations.rotation_matrix(np.pi / 2, (0, 1, 0))
    scene.add_geometry(slab, transform=turned)
    path = tmp_path / "two.glb"
    scene.export(path)
    triangles = read_triangles(path)
    assert triangles.shape == (24, 3, 3)
    assert triangles.min(axis=(0, 1)) == pytest.approx((0, 0, 0))
    assert triangles.max(axis=(0, 1)) == pytest.approx((7, 7, 4))
    upper = triangles[triangles[..., 2].max(axis=1) > 3.5]
    assert upper.min(axis=(0, 1)) == pytest.approx((5, 5, 3))
    assert upper.max(axis=(0, 1)) == pytest.approx((7, 7, 4))


def test_up_says_which_axis(tmp_path) -> None:
    path = written(tmp_path, block(1, 2, 3, 4, 6, 8))
    assert read_triangles(path, "z").min(axis=(0, 1)) == pytest.approx((1, 2, 3))
    assert read_triangles(path, "y").min(axis=(0, 1)) == pytest.approx((1, -8, 2))


def test_progress_is_told(tmp_path) -> None:
    told: list[tuple[str, float]] = []
    floors_of_mesh(written(tmp_path, house()), up="z", progress=lambda *p: told.append(p))
    shares = [share for _, share in told]
    assert shares == sorted(shares)
    assert (told[0], told[-1]) == (("reading", 0.0), ("done", 1.0))


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("absent.obj", None, "absent.obj: there is no such file"),
        ("empty.obj", "", "empty.obj: it"),
        ("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "points.obj: it"),
        ("range.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 9\n", "range.obj: .* line 4: .* corner 9"),
        ("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 0 1\nf 1 2 3\n", "nan.obj: triangle 0 has a corner"),
        ("huge.obj", "v 0 0 0\nv 9e5 0 0\nv 0 0 1\nf 1 2 3\n", "it measures 900000 x 1 m .* unit"),
        ("wall.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "wall.obj: it has no extent"),
        ("under.obj", "v 0 0 0\nv 4 0 0\nv 0 0 4\nf 1 2 3\n", "under.obj: nobody can stand"),
        ("text.glb", "no mesh at all", "text.glb: it is no glTF that can be read"),
        ("text.xyz9", "no mesh at all", "text.xyz9: .xyz9 is not read; there are"),
    ],
)
def test_faults_of_files_are_named(tmp_path, name, text, message) -> None:
    path = tmp_path / name
    if text is not None:
        path.write_text(text)
    with pytest.raises(MeshError, match=message):
        floors_of_mesh(path)


def test_only_y_and_z_are_up(tmp_path) -> None:
    with pytest.raises(MeshError, match="up must be 'y' or 'z'"):
        read_triangles(written(tmp_path, house()), "x")  # type: ignore[arg-type]
