"""Sizes and counts of glTF files are checked before their meshes are read."""

import json
from pathlib import Path
from typing import Any

import pytest

from esplanade.planning.scene.gltf_check import check_gltf

MESH = {"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}


def write(folder: Path, **content: Any) -> Path:
    path = folder / "house.gltf"
    path.write_text(json.dumps(content))
    return path


def test_nodes_are_bounded(tmp_path: Path) -> None:
    check_gltf(write(tmp_path, nodes=[{}] * 20_000))
    with pytest.raises(ValueError, match="it has 20001 nodes, 20000 are possible"):
        check_gltf(write(tmp_path, nodes=[{}] * 20_001))


def test_triangles_count_as_often_as_they_are_shown(tmp_path: Path) -> None:
    accessors = [{"count": 9}, {"count": 3_000}]
    parts: dict[str, Any] = {"accessors": accessors, "meshes": [MESH]}
    check_gltf(write(tmp_path, nodes=[{"mesh": 0}] * 5_000, **parts))
    with pytest.raises(ValueError, match="show 5001000 triangles in all, 5000000 are possible"):
        check_gltf(write(tmp_path, nodes=[{"mesh": 0}] * 5_001, **parts))


def test_buffers_are_files(tmp_path: Path) -> None:
    (tmp_path / "floor data.bin").write_bytes(b"0")
    check_gltf(write(tmp_path, buffers=[{"uri": "floor%20data.bin"}]))
    for uri in ("/dev/zero", "absent.bin"):
        with pytest.raises(ValueError, match="there is no file"):
            check_gltf(write(tmp_path, buffers=[{"uri": uri}]))
