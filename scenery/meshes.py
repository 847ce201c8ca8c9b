"""Meshes written as GLB, the form that server and browser read."""

import json
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

_MAGIC: Final = b"glTF"
_JSON, _BIN = 0x4E4F534A, 0x004E4942
_FLOAT, _ARRAY_BUFFER = 5126, 34962


def as_glb(parts: dict[str, NDArray[np.float64]]) -> bytes:
    """GLB, y up and in metres, with a node for each named part.

    Each part is triangles, float64 (T, 3, 3), metres, z up. Corners are written as float32 beside
    whole metres that move the node, so that far from the origin they are as exact as near it.
    """
    content: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": "Esplanade"},
        "scene": 0,
        "scenes": [{"nodes": []}],
        "nodes": [],
        "meshes": [],
        "accessors": [],
        "bufferViews": [],
    }
    chunks: list[bytes] = []
    for name, triangles in parts.items():
        if not len(triangles):
            continue
        corners = np.stack([triangles[..., 0], triangles[..., 2], -triangles[..., 1]], axis=-1)
        corners = corners.reshape(-1, 3)
        middle = np.round(0.5 * (corners.min(axis=0) + corners.max(axis=0)))
        local = (corners - middle).astype("<f4")
        number = len(content["nodes"])
        node: dict[str, Any] = {"mesh": number, "name": name}
        if middle.any():
            node["translation"] = middle.tolist()
        content["scenes"][0]["nodes"].append(number)
        content["nodes"].append(node)
        content["meshes"].append(
            {"name": name, "primitives": [{"attributes": {"POSITION": number}}]}
        )
        content["accessors"].append(
            {
                "bufferView": number,
                "componentType": _FLOAT,
                "count": len(local),
                "type": "VEC3",
                "min": local.min(axis=0).tolist(),
                "max": local.max(axis=0).tolist(),
            }
        )
        content["bufferViews"].append(
            {
                "buffer": 0,
                "byteOffset": sum(map(len, chunks)),
                "byteLength": local.nbytes,
                "target": _ARRAY_BUFFER,
            }
        )
        chunks.append(local.tobytes())
    binary = b"".join(chunks)
    content["buffers"] = [{"byteLength": len(binary)}]
    text = json.dumps(content, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    body = _chunk(_JSON, text) + _chunk(_BIN, binary)
    head = _MAGIC + (2).to_bytes(4, "little") + (12 + len(body)).to_bytes(4, "little")
    return head + body


def _chunk(kind: int, data: bytes) -> bytes:
    return len(data).to_bytes(4, "little") + kind.to_bytes(4, "little") + data
