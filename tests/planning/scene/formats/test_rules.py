"""Things that must not be passed over in silence: extensions, units, parts of archives."""

import io
import json
import zipfile
from pathlib import Path

import numpy as np
import pytest

from esplanade.planning.scene.mesh_file import MeshError, read_mesh

SQUARE = (
    '<mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="10" y="0" z="0"/>'
    '<vertex x="10" y="10" z="0"/><vertex x="0" y="10" z="0"/></vertices><triangles>'
    '<triangle v1="0" v2="1" v3="2"/><triangle v1="0" v2="2" v3="3"/></triangles>{}</mesh>'
)
RELATIONS = (
    '<Relationships><Relationship Target="/3D/main.model" Type="http://a/3dmodel"/></Relationships>'
)


def archive(parts: dict[str, str]) -> bytes:
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as made:
        for name, content in parts.items():
            made.writestr(name, content)
    return file.getvalue()


def model(attributes: str = "", lattice: str = "", items: str = '<item objectid="1"/>') -> str:
    return (
        f'<model unit="meter" {attributes}><resources><object id="1">{SQUARE.format(lattice)}'
        f"</object></resources><build>{items}</build></model>"
    )


def area(path: Path, content: bytes | str) -> float:
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    corners = read_mesh(path).triangles
    sides = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return float(0.5 * np.linalg.norm(sides, axis=1).sum())


def test_only_the_model_that_the_archive_names_is_built(tmp_path: Path) -> None:
    parts = {"_rels/.rels": RELATIONS, "3D/a.model": model(), "3D/main.model": model()}
    assert area(tmp_path / "a.3mf", archive(parts)) == pytest.approx(100.0)


def test_a_required_extension_of_3mf_is_refused_by_name(tmp_path: Path) -> None:
    volumes = 'xmlns:v="http://schemas.3mf.io/volumetric/2022/01" requiredextensions="v"'
    with pytest.raises(MeshError, match=r"requires the extension .*volumetric"):
        area(tmp_path / "a.3mf", archive({"a.model": model(volumes)}))
    production = 'xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06" '
    known = archive({"a.model": model(f'{production} requiredextensions="p"')})
    assert area(tmp_path / "a.3mf", known) == pytest.approx(100.0)


def test_lattices_and_items_that_are_not_built_are_counted(tmp_path: Path) -> None:
    lattice = '<b:beamlattice><b:beams><b:beam v1="0" v2="1"/></b:beams></b:beamlattice>'
    items = '<item objectid="1"/><item objectid="1" printable="0"/>'
    path = tmp_path / "a.3mf"
    assert area(path, archive({"a.model": model("", lattice, items)})) == pytest.approx(100.0)
    assert read_mesh(path).passed == {
        "beams of lattices": 1,
        "items that are not to be built": 1,
    }


def test_a_newer_gltf_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.gltf"
    path.write_text(json.dumps({"asset": {"version": "2.0", "minVersion": "2.2"}}))
    with pytest.raises(MeshError, match=r"needs a reader of glTF '2\.2'"):
        read_mesh(path)


OBJ = "v 0 0 0\nv 10 0 0\nv 10 0 -10\nv 0 0 -10\nf 1 2 3 4\n"
PLY = (
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n10 0 0\n10 0 -10\n0 0 -10\n4 0 1 2 3\n"
)


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("filled.obj", OBJ.encode() + bytes(20)),
        ("joined.obj", b"\xef\xbb\xbf\xef\xbb\xbf" + OBJ.encode()),
        ("marked.ply", b"\xef\xbb\xbf" + PLY.encode()),
        ("dos.ply", PLY.replace("\n", "\r\n").encode()),
    ],
)
def test_marks_and_fillings_change_nothing(tmp_path: Path, name: str, content: bytes) -> None:
    assert area(tmp_path / name, content) == pytest.approx(100.0)


def test_bytes_that_begin_with_solid_and_end_in_more_are_no_text(tmp_path: Path) -> None:
    row = np.zeros(1, dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
    row["corners"] = [[0, 0, 0], [10, 0, 0], [0, 10, 0]]
    content = b"solid of bytes".ljust(80, b"\0") + (1).to_bytes(4, "little") + row.tobytes()
    assert area(tmp_path / "a.stl", content + b"\n") == pytest.approx(50.0)
