"""glTF by its specification: extensions, names, instances, strips, sparse and packed arrays."""

import base64
import json
import sys
from pathlib import Path
from typing import Any
from urllib.parse import quote

import numpy as np
import pytest

from esplanade.planning.scene.formats import gltf
from esplanade.planning.scene.formats.gltf import read_gltf
from tests.planning.scene.formats.test_faces import area

SQUARE = np.array([(-5, 0, -5), (5, 0, -5), (5, 0, 5), (-5, 0, 5)], dtype="<f4")
FACES = np.array([0, 2, 1, 0, 3, 2], dtype="<u2")


class Made:
    """A glTF file in the making, with one square floor of 100 m²."""

    def __init__(self) -> None:
        self.data = b""
        self.content: dict[str, Any] = {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "accessors": [],
            "bufferViews": [],
        }
        primitive = {"attributes": {"POSITION": self.add(SQUARE)}, "indices": self.add(FACES)}
        self.content["meshes"] = [{"primitives": [primitive]}]

    @property
    def primitive(self) -> dict[str, Any]:
        found: dict[str, Any] = self.content["meshes"][0]["primitives"][0]
        return found

    def add_view(self, data: bytes, **more: Any) -> int:
        self.data += b"\0" * (-len(self.data) % 4)
        place = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)}
        self.content["bufferViews"].append({**place, **more})
        self.data += data
        return len(self.content["bufferViews"]) - 1

    def add(self, values: np.ndarray, **more: Any) -> int:
        kinds = {"<f4": 5126, "<u2": 5123, "<i2": 5122, "|i1": 5120}
        accessor = {
            "bufferView": self.add_view(values.tobytes()),
            "componentType": kinds[values.dtype.str],
            "count": len(values),
            "type": "SCALAR" if values.ndim == 1 else f"VEC{values.shape[1]}",
        }
        self.content["accessors"].append({**accessor, **more})
        return len(self.content["accessors"]) - 1

    def read(self, folder: Path, uri: str | None = None) -> Any:
        address = (
            uri or "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
        )
        self.content["buffers"] = [{"uri": address, "byteLength": len(self.data)}]
        return read_gltf(folder / "floor.gltf", json.dumps(self.content).encode())


def test_a_floor_is_read(tmp_path: Path) -> None:
    assert area(Made().read(tmp_path).points) == pytest.approx(100.0)


@pytest.mark.parametrize(
    "name",
    ["floor data.bin", "étage.bin", "a#b?c.bin", "50%.bin", "sub folder/x.bin", "a%20b.bin"],
)
def test_names_of_buffers_are_percent_decoded(tmp_path: Path, name: str) -> None:
    made = Made()
    (tmp_path / name).parent.mkdir(exist_ok=True)
    (tmp_path / name).write_bytes(made.data)
    assert area(made.read(tmp_path, quote(name)).points) == pytest.approx(100.0)
    if name != "a%20b.bin":
        assert area(made.read(tmp_path, name).points) == pytest.approx(100.0)


@pytest.mark.parametrize("uri", ["/dev/zero", "absent%20here.bin", "https://example.org/a.bin"])
def test_buffers_that_are_no_files_are_refused(tmp_path: Path, uri: str) -> None:
    with pytest.raises(ValueError, match="there is no file"):
        Made().read(tmp_path, uri)


@pytest.mark.parametrize(
    "name", ["KHR_texture_transform", "KHR_materials_unlit", "OMI_physics_shape", "MSFT_lod"]
)
@pytest.mark.parametrize("key", ["extensionsUsed", "extensionsRequired"])
def test_extensions_of_looks_are_passed_over(tmp_path: Path, name: str, key: str) -> None:
    made = Made()
    made.content[key] = [name]
    found = made.read(tmp_path)
    assert area(found.points) == pytest.approx(100.0)
    assert not found.passed


def test_a_required_extension_that_is_unknown_is_refused_by_name(tmp_path: Path) -> None:
    made = Made()
    made.content["extensionsRequired"] = ["ACME_wonder"]
    with pytest.raises(ValueError, match="it requires ACME_wonder, unknown here"):
        made.read(tmp_path)


@pytest.mark.parametrize("name", ["ACME_mesh_fold", "EXT_implicit_geometry", "KHR_node_visibility"])
def test_one_that_changes_geometry_is_refused_even_when_only_used(
    tmp_path: Path, name: str
) -> None:
    for place in ("used", "at the node"):
        made = Made()
        if place == "used":
            made.content["extensionsUsed"] = [name]
        else:
            made.content["nodes"][0]["extensions"] = {name: {}}
        with pytest.raises(ValueError, match=f"it uses {name}, which changes its geometry"):
            made.read(tmp_path)


def test_one_that_is_only_used_and_unknown_is_told(tmp_path: Path) -> None:
    made = Made()
    made.content["extensionsUsed"] = ["ACME_notes"]
    found = made.read(tmp_path)
    assert dict(found.passed) == {"uses of ACME_notes": 1}


def test_instances_are_moved_turned_and_stretched(tmp_path: Path) -> None:
    made = Made()
    moves = np.array([(0, 0, 0), (0, 3, 0), (0, 6, 0)], dtype="<f4")
    turns = np.array([(0, 0, 0, 127), (0, 127, 0, 0), (90, 0, 0, 90)], dtype="i1")
    sizes = np.array([(1, 1, 1), (2, 1, 1), (1, 1, -1)], dtype="<f4")
    attributes = {
        "TRANSLATION": made.add(moves),
        "ROTATION": made.add(turns, normalized=True),
        "SCALE": made.add(sizes),
    }
    node = made.content["nodes"][0]
    node["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": attributes}}
    node["translation"] = [0.0, 1.0, 0.0]
    made.content["extensionsUsed"] = ["EXT_mesh_gpu_instancing"]
    points = made.read(tmp_path).points
    assert len(points) == 6
    assert area(points) == pytest.approx(400.0)
    assert points[:4, :, 1].reshape(-1).tolist() == pytest.approx([1.0] * 6 + [4.0] * 6)
    upright = points[4:]
    assert np.ptp(upright[..., 2]) == pytest.approx(0.0, abs=1e-5)


def test_quantised_positions_are_read(tmp_path: Path) -> None:
    made = Made()
    made.content["extensionsRequired"] = ["KHR_mesh_quantization"]
    made.primitive["attributes"]["POSITION"] = made.add(
        (SQUARE / 5 * 32767).astype("<i2"), normalized=True
    )
    made.content["nodes"][0]["scale"] = [5.0, 1.0, 5.0]
    assert area(made.read(tmp_path).points) == pytest.approx(100.0)


def test_strips_fans_and_corners_in_order_are_read(tmp_path: Path) -> None:
    for mode, order in ((5, [0, 3, 1, 2]), (6, [0, 3, 2, 1]), (4, [0, 2, 1, 0, 3, 2])):
        made = Made()
        made.primitive["mode"] = mode
        del made.primitive["indices"]
        made.primitive["attributes"]["POSITION"] = made.add(SQUARE[order])
        points = made.read(tmp_path).points
        assert area(points) == pytest.approx(100.0)
        normals = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
        assert (normals[:, 1] > 0.0).all()


def test_sparse_and_strided_positions_are_read(tmp_path: Path) -> None:
    made = Made()
    spread = np.zeros((4, 5), dtype="<f4")
    spread[:, :3] = SQUARE
    spread[2] = 0.0
    position = made.add(np.zeros((4, 3), dtype="<f4"))
    accessor = made.content["accessors"][position]
    accessor["bufferView"] = made.add_view(spread.tobytes(), byteStride=20)
    places = made.add_view(np.array([2], dtype="<u2").tobytes())
    accessor["sparse"] = {
        "count": 1,
        "indices": {"bufferView": places, "componentType": 5123},
        "values": {"bufferView": made.add_view(SQUARE[2:3].tobytes())},
    }
    made.primitive["attributes"]["POSITION"] = position
    assert area(made.read(tmp_path).points) == pytest.approx(100.0)


def test_morph_targets_count_by_their_weights(tmp_path: Path) -> None:
    made = Made()
    made.primitive["targets"] = [{"POSITION": made.add(SQUARE)}]
    made.content["meshes"][0]["weights"] = [1.0]
    assert area(made.read(tmp_path).points) == pytest.approx(400.0)


def test_only_the_default_scene_is_shown(tmp_path: Path) -> None:
    made = Made()
    made.content["nodes"].append({"mesh": 0, "translation": [50.0, 0.0, 0.0]})
    assert area(made.read(tmp_path).points) == pytest.approx(100.0)
    made.content["scenes"].append({"nodes": [0, 1]})
    made.content["scene"] = 1
    assert area(made.read(tmp_path).points) == pytest.approx(200.0)


def test_draco_is_unpacked_by_its_library(tmp_path: Path) -> None:
    draco = pytest.importorskip("DracoPy")
    made = Made()
    data = draco.encode(SQUARE, FACES.reshape(-1, 3).astype(np.uint32), quantization_bits=16)
    view = made.add_view(data)
    for part in made.content["accessors"]:
        del part["bufferView"]
    made.primitive["extensions"] = {
        "KHR_draco_mesh_compression": {"bufferView": view, "attributes": {"POSITION": 0}}
    }
    made.content["extensionsRequired"] = ["KHR_draco_mesh_compression"]
    assert area(made.read(tmp_path).points) == pytest.approx(100.0, rel=1e-3)


def test_meshopt_is_unpacked_by_its_library(tmp_path: Path) -> None:
    meshopt = pytest.importorskip("meshoptimizer")
    made = Made()
    packed = (
        (0, meshopt.encode_vertex_buffer(SQUARE, 4, 12), "ATTRIBUTES", 4, 12),
        (1, meshopt.encode_index_buffer(FACES.astype(np.uint32), 6, 4), "TRIANGLES", 6, 2),
    )
    for view, data, mode, count, stride in packed:
        place = dict(made.content["bufferViews"][made.add_view(bytes(data))])
        described = {**place, "mode": mode, "count": count, "byteStride": stride}
        made.content["bufferViews"][view]["extensions"] = {"EXT_meshopt_compression": described}
    made.content["extensionsRequired"] = ["EXT_meshopt_compression"]
    assert area(made.read(tmp_path).points) == pytest.approx(100.0)


def test_what_is_only_packed_beside_plain_arrays_needs_no_library(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "DracoPy", None)
    monkeypatch.setitem(sys.modules, "meshoptimizer", None)
    made = Made()
    packed = made.add_view(b"not needed")
    made.primitive["extensions"] = {"KHR_draco_mesh_compression": {"bufferView": packed}}
    made.content["bufferViews"][0]["extensions"] = {"EXT_meshopt_compression": {"buffer": 0}}
    made.content["extensionsUsed"] = ["KHR_draco_mesh_compression", "EXT_meshopt_compression"]
    assert area(made.read(tmp_path).points) == pytest.approx(100.0)


def test_without_its_library_a_packed_mesh_is_refused_by_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "DracoPy", None)
    made = Made()
    made.primitive["extensions"] = {"KHR_draco_mesh_compression": {"bufferView": 0}}
    made.content["extensionsRequired"] = ["KHR_draco_mesh_compression"]
    with pytest.raises(ValueError, match=r"KHR_draco.* needs DracoPy: pip install .*\[meshes\]"):
        made.read(tmp_path)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"asset": {"version": "1.0"}}, "glTF 1.0; glTF 2.0 is read"),
        ({"nodes": [{}] * 20_001}, "20001 nodes, 20000 are possible"),
        ({"nodes": [{"children": [0]}]}, "below itself"),
        ({"nodes": [{"mesh": 7}]}, "names meshes 7"),
        ({"nodes": [{"mesh": 0, "matrix": [1]}]}, "16 numbers are expected"),
    ],
)
def test_what_is_no_gltf_is_refused(tmp_path: Path, change: Any, message: str) -> None:
    made = Made()
    made.content.update(change)
    with pytest.raises(ValueError, match=message):
        made.read(tmp_path)


def test_packed_meshes_are_counted_as_they_are(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = Made()
    made.content["accessors"][1]["count"] = 3  # one triangle is declared, two are packed
    made.primitive["extensions"] = {"KHR_draco_mesh_compression": {"bufferView": 0}}
    made.content["extensionsRequired"] = ["KHR_draco_mesh_compression"]
    made.content["nodes"] = [{"mesh": 0}] * 2
    made.content["scenes"] = []
    unpacked = SQUARE.astype(np.float64), FACES.astype(np.int64).reshape(-1, 3)
    monkeypatch.setattr(gltf, "unpacked_draco", lambda _: unpacked)
    monkeypatch.setattr(gltf, "MAX_TRIANGLES", 4)
    assert len(made.read(tmp_path).points) == 4
    monkeypatch.setattr(gltf, "MAX_TRIANGLES", 3)
    with pytest.raises(ValueError, match="show 4 triangles in all, 3 are possible"):
        made.read(tmp_path)


def test_counts_are_checked_before_anything_is_read(tmp_path: Path) -> None:
    made = Made()
    made.content["accessors"][1]["count"] = 3_000
    made.content["nodes"] = [{"mesh": 0}] * 5_001
    made.content["scenes"] = []
    with pytest.raises(ValueError, match="show 5001000 triangles in all, 5000000 are possible"):
        made.read(tmp_path)
    deep = b'{"asset": ' + b"[" * 100_000
    with pytest.raises(ValueError, match="too deep"):
        read_gltf(tmp_path / "deep.gltf", deep)
    with pytest.raises(ValueError, match="more than 3000000 values"):
        read_gltf(tmp_path / "wide.gltf", b'{"asset": [' + b"0," * 3_000_001)
