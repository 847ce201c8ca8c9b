"""Try an Esplanade that was installed without any extra: `base_check.py SCENE`.

Every command has its help and every reader of meshes reads a file; what needs an extra says which
one, in words and without a traceback.
"""

import contextlib
import io
import json
import struct
import sys
import zipfile
from importlib.util import find_spec
from pathlib import Path
from typing import Final

from esplanade import cli

EXTRAS: Final = (
    *("DracoPy", "ezdxf", "ifcopenshell", "matplotlib", "mcap", "PIL", "shapely", "trimesh"),
)
COMMANDS: Final = (
    *("serve", "run", "replay", "demo", "bots", "evaluate", "scene", "recording", "gait", "op"),
    "completion",
)
SCENE_COMMANDS: Final = ("check", "render", "import", "export", "turn", "schema")

CORNERS: Final = ((0, 0, 0), (6, 0, 0), (6, 0, -5), (0, 0, -5))
OBJ: Final = (
    "\ufeffmtllib absent.mtl\nusemtl brick\n"
    + "".join(f"v\t{x} {y} {z}\n" for x, y, z in CORNERS)
    + "vt 0 0\nf 1/1 2/1 3/1 4/1\n"
)
OFF: Final = "OFF\n4 1 0\n" + "".join(f"{x} {y} {z}\n" for x, y, z in CORNERS) + "4 0 1 2 3\n"
PLY: Final = (
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    + "".join(f"{x} {y} {z}\n" for x, y, z in CORNERS)
    + "4 0 1 2 3\n"
)
MODEL: Final = (
    '<model unit="meter"><resources><object id="1"><mesh><vertices>'
    + "".join(f'<vertex x="{x}" y="{-z}" z="{y}"/>' for x, y, z in CORNERS)
    + '</vertices><triangles><triangle v1="0" v2="1" v3="2"/><triangle v1="0" v2="2" v3="3"/>'
    '</triangles></mesh></object></resources><build><item objectid="1"/></build></model>'
)


def main(scene: Path) -> None:
    """Run all checks; AssertionError where one fails."""
    present = [name for name in EXTRAS if find_spec(name) is not None]
    assert not present, f"this is no base install: it has {present}"
    for command in COMMANDS:
        command_line(command, "--help")
    for command in SCENE_COMMANDS:
        command_line("scene", command, "--help")
    for mesh in write_meshes():
        told = command_line("scene", "import", str(mesh), "--out", f"{mesh.stem}.json", *COARSE)
        assert "30.0 m² of floor" in told, told
        assert "matplotlib" in told, told
    command_line("scene", "check", "off.json", "--cell", "0.5")
    command_line("scene", "turn", str(scene), "--degrees", "30", "--out", "turned.json")
    command_line("scene", "schema", "--out", "schema.json")
    command_line("scene", "export", "off.json", "--out", "off.glb", "--cell", "0.5")
    command_line("scene", "export", "off.json", "--out", "off.yaml", "--cell", "0.5")
    for arguments in (
        ("render", "off.json", "--out", "pictures"),
        ("export", "off.json", "--out", "off.svg", "--cell", "0.5"),
        ("export", "off.json", "--out", "off.wkt", "--cell", "0.5"),
        ("import", write("room.wkt", "POLYGON ((0 0, 9 0, 9 9, 0 0))"), "--out", "room.json"),
        ("import", write("draco.gltf", packed_gltf()), "--out", "draco.json"),
        ("import", write("house.ifc", "ISO-10303-21;"), "--out", "house.json"),
    ):
        told = command_line("scene", *arguments, status=2)
        assert "pip install" in told, told
    told = command_line("replay", write("world.mcap", ""), status=1)
    assert "install esplanade[record]" in told, told
    print("a base install runs every command, reads every mesh, and names the extras it lacks")


COARSE: Final = ("--cell", "0.5", "--places", "1")


def write_meshes() -> list[Path]:
    """The same floor of 30 m² in every format."""
    Path("obj.obj").write_text(OBJ, encoding="utf-8")
    Path("off.off").write_text(OFF, encoding="utf-8")
    Path("ply.ply").write_text(PLY, encoding="utf-8")
    with zipfile.ZipFile("threemf.3mf", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("3D/3dmodel.model", MODEL)
    triangles = ((0, 1, 2), (0, 2, 3))
    rows = b"".join(
        struct.pack("<12fH", 0, 0, 0, *(c for k in t for c in z_up(CORNERS[k])), 0)
        for t in triangles
    )
    Path("stl.stl").write_bytes(b"floor".ljust(80) + struct.pack("<I", 2) + rows)
    floor = b"".join(struct.pack("<3f", *CORNERS[k]) for t in triangles for k in t)
    Path("floor data.bin").write_bytes(floor)
    Path("gltf.gltf").write_text(gltf({}), encoding="utf-8")
    return [Path(name) for name in ("obj.obj", "off.off", "ply.ply", "threemf.3mf", "stl.stl")] + [
        Path("gltf.gltf")
    ]


def z_up(corner: tuple[int, int, int]) -> tuple[int, int, int]:
    x, y, z = corner
    return x, -z, y


def gltf(extensions: dict[str, object]) -> str:
    """A glTF file of one mesh whose buffer is `floor data.bin`."""
    accessor = {"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3"}
    primitive = {"attributes": {"POSITION": 0}, "extensions": extensions}
    return json.dumps(
        {
            "asset": {"version": "2.0"},
            "extensionsRequired": list(extensions),
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [primitive]}],
            "accessors": [accessor],
            "bufferViews": [{"buffer": 0, "byteLength": 72}],
            "buffers": [{"uri": "floor%20data.bin", "byteLength": 72}],
        }
    )


def packed_gltf() -> str:
    return gltf({"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {}}})


def write(name: str, text: str) -> str:
    Path(name).write_text(text, encoding="utf-8")
    return name


def command_line(*arguments: str, status: int = 0) -> str:
    """Run a command in this process, which imports everything once; returns what it said."""
    said = io.StringIO()
    code: object = 0
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        try:
            code = cli.main(list(arguments))
        except SystemExit as end:  # the parser of options raises this
            code = end.code or 0
    told = said.getvalue()
    assert code == status, f"esplanade {' '.join(arguments)}: {code}: {told}"
    return told


if __name__ == "__main__":
    main(Path(sys.argv[1]))
