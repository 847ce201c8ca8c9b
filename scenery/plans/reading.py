"""The reader of a plan, found by content and suffix."""

import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from esplanade.commandline.errors import UsageError
from esplanade.files.content import ContentError
from esplanade.files.text import decoded
from esplanade.planning.scene.bounded_reading import read_bounded, read_head, suffix_of
from esplanade.scenery.plans.dxf import read_dxf
from esplanade.scenery.plans.jupedsim_geometry import read_jupedsim
from esplanade.scenery.plans.polygons import read_geojson, read_wkt
from esplanade.scenery.plans.ros_map import read_ros_map
from esplanade.scenery.plans.storey import Storey

MAX_BYTES: Final = 64 * 2**20
MESH_SUFFIXES: Final = (".obj", ".off", ".ply", ".stl", ".gltf", ".glb", ".3mf", ".ifc")
_HEAD_BYTES: Final = 2000
_BEGINNINGS: Final = {
    ".wkt": re.compile(
        r"(?:\s*#.*\n|\s*SRID=\d+;)*\s*(?:(?:MULTI)?(?:POLYGON|LINESTRING|POINT)|"
        r"GEOMETRYCOLLECTION)\b",
        re.IGNORECASE,
    ),
    ".dxf": re.compile(r"AutoCAD Binary DXF|(?:\s*999\s*\n.*\n)*\s*0\s*\n\s*SECTION\s*\n"),
    ".geojson": re.compile(
        r'\s*\{(?=[^"]*"type"\s*:|.*"features").*"(?:Feature|coordinates)', re.DOTALL
    ),
    ".xml": re.compile(r"\s*<.*<geometry\b|\s*<geometry\b", re.DOTALL),
    ".yaml": re.compile(r"(?=.*^image\s*:).*^resolution\s*:", re.DOTALL | re.MULTILINE),
}
"""Beginnings by which forms of plans show themselves."""
SUFFIXES: Final = (".wkt", ".geojson", ".xml", ".yaml", ".yml", ".dxf")


def is_plan(path: Path) -> bool:
    """Whether a file is read as a plan, and not as a mesh."""
    suffix = suffix_of(path)
    if suffix in SUFFIXES or suffix == ".json":
        return True
    return suffix not in MESH_SUFFIXES and bool(_form_shown(path))


def says_its_unit(path: Path) -> bool:
    """Whether plans of this form say how long their unit is."""
    return _form_of(path) in (".dxf", ".xml")


def read_plan(path: Path, layers: Sequence[str] = (), unit_m: float | None = None) -> Storey:
    """The storey that a plan shows.

    `unit_m` is the length of its unit, of one whose form says that, whatever it says.

    Raises
    ------
    UsageError
        The file cannot be read; the message names it and its fault.
    """
    try:
        # Numbers too large for a corner are named by `_check_drawn`.
        with np.errstate(over="ignore", invalid="ignore"):
            storey = _read(path, read_bounded(path, MAX_BYTES), layers, unit_m)
        _check_drawn(storey)
    except OSError as error:
        raise UsageError(f"{path}: cannot be read: {error.strerror or error}") from None
    except UsageError:
        raise
    # Broken bytes take libraries to places that nobody thought of.
    except Exception as error:  # noqa: BLE001
        words = str(error) if isinstance(error, ValueError) else f"{type(error).__name__}: {error}"
        raise UsageError(f"{path}: {words}"[:800]) from None
    return storey


def _check_drawn(storey: Storey) -> None:
    try:
        box = storey.bounds()
    except ValueError as error:
        raise ValueError("; ".join((str(error), *storey.remarks))) from None
    ends = [c for wall in storey.walls for point in wall for c in point]
    if not all(map(math.isfinite, (*box, *ends))):
        raise ValueError("a corner of it is not finite")


def _read(path: Path, data: bytes, layers: Sequence[str], unit_m: float | None) -> Storey:
    name = Path(path.stem).stem if path.suffix.lower() == ".gz" else path.stem
    match _form_of(path):
        case ".wkt":
            return read_wkt(data, name)
        case ".geojson":
            return read_geojson(data, name)
        case ".xml":
            return read_jupedsim(data, name, unit_m)
        case ".yaml":
            return read_ros_map(path, data)
        case _:
            return read_dxf(data, name, layers, unit_m)


def _form_of(path: Path) -> str:
    """The form by the suffix, else by how the file begins."""
    suffix = {".json": ".geojson", ".yml": ".yaml"}.get(suffix_of(path), suffix_of(path))
    return suffix if suffix in SUFFIXES else _form_shown(path)


def _form_shown(path: Path) -> str:
    """The suffix of the form that the beginning of a file shows; empty for none."""
    try:
        head = read_head(path, _HEAD_BYTES)
        text = decoded(head, eight_bit=True).text
    except (OSError, ContentError):
        return ""
    return next((suffix for suffix, form in _BEGINNINGS.items() if form.match(text)), "")
