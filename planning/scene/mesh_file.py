"""Reading meshes: the format is found by content, and every file is checked before it is used."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.scene.bounded_reading import read_bounded, suffix_of
from esplanade.planning.scene.formats.faces import Triangles, cut
from esplanade.planning.scene.formats.gltf import read_gltf
from esplanade.planning.scene.formats.ifc import read_ifc
from esplanade.planning.scene.formats.lengths import metres_in
from esplanade.planning.scene.formats.obj import read_obj
from esplanade.planning.scene.formats.off import HEADERS, read_off
from esplanade.planning.scene.formats.ply import read_ply
from esplanade.planning.scene.formats.stl import read_stl
from esplanade.planning.scene.formats.threemf import read_3mf
from esplanade.planning.scene.mesh_error import MeshError
from esplanade.planning.scene.scene import MAX_EXTENT_M

__all__ = ["MAX_FILE_BYTES", "Mesh", "MeshError", "Up", "read_mesh", "read_triangles"]

Up = Literal["y", "z"]

MAX_FILE_BYTES: Final = 384 * 2**20
FURTHEST_M: Final = 1e6
"""Greatest coordinate, as in scene files: beyond, positions would no longer be exact."""

_FORMATS: Final[dict[str, Callable[[Path, bytes], Triangles]]] = {
    "OBJ": lambda _, data: cut(read_obj(data)),
    "OFF": lambda _, data: cut(read_off(data)),
    "PLY": lambda _, data: cut(read_ply(data)),
    "STL": lambda _, data: read_stl(data),
    "3MF": lambda _, data: read_3mf(data),
    "glTF": read_gltf,
    "IFC": read_ifc,
}
_SUFFIXES: Final = {
    ".obj": "OBJ",
    ".off": "OFF",
    ".ply": "PLY",
    ".stl": "STL",
    ".3mf": "3MF",
    ".ifc": "IFC",
    ".gltf": "glTF",
    ".glb": "glTF",
}
_UP: Final[dict[str, Up]] = {"STL": "z", "3MF": "z", "IFC": "z"}
"""The axis that is up where the format says so or its programs agree; y in all others."""


@dataclass(frozen=True)
class Mesh:
    """The triangles of a file, and what was passed over."""

    triangles: NDArray[np.float64]
    """(T, 3, 3), metres, x east, y north, z up."""
    kind: str
    passed: Counter[str] = field(default_factory=Counter)
    """The parts of the file beside them, with their counts."""
    offset_m: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """The offset taken from every corner: x, y, z of the file's own origin."""
    told: tuple[str, ...] = ()
    """Further facts that the file tells, such as the names of its storeys."""


def read_triangles(path: str | Path, up: Up = "y") -> NDArray[np.float64]:
    """The triangles of a file, float64 (T, 3, 3), metres, x east, y north, z up; see `read_mesh`.

    Raises
    ------
    MeshError
        The file holds no mesh to walk on.
    """
    return read_mesh(path, up).triangles


def read_mesh(
    path: str | Path, up: Up | None = None, metres_a_unit: float = 1.0, recentre: bool = False
) -> Mesh:
    """The triangles of a file, each where its transform puts it, checked.

    `metres_a_unit` = 1 leaves it to the file which unit its corners are in, if it says one.
    With `up` = "y", as in glTF and most OBJ files, what the file calls (x, y, z) becomes (x, -z,
    y); None takes what is usual for the format. With `recentre` the middle of the mesh on the
    map and its lowest corner become the origin, to whole metres.

    Raises
    ------
    MeshError
        The file cannot be read, holds no triangles, has corners that are not finite or indices
        out of range, measures more than a scene may, or lies too far from its origin.
    """
    path = Path(path)
    if up not in ("y", "z", None):
        raise MeshError(f"{path.name}: up must be 'y' or 'z', got {up!r}")
    kind, found = _read(path)
    if not len(found.points):
        others = "".join(f"; it has {count} {what}" for what, count in found.passed.items())
        raise MeshError(f"{path.name}: it holds no triangles{others}")
    wrong = np.flatnonzero(~np.isfinite(found.points).all(axis=(1, 2)))
    if len(wrong):
        raise MeshError(f"{path.name}: triangle {wrong[0]} has a corner that is not finite")
    corners = found.points
    up = up or _UP.get(kind, "y")
    if up == "y":
        corners = np.stack([corners[..., 0], -corners[..., 2], corners[..., 1]], axis=-1)
    told = found.told
    if metres_a_unit == 1.0 and (said_m := metres_in(found.unit)) is not None:
        metres_a_unit = said_m
        told = (*told, f"its unit is that of its comment: {found.unit}")
    corners = np.ascontiguousarray(corners * metres_a_unit)
    extent = np.ptp(corners.reshape(-1, 3), axis=0)
    _check_extent(path.name, extent, up)
    offset = _middle(corners) if recentre else np.zeros(3)
    corners -= offset
    furthest = np.abs(corners).max()
    if furthest > FURTHEST_M:
        raise MeshError(
            f"{path.name}: it lies {furthest:.6g} m from its origin; {FURTHEST_M:g} m are "
            "possible. Move it nearer (`esplanade scene import --recentre`)"
        )
    x, y, z = offset.tolist()
    return Mesh(corners, kind, found.passed, (x, y, z), told)


def _check_extent(name: str, extent: NDArray[np.float64], up: str) -> None:
    if extent.max() > MAX_EXTENT_M:
        x, y, z = extent
        raise MeshError(
            f"{name}: it measures {x:.6g} x {y:.6g} m and is {z:.6g} m high; a side may measure "
            f"{MAX_EXTENT_M:g} m. Is its unit the metre?"
        )
    if not (extent[:2] > 0.0).all():
        raise MeshError(f"{name}: it has no extent on the ground; is {up!r} really up?")


def _middle(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    points = corners.reshape(-1, 3)
    low, high = points.min(axis=0), points.max(axis=0)
    return np.round([*(0.5 * (low + high))[:2], low[2]])


def _read(path: Path) -> tuple[str, Triangles]:
    try:
        if not path.is_file():
            raise MeshError(f"{path.name}: there is no such file")
        if path.stat().st_size > MAX_FILE_BYTES:
            raise MeshError(f"{path.name}: it has more than {MAX_FILE_BYTES // 2**20} MiB")
        data = read_bounded(path, MAX_FILE_BYTES)
    except OSError as error:
        raise MeshError(f"{path.name}: it cannot be read: {error.strerror or error}") from None
    kind = _format_of(path, data)
    try:
        # Corners that are not finite are named later, and what is too large for its face is none.
        with np.errstate(over="ignore", invalid="ignore"):
            return kind, _FORMATS[kind](path, data)
    # Broken bytes take readers to places that nobody thought of.
    except Exception as error:
        words = str(error) if isinstance(error, ValueError) else f"{type(error).__name__}: {error}"
        raise MeshError(f"{path.name}: it is no {kind} that can be read: {words}") from error


def _format_of(path: Path, data: bytes) -> str:
    """The format by how the file begins, else by its suffix."""
    start = data[:256].lstrip(b"\xef\xbb\xbf \t\r\n")
    if data.startswith(b"glTF") or (start.startswith(b"{") and b'"asset"' in data):
        return "glTF"
    if start.startswith((b"ply\n", b"ply\r")):
        return "PLY"
    if start.startswith(b"ISO-10303-21"):
        return "IFC"
    if data.startswith(b"PK\x03\x04"):
        return "3MF"
    if start.split(None, 1)[:1] in [[header.encode()] for header in HEADERS]:
        return "OFF"
    if b"<COLLADA" in data[:4096]:
        raise MeshError(f"{path.name}: Collada is not read; save it as glTF")
    kind = _SUFFIXES.get(suffix_of(path))
    if kind is None:
        known = ", ".join(sorted(suffix[1:] for suffix in _SUFFIXES))
        raise MeshError(
            f"{path.name}: {suffix_of(path) or 'a file without suffix'} is not read; there are "
            f"{known}"
        )
    return kind
