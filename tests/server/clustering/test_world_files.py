"""The files of a world as they are carried to other machines, and those that cannot be."""

import json
from pathlib import Path

import pytest

from esplanade.planning.scene.world_file import read_world
from esplanade.server.clustering.world_files import WorldFilesError, files_of
from tests.server.worlds import write_mesh_world

GLTF = {
    "asset": {"version": "2.0"},
    "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"uri": "house.bin", "byteLength": 36}],
}


def write_world(folder: Path, mesh: str) -> Path:
    """A world in a folder of its own, with a scene in a folder of scenes."""
    scenes = folder / "village" / "scenes"
    scenes.mkdir(parents=True)
    scene = write_mesh_world(scenes)
    scene.write_text(json.dumps({**json.loads(scene.read_text()), "mesh": mesh}))
    path = folder / "village" / "village.json"
    path.write_text(json.dumps({"zones": [{"name": "house", "scene": "scenes/house.json"}]}))
    return path


def test_scenes_and_meshes_keep_their_places_in_the_folder(tmp_path: Path) -> None:
    path = write_world(tmp_path, "house.obj")
    files = files_of(path, read_world(path))
    assert sorted(files) == ["scenes/house.json", "scenes/house.obj", "village.json"]
    assert files["scenes/house.obj"] == (path.parent / "scenes/house.obj").read_bytes()


def test_a_mesh_elsewhere_is_refused_by_name(tmp_path: Path) -> None:
    path = write_world(tmp_path, "../../other.obj")
    (tmp_path / "other.obj").write_bytes((path.parent / "scenes/house.obj").read_bytes())
    with pytest.raises(WorldFilesError, match=r"zone 'house': .*other.obj is to lie in the folder"):
        files_of(path, read_world(path))


def test_a_mesh_that_needs_other_files_is_refused_by_name(tmp_path: Path) -> None:
    path = write_world(tmp_path, "house.gltf")
    (path.parent / "scenes/house.gltf").write_text(json.dumps(GLTF))
    (path.parent / "scenes/house.bin").write_bytes(bytes(36))
    text = r"zone 'house': house\.gltf cannot be carried along without other files: .*house\.bin"
    with pytest.raises(WorldFilesError, match=text):
        files_of(path, read_world(path))
