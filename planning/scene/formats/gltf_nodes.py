"""The nodes of a glTF file: which its scene shows, and where each puts its mesh."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.scene.formats.gltf_accessors import Accessors
from esplanade.planning.scene.formats.gltf_container import Container

_Floats = NDArray[np.float64]


def scene_nodes(container: Container) -> list[tuple[int, _Floats]]:
    """The nodes of the default scene, each with its transform (4, 4) into the world.

    Without a default scene the first one counts; without any, all nodes that are below no other.

    Raises
    ------
    ValueError
        A node is below itself, or below two others.
    """
    nodes = container.objects("nodes")
    below = [_children(container, node) for node in nodes]
    scenes = container.objects("scenes")
    if scenes:
        roots = container.part("scenes", container.content.get("scene", 0)).get("nodes", [])
    else:
        roots = sorted(set(range(len(nodes))) - {child for children in below for child in children})
    found: list[tuple[int, _Floats]] = []
    seen: set[int] = set()
    left = [(root, np.eye(4)) for root in reversed(roots)]
    while left:
        place, above = left.pop()
        node = container.part("nodes", place)
        if place in seen:
            raise ValueError(f"node {place} is below itself, or below two others")
        seen.add(place)
        transform = above @ matrix_of(node)
        found.append((place, transform))
        left += [(child, transform) for child in reversed(below[place])]
    return found


def _children(container: Container, node: Any) -> list[int]:
    children = node.get("children", [])
    if not isinstance(children, list):
        raise ValueError("the children of a node are no list")  # noqa: TRY004
    for child in children:
        container.part("nodes", child)
    return children


def matrix_of(node: Any) -> _Floats:
    """The transform of a node below the one above it, (4, 4)."""
    if "matrix" in node:
        matrix: _Floats = _numbers(node["matrix"], 16).reshape(4, 4).T
        return matrix
    move = _numbers(node.get("translation", (0.0, 0.0, 0.0)), 3)
    turn = _numbers(node.get("rotation", (0.0, 0.0, 0.0, 1.0)), 4)
    stretch = _numbers(node.get("scale", (1.0, 1.0, 1.0)), 3)
    composed: _Floats = _composed(move[None], turn[None], stretch[None])[0]
    return composed


def instances(extension: Any, accessors: Accessors) -> _Floats:
    """The transforms (K, 4, 4) of the copies that a node shows; without any, one that changes
    nothing."""
    if extension is None:
        return np.eye(4)[None]
    attributes = extension.get("attributes", {}) if isinstance(extension, dict) else {}
    parts = {
        name: accessors.values(attributes[name], width)
        for name, width in (("TRANSLATION", 3), ("ROTATION", 4), ("SCALE", 3))
        if name in attributes
    }
    counts = {len(part) for part in parts.values()}
    if len(counts) > 1:
        raise ValueError(f"the instances of a node are not as many in each attribute: {counts}")
    count = counts.pop() if counts else 1
    return _composed(
        parts.get("TRANSLATION", np.zeros((count, 3))),
        parts.get("ROTATION", np.tile([0.0, 0.0, 0.0, 1.0], (count, 1))),
        parts.get("SCALE", np.ones((count, 3))),
    )


def placed(triangles: _Floats, transforms: _Floats) -> _Floats:
    """Triangles (T, 3, 3) at each place where transforms (K, 4, 4) put them, (K * T, 3, 3).

    Mirror images are turned round, since they would show their inner side.
    """
    corners = triangles.reshape(1, -1, 3)
    points = corners @ transforms[:, :3, :3].transpose(0, 2, 1) + transforms[:, None, :3, 3]
    points = points.reshape(len(transforms), -1, 3, 3)
    mirrored = np.linalg.det(transforms[:, :3, :3]) < 0.0
    points[mirrored] = points[mirrored][:, :, ::-1]
    return points.reshape(-1, 3, 3)


def _composed(moves: _Floats, turns: _Floats, stretches: _Floats) -> _Floats:
    """Transforms (N, 4, 4) that stretch, then turn by quaternions x, y, z, w, then move."""
    lengths = np.linalg.norm(turns, axis=1, keepdims=True)
    x, y, z, w = (turns / np.where(lengths > 0.0, lengths, 1.0)).T
    made = np.zeros((len(moves), 4, 4))
    xx, yy, zz, xy, xz, yz = x * x, y * y, z * z, x * y, x * z, y * z
    xw, yw, zw = x * w, y * w, z * w
    made[:, 0, :3] = np.stack([1 - 2 * (yy + zz), 2 * (xy - zw), 2 * (xz + yw)], axis=1)
    made[:, 1, :3] = np.stack([2 * (xy + zw), 1 - 2 * (xx + zz), 2 * (yz - xw)], axis=1)
    made[:, 2, :3] = np.stack([2 * (xz - yw), 2 * (yz + xw), 1 - 2 * (xx + yy)], axis=1)
    made[:, :3, :3] *= stretches[:, None, :]
    made[:, :3, 3] = moves
    made[:, 3, 3] = 1.0
    return made


def _numbers(values: Any, count: int) -> _Floats:
    if not isinstance(values, list | tuple) or len(values) != count:
        raise ValueError(f"a node moves its mesh by {values!r}: {count} numbers are expected")
    try:
        return np.array([float(value) for value in values])
    except (TypeError, ValueError):
        raise ValueError(f"a node moves its mesh by {values!r}, which are no numbers") from None
