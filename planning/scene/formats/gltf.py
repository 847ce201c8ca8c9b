"""glTF 2.0, as text and binary: the triangles of its scene, each where its nodes put it."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.scene.formats.faces import Triangles
from esplanade.planning.scene.formats.gltf_accessors import Accessors
from esplanade.planning.scene.formats.gltf_container import Container
from esplanade.planning.scene.formats.gltf_extensions import DRACO, INSTANCING, check_extensions
from esplanade.planning.scene.formats.gltf_nodes import instances, placed, scene_nodes
from esplanade.planning.scene.formats.unpacking import unpacked_draco

MAX_NODES: Final = 20_000
MAX_TRIANGLES: Final = 5_000_000
"""Most triangles of all nodes together: a mesh counts as often as nodes show it."""

_TRIANGLES, _STRIP, _FAN = 4, 5, 6
_LINES: Final = (0, 1, 2, 3)

_Floats = NDArray[np.float64]
_Ints = NDArray[np.int64]


def read_gltf(path: Path, data: bytes) -> Triangles:
    """The triangles of the default scene of a glTF or GLB file.

    Raises
    ------
    ValueError
        It is no glTF 2.0, needs an extension that is unknown here, or is larger than may be.
    """
    container = Container(path, data)
    passed = Counter({f"uses of {name}": 1 for name in check_extensions(container.content)})
    nodes = container.objects("nodes")
    if len(nodes) > MAX_NODES:
        raise ValueError(f"it has {len(nodes)} nodes, {MAX_NODES} are possible")
    accessors = Accessors(container)
    shown = scene_nodes(container)
    _check_count(container, accessors, [nodes[place] for place, _ in shown])
    meshes: dict[int, _Floats] = {}
    parts = [np.empty((0, 3, 3))]
    triangles = 0
    for place, transform in shown:
        node = nodes[place]
        mesh = node.get("mesh")
        if mesh is None:
            continue
        weights = node.get("weights")
        if mesh not in meshes or weights is not None:
            meshes[mesh] = _mesh(container, accessors, mesh, weights, passed)
        passed["skinned meshes, taken as they rest"] += "skin" in node
        copies = instances(node.get("extensions", {}).get(INSTANCING), accessors)
        triangles += len(meshes[mesh]) * len(copies)
        _check_shown(triangles)  # packed meshes may hold more than the file tells
        parts.append(placed(meshes[mesh], transform @ copies))
        if weights is not None:
            del meshes[mesh]
    return Triangles(np.concatenate(parts), +passed)


def _check_count(container: Container, accessors: Accessors, nodes: list[Any]) -> None:
    """Refuse more triangles than are possible, before any are read."""
    triangles: dict[int, int] = {}
    shown = 0
    for node in nodes:
        mesh = node.get("mesh")
        if mesh is None:
            continue
        if mesh not in triangles:
            triangles[mesh] = sum(
                _declared(accessors, primitive) for primitive in _primitives(container, mesh)
            )
        instancing = node.get("extensions", {}).get(INSTANCING)
        attributes = instancing.get("attributes", {}) if isinstance(instancing, dict) else {}
        shown += triangles[mesh] * max(
            [accessors.count(accessor) for accessor in attributes.values()], default=1
        )
    _check_shown(shown)


def _check_shown(triangles: int) -> None:
    if triangles > MAX_TRIANGLES:
        raise ValueError(
            f"its nodes show {triangles} triangles in all, {MAX_TRIANGLES} are possible: "
            "make simpler meshes of it, or export fewer copies"
        )


def _primitives(container: Container, mesh: Any) -> list[Any]:
    primitives = container.part("meshes", mesh).get("primitives")
    if not isinstance(primitives, list) or not all(isinstance(part, dict) for part in primitives):
        raise ValueError(f"mesh {mesh} has no primitives")
    return primitives


def _declared(accessors: Accessors, primitive: Any) -> int:
    """Triangles of a primitive as the file tells it; strips and fans count one for each corner."""
    place = primitive.get("indices", primitive.get("attributes", {}).get("POSITION"))
    if place is None:
        return 0
    corners = accessors.count(place)
    return corners // 3 if primitive.get("mode", _TRIANGLES) == _TRIANGLES else corners


def _mesh(
    container: Container, accessors: Accessors, mesh: Any, weights: Any, passed: Counter[str]
) -> _Floats:
    """The triangles of a mesh in its own axes, (T, 3, 3)."""
    weights = container.part("meshes", mesh).get("weights", ()) if weights is None else weights
    parts = [np.empty((0, 3, 3))]
    for primitive in _primitives(container, mesh):
        mode = primitive.get("mode", _TRIANGLES)
        if mode in _LINES:
            passed["points and lines"] += 1
            continue
        if mode not in (_TRIANGLES, _STRIP, _FAN):
            raise ValueError(f"mesh {mesh} has a primitive of mode {mode!r}, which is unknown")
        vertices, corners = _vertices_and_corners(accessors, primitive, weights)
        if len(corners) and int(corners.max()) >= len(vertices):
            raise ValueError(
                f"mesh {mesh} names a corner that is out of bounds: there are {len(vertices)}"
            )
        passed["corners beyond the last whole triangle"] += len(corners) % 3 * (mode == _TRIANGLES)
        parts.append(vertices[_triangles(corners, mode)])
    return np.concatenate(parts)


def _vertices_and_corners(
    accessors: Accessors, primitive: Any, weights: Any
) -> tuple[_Floats, _Ints]:
    packed = primitive.get("extensions", {}).get(DRACO)
    if packed is not None and not accessors.has_plain(primitive, DRACO):
        data, _ = accessors.view(packed.get("bufferView"))
        vertices, triangles = unpacked_draco(bytes(data))
        return vertices, triangles.reshape(-1)
    attributes = primitive.get("attributes", {})
    if "POSITION" not in attributes:
        raise ValueError("a primitive has no positions")
    vertices = accessors.values(attributes["POSITION"], 3)
    for weight, target in zip(weights, primitive.get("targets", ()), strict=False):
        if weight and "POSITION" in target:
            moved = accessors.values(target["POSITION"], 3)
            if len(moved) != len(vertices):
                raise ValueError("a morph target has another number of corners than its mesh")
            vertices = vertices + float(weight) * moved
    if "indices" in primitive:
        return vertices, accessors.indices(primitive["indices"])
    return vertices, np.arange(len(vertices))


def _triangles(corners: _Ints, mode: int) -> _Ints:
    """Corners of triangles, (T, 3); every other one of a strip is turned round."""
    if mode == _TRIANGLES:
        return corners[: len(corners) // 3 * 3].reshape(-1, 3)
    if len(corners) < 3:
        return np.empty((0, 3), dtype=np.int64)
    if mode == _FAN:
        first = np.full(len(corners) - 2, corners[0])
        return np.stack([first, corners[1:-1], corners[2:]], axis=1)
    strip = np.stack([corners[:-2], corners[1:-1], corners[2:]], axis=1)
    strip[1::2] = strip[1::2, [1, 0, 2]]
    return strip
