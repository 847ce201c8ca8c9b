"""The reader of a plan, found by content and suffix."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from esplanade.commandline.errors import UsageError
from esplanade.planning.scene.bounded_reading import read_bounded
from esplanade.scenery.plans.dxf import read_dxf
from esplanade.scenery.plans.jupedsim_geometry import read_jupedsim
from esplanade.scenery.plans.polygons import read_geojson, read_wkt
from esplanade.scenery.plans.ros_map import read_ros_map
from esplanade.scenery.plans.storey import Storey

MAX_BYTES: Final = 64 * 2**20
SUFFIXES: Final = (".wkt", ".geojson", ".xml", ".yaml", ".yml", ".dxf")


def is_plan(path: Path) -> bool:
    """Whether a file is read as a plan, and not as a mesh."""
    if path.suffix.lower() in SUFFIXES:
        return True
    return path.suffix.lower() == ".json"


def read_plan(path: Path, layers: Sequence[str] = ()) -> Storey:
    """The storey that a plan shows.

    Raises
    ------
    UsageError
        The file cannot be read; the message names it and its fault.
    """
    try:
        # Numbers too large for a corner are named by `_check_drawn`.
        with np.errstate(over="ignore", invalid="ignore"):
            storey = _read(path, read_bounded(path, MAX_BYTES), layers)
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


def _read(path: Path, data: bytes, layers: Sequence[str]) -> Storey:
    match path.suffix.lower():
        case ".wkt":
            return read_wkt(data, path.stem)
        case ".geojson" | ".json":
            return read_geojson(data, path.stem)
        case ".xml":
            return read_jupedsim(data, path.stem)
        case ".yaml" | ".yml":
            return read_ros_map(path, data)
        case _:
            return read_dxf(data, path.stem, layers)
