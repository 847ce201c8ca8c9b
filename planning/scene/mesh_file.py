"""Reading meshes: OBJ, glTF and all other formats of trimesh, checked before anything uses them."""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from esplanade.files.text import read_text
from esplanade.planning.scene.gltf_check import MAX_FILE_BYTES, check_gltf
from esplanade.planning.scene.scene import MAX_EXTENT_M

Up = Literal["y", "z"]

FURTHEST_M = 1e6
"""Greatest coordinate, as in scene files: beyond, positions would no longer be exact."""


class MeshError(ValueError):
    """A file that holds no mesh to walk on; says what is wrong with it."""


def read_triangles(path: str | Path, up: Up = "y") -> NDArray[np.float64]:
    """The triangles of a file, float64 (T, 3, 3), metres, x east, y north, z up.

    All objects of the file are taken, each where its transform puts it. With `up` = "y", as in
    glTF and most OBJ files, what the file calls (x, y, z) becomes (x, -z, y).

    Raises
    ------
    MeshError
        The file cannot be read, holds no triangles, has corners that are not finite or indices
        out of range, measures more than a scene may, or lies too far from its origin.
    """
    name = Path(path).name
    if up not in ("y", "z"):
        raise MeshError(f"{name}: up must be 'y' or 'z', got {up!r}")
    corners = _load(Path(path))
    if not len(corners):
        raise MeshError(f"{name}: it holds no triangles")
    wrong = np.flatnonzero(~np.isfinite(corners).all(axis=(1, 2)))
    if len(wrong):
        raise MeshError(f"{name}: triangle {wrong[0]} has a corner that is not finite")
    if up == "y":
        corners = np.stack([corners[..., 0], -corners[..., 2], corners[..., 1]], axis=-1)
    extent = np.ptp(corners.reshape(-1, 3), axis=0)
    if extent.max() > MAX_EXTENT_M:
        x, y, z = extent
        raise MeshError(
            f"{name}: it measures {x:.6g} x {y:.6g} m and is {z:.6g} m high; a side may measure "
            f"{MAX_EXTENT_M:g} m. Is its unit the metre?"
        )
    if np.abs(corners).max() > FURTHEST_M:
        raise MeshError(
            f"{name}: it lies {np.abs(corners).max():.6g} m from its origin; {FURTHEST_M:g} m are "
            "possible. Move it nearer"
        )
    if not (extent[:2] > 0.0).all():
        raise MeshError(f"{name}: it has no extent on the ground; is {up!r} really up?")
    return np.ascontiguousarray(corners)


def open_mesh(path: Path, *, materials: bool = False) -> Any:
    """A file as trimesh reads it, a scene of all its objects.

    Raises
    ------
    MeshError
        The file cannot be read, or holds nothing.
    """
    import trimesh  # noqa: PLC0415  (takes a while to import, and few need it)

    if not path.is_file():
        raise MeshError(f"{path.name}: there is no such file")
    if path.stat().st_size > MAX_FILE_BYTES:
        raise MeshError(f"{path.name}: it has more than {MAX_FILE_BYTES // 2**20} MiB")
    try:
        check_gltf(path)
        source: Path | io.StringIO = path
        beside: dict[str, Any] = {}
        if path.suffix.lower() == ".obj":
            # Names and comments may be in any encoding; all that counts is ASCII.
            source = io.StringIO(read_text(path, MAX_FILE_BYTES, eight_bit=True))
            beside = {"file_type": "obj", "resolver": trimesh.resolvers.FilePathResolver(str(path))}
        scene = trimesh.load_scene(source, process=False, skip_materials=not materials, **beside)
    # Readers of a dozen formats raise many kinds of errors on broken bytes.
    except Exception as error:
        raise _unreadable(path, error) from error
    if not scene.geometry:
        raise MeshError(f"{path.name}: it holds no triangles")
    return scene


def _load(path: Path) -> NDArray[np.float64]:
    scene = open_mesh(path)
    try:
        corners = list(_placed(scene))
    except Exception as error:
        raise _unreadable(path, error) from error
    return np.concatenate([np.empty((0, 3, 3)), *corners])


def _placed(scene: Any) -> Iterator[NDArray[np.float64]]:
    """The triangles of every object of a scene, each where its transform puts it.

    The library's own `Scene.dump` copies each object with colours and caches, which takes three
    quarters of the time where a file shows one object thousands of times.
    """
    from trimesh import transformations  # noqa: PLC0415

    local = {
        name: _corners(np.asarray(part.vertices), np.asarray(part.faces))
        for name, part in scene.geometry.items()
        if hasattr(part, "faces")
    }
    for node in scene.graph.nodes_geometry:
        transform, name = scene.graph[node]
        if name not in local:
            continue
        corners = local[name]
        points = transformations.transform_points(corners.reshape(-1, 3), transform)
        # A mirror image would show its inner side.
        mirrored = len(points) and transformations.flips_winding(transform)  # type: ignore[no-untyped-call]
        triangles = points.reshape(corners.shape)
        yield triangles[:, ::-1] if mirrored else triangles


def _unreadable(path: Path, error: Exception) -> MeshError:
    return MeshError(f"{path.name}: it is not a mesh that can be read: {error}")


def _corners(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> NDArray[np.float64]:
    if not len(faces):
        return np.empty((0, 3, 3))
    if faces.ndim != 2 or faces.shape[1] != 3:
        raise ValueError("a face has fewer than three corners")
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise ValueError(f"a face names a corner that is not there, of {len(vertices)}")
    corners: NDArray[np.float64] = vertices[faces]
    return corners
