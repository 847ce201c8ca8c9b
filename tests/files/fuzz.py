"""Mutated files of every form: `python -m tests.files.fuzz --count 100000` (make fuzz-files).

Recordings, meshes and plans. Whatever is done to a file, reading it ends soon: in what it holds, or
in the error of its reader. What is accepted is held against checks of its own.
"""

import argparse
import gzip
import io
import json
import random
import struct
import sys
import tempfile
import time
import zipfile
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from esplanade.commandline.errors import UsageError
from esplanade.planning.scene.mesh_file import MeshError, read_mesh
from esplanade.recordings import large_tables
from esplanade.scenery.plans.reading import read_plan
from esplanade.scenery.plans.scene_of_plan import scene_of_plan
from tests.planning.scene.formats.test_ifc import house
from tests.recordings.forms import FORMS, Form, parquet, walk
from tests.recordings.fuzz import SOON_S, mutated, tried

CORNERS = np.array([(0, 0, 0), (10, 0, 0), (10, 0, -10), (0, 0, -10)], "<f4")
FACE = "4 0 1 2 3\n"
PLY = (
    "ply\nformat {} 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
)
POINTS = "".join("{:g} {:g} {:g}\n".format(*corner) for corner in CORNERS.tolist())
JUPEDSIM = (
    '<geometry version="0.8" unit="m"><rooms><room id="0"><subroom id="0"><polygon>'
    '<vertex px="10" py="3"/><vertex px="10" py="0"/><vertex px="0" py="0"/></polygon></subroom>'
    '</room></rooms><transitions><transition id="3"><vertex px="10" py="3"/>'
    '<vertex px="10" py="5"/></transition></transitions></geometry>'
)
WKT_PARTS = "POLYGON ((0 0, 20 0, 20 10, 0 10)), LINESTRING Z (10 0 1, 10 4 1), POINT EMPTY"
AS_LARGE = 0.2
"""The share of recordings that are read as large ones are."""
MESHOPT = "EXT_meshopt_compression"
DRACO = "KHR_draco_mesh_compression"
ROS = "image: map.pgm\nresolution: 0.05\norigin: [-3.0, 2.0, 0.5]\nnegate: 0\n"


class Shape(NamedTuple):
    """A file of a mesh or a plan, and what reads it."""

    name: str
    content: bytes
    read: Callable[[Path], object]


def gltf(binary: bool) -> bytes:
    data = CORNERS.tobytes() + struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    content: dict[str, object] = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "translation": [1, 0, 0], "scale": [1, 2, 1]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 12},
        ],
    }
    return text_or_glb(content, data, binary)


def text_or_glb(content: dict[str, object], data: bytes, binary: bool) -> bytes:
    """The bytes of a glTF file with one buffer."""
    content["buffers"] = [{"byteLength": len(data)}]
    if not binary:
        uri = "data:," + "".join(f"%{b:02x}" for b in data)
        content["buffers"] = [{"byteLength": len(data), "uri": uri}]
        return json.dumps(content).encode()
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    data += bytes(-len(data) % 4)
    body = struct.pack("<I4s", len(text), b"JSON") + text
    body += struct.pack("<I4s", len(data), b"BIN\0") + data
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


def meshopt() -> bytes:
    """GLB whose corners and faces meshopt packed."""
    import meshoptimizer

    faces = np.array([0, 1, 2, 0, 2, 3], np.uint32)
    parts = (
        (bytes(meshoptimizer.encode_vertex_buffer(CORNERS, 4, 12)), "ATTRIBUTES", 4, 12),
        (bytes(meshoptimizer.encode_index_buffer(faces, 6, 4)), "TRIANGLES", 6, 2),
    )
    data, views = b"", []
    for packed, mode, count, stride in parts:
        place = {"buffer": 0, "byteOffset": len(data), "byteLength": len(packed)}
        how = {**place, "mode": mode, "count": count, "byteStride": stride}
        views.append({"buffer": 0, "byteLength": count * stride, "extensions": {MESHOPT: how}})
        data += packed + bytes(-len(packed) % 4)
    content = json.loads(gltf(False))
    content |= {"bufferViews": views, "extensionsUsed": [MESHOPT], "extensionsRequired": [MESHOPT]}
    return text_or_glb(content, data, True)


def draco() -> bytes:
    """GLB whose mesh Draco packed."""
    import DracoPy

    data = DracoPy.encode(CORNERS, np.array([[0, 1, 2], [0, 2, 3]], np.uint32))
    content = json.loads(gltf(False))
    for accessor in content["accessors"]:
        del accessor["bufferView"]
    packed = {DRACO: {"bufferView": 0, "attributes": {"POSITION": 0}}}
    content["meshes"][0]["primitives"][0]["extensions"] = packed
    content["bufferViews"] = [{"buffer": 0, "byteLength": len(data)}]
    content |= {"extensionsUsed": [DRACO], "extensionsRequired": [DRACO]}
    return text_or_glb(content, data, True)


def ifc() -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "house.ifc")
        house(path, "METERS")
        return path.read_bytes()


def threemf() -> bytes:
    vertices = "".join(f'<vertex x="{x}" y="{-z}" z="0"/>' for x, _, z in CORNERS.tolist())
    mesh = f'<mesh><vertices>{vertices}</vertices><triangles><triangle v1="0" v2="1" v3="2"/>'
    model = (
        f'<model unit="meter"><resources><object id="1">{mesh}</triangles></mesh></object>'
        '</resources><build><item objectid="1" transform="1 0 0 0 1 0 0 0 1 5 0 0"/></build>'
        "</model>"
    )
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("3D/3dmodel.model", model)
    return file.getvalue()


def stl() -> bytes:
    corners = np.zeros(2, [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
    corners["corners"] = np.array(CORNERS)[[[0, 1, 2], [0, 2, 3]]][..., [0, 2, 1]]
    return bytes(80) + struct.pack("<I", 2) + corners.tobytes()


def binary_dxf() -> bytes:
    import ezdxf

    drawing = ezdxf.new("R2000")  # type: ignore[attr-defined]
    drawing.modelspace().add_line((0, 0), (10, 5))
    file = io.BytesIO()
    drawing.write(file, fmt="bin")
    return file.getvalue()


def dxf() -> bytes:
    import ezdxf

    drawing = ezdxf.new("R12")  # type: ignore[attr-defined]
    space = drawing.modelspace()
    space.add_line((0, 0), (10, 0))
    space.add_arc((5, 5), 2, 0, 90, dxfattribs={"layer": "DOOR"})
    text = io.StringIO()
    drawing.write(text)
    return text.getvalue().encode()


def hdf5() -> bytes:
    import h5py

    rows = np.array([(w, n, x, y) for n, w, x, y in walk(0.04)], [("id", "i8"), ("frame", "i8"), ("x", "f8"), ("y", "f8")])  # fmt: skip  # noqa: E501
    file = io.BytesIO()
    with h5py.File(file, "w") as made:
        made["trajectory"] = rows
        made["trajectory"].attrs["fps"] = 25.0
    return file.getvalue()


def mesh_of(path: Path) -> object:
    corners = read_mesh(path).triangles
    assert np.isfinite(corners).all()
    assert len(corners)
    assert np.ptp(corners.reshape(-1, 3), axis=0).max() < 1e4
    return corners


def plan_of(path: Path) -> object:
    storey = read_plan(path)
    assert np.isfinite(storey.bounds()).all()
    return scene_of_plan([storey], "fuzzed", recentre=True)


def columnar() -> dict[str, Form]:
    """Recordings in files of numbers, whose libraries are of an extra."""
    return {
        "parquet": Form("a.parquet", parquet()),
        "hdf5": Form("a.h5", hdf5(), 0.04),
    }


def shapes() -> dict[str, Shape]:
    """A small file of each form of a mesh or plan."""
    ring = [[0, 0], [20, 0], [20, 10], [0, 10], [0, 0]]
    features = [
        {"type": "Feature", "properties": properties, "geometry": {"type": kind, "coordinates": at}}
        for kind, at, properties in (
            ("Polygon", [ring], {}),
            ("LineString", [[10, 4], [10, 6]], {"kind": "door", "name": "gate"}),
            ("LineString", [[4, 4], [12, 4]], {"kind": "stairs", "width_m": 2}),
        )
    ]
    text_of_stl = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 9 0 0\nvertex 9 9 0\nendloop\nendfacet\nendsolid\n"  # noqa: E501
    vertices = "".join(f"v {line}\n" for line in POINTS.splitlines())
    wkt = "POLYGON ((0 0, 20 0, 20 10, 0 10, 0 0), (4 4, 6 4, 6 6, 4 4))\nLINESTRING (10 0, 10 4)\n"
    found = [
        Shape("a.obj", f"{vertices}f 1 2 3 4\nf -4/1 -3//2 -1\n".encode(), mesh_of),
        Shape("a.off", f"OFF\n4 1 0\n{POINTS}{FACE}".encode(), mesh_of),
        Shape("text.ply", (PLY.format("ascii") + POINTS + FACE).encode(), mesh_of),
        Shape(
            "bytes.ply",
            PLY.format("binary_little_endian").encode()
            + CORNERS.tobytes() + struct.pack("<B4i", 4, 0, 1, 2, 3),
            mesh_of,
        ),
        Shape("bytes.stl", stl(), mesh_of),
        Shape("text.stl", text_of_stl.encode(), mesh_of),
        Shape("a.gltf", gltf(False), mesh_of),
        Shape("a.glb", gltf(True), mesh_of),
        Shape("a.3mf", threemf(), mesh_of),
        Shape("a.wkt", wkt.encode(), plan_of),
        Shape("a.geojson", json.dumps({"type": "FeatureCollection", "features": features}).encode(), plan_of),  # noqa: E501
        Shape("a.xml", JUPEDSIM.encode(), plan_of),
        Shape("a.yaml", ROS.encode(), plan_of),
        Shape("a.dxf", dxf(), plan_of),
        Shape("bytes.dxf", binary_dxf(), plan_of),
        Shape("collection.wkt", f"GEOMETRYCOLLECTION ({WKT_PARTS})".encode(), plan_of),
        Shape("raw.yaml", f"{ROS}mode: raw\n".encode(), plan_of),
        Shape("a.wkt.gz", gzip.compress(wkt.encode()), plan_of),
    ]  # fmt: skip
    return {shape.name: shape for shape in found}


def packed() -> dict[str, Shape]:
    """Meshes whose libraries are of extras."""
    made = {"meshopt.glb": meshopt(), "draco.glb": draco(), "a.ifc": ifc()}
    return {name: Shape(name, content, mesh_of) for name, content in made.items()}


def tried_shape(path: Path, shape: Shape, content: bytes) -> str:
    """How reading went: accepted, refused.

    Raises
    ------
    AssertionError
        It took too long, or something was accepted that should not be.
    """
    path.write_bytes(content)
    began = time.process_time()
    try:
        shape.read(path)
    except (MeshError, UsageError) as error:
        outcome, said = "refused", str(error)
    else:
        outcome, said = "accepted", ""
    took_s = time.process_time() - began
    assert took_s < SOON_S, f"{took_s:.1f} s"
    assert len(said) < 1500, said[:2000]
    return outcome


def main() -> int:
    """Try so many files of all forms, and say how it went."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    recordings = FORMS | columnar()
    others = shapes() | packed()
    # A building takes a process of its own.
    names = [name for name in (*recordings, *others) for _ in range(1 if name == "a.ifc" else 5)]
    outcomes: Counter[str] = Counter()
    usual = large_tables.LARGE_BYTES
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "map.pgm").write_bytes(b"P5 20 10 255\n" + bytes([254] * 150 + [0] * 50))
        for number in range(options.count):
            chance = random.Random(f"{options.seed}:{number}")
            name = chance.choice(names)
            kept = recordings[name] if name in recordings else others[name]
            content = mutated(kept.content, chance)
            as_large = chance.random() < AS_LARGE
            large_tables.LARGE_BYTES = 0 if as_large else usual  # type: ignore[misc]
            if number % 10_000 == 9_999:
                sys.stderr.write(f"{number + 1} files: {dict(outcomes)}\n")
            try:
                if isinstance(kept, Form):
                    outcomes[tried(Path(folder, kept.name), kept, content)] += 1
                else:
                    outcomes[tried_shape(Path(folder, kept.name), kept, content)] += 1
            except BaseException:
                found = Path(tempfile.gettempdir(), f"fuzzed-{options.seed}-{number}-{kept.name}")
                found.write_bytes(content)
                sys.stderr.write(f"file {number} of seed {options.seed}, kept as {found}:\n")
                raise
    sys.stdout.write(f"{options.count} files: {dict(outcomes)}\n")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
