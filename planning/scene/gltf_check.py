"""Sizes, counts and extensions of a glTF file are checked before its meshes are read."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Final
from urllib.parse import unquote

MAX_FILE_BYTES: Final = 512 * 2**20
MAX_NODES: Final = 20_000
"""Reading the tree of nodes takes some milliseconds for each."""
MAX_TRIANGLES: Final = 5_000_000
"""Most triangles of all nodes together: a mesh counts as often as nodes show it."""

_PACKED: Final = frozenset(
    ("KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_mesh_quantization")
)
"""Extensions of glTF that change where corners are; trimesh knows none of them."""
_GLB_HEADER_BYTES: Final = 20


def check_gltf(path: Path) -> None:
    """Check a glTF or GLB file; files of other kinds are passed over.

    Raises
    ------
    ValueError
        It needs an extension that cannot be read, has too many nodes or triangles, or names a
        buffer that is no file or too large.
    """
    match path.suffix.lower():
        case ".glb":
            with path.open("rb") as file:
                head = file.read(_GLB_HEADER_BYTES)
                text = file.read(min(int.from_bytes(head[12:16], "little"), MAX_FILE_BYTES))
        case ".gltf":
            text = path.read_bytes()
        case _:
            return
    content = json.loads(text)
    packed = _PACKED.intersection(content.get("extensionsRequired", ()))
    if packed:
        raise ValueError(f"save it without {', '.join(sorted(packed))}")
    _check_buffers(path, content)
    nodes = content.get("nodes", ())
    if len(nodes) > MAX_NODES:
        raise ValueError(f"it has {len(nodes)} nodes, {MAX_NODES} are possible")
    triangles = [_triangles(content, mesh) for mesh in content.get("meshes", ())]
    shown = sum(triangles[node["mesh"]] for node in nodes if "mesh" in node)
    if shown > MAX_TRIANGLES:
        raise ValueError(
            f"its nodes show {shown} triangles in all, {MAX_TRIANGLES} are possible: "
            "make simpler meshes of it, or export fewer copies"
        )


def _check_buffers(path: Path, content: Any) -> None:
    total = 0
    for buffer in content.get("buffers", ()):
        address = buffer.get("uri")
        if address is None or address.startswith("data:"):
            continue
        file = path.parent / unquote(address)
        if not file.is_file():
            raise ValueError(f"there is no file {unquote(address)!r} beside it, a buffer of it")
        total += file.stat().st_size
    if total > MAX_FILE_BYTES:
        raise ValueError(f"its buffers have more than {MAX_FILE_BYTES // 2**20} MiB")


def _triangles(content: Any, mesh: Any) -> int:
    """Triangles of a mesh; strips and fans count as one for each corner."""
    accessors = content.get("accessors", ())
    count = 0
    for primitive in mesh.get("primitives", ()):
        place = primitive.get("indices", primitive.get("attributes", {}).get("POSITION"))
        if place is None:
            continue
        corners = int(accessors[place]["count"])
        count += corners // 3 if primitive.get("mode", 4) == 4 else corners
    return count
