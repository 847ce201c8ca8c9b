"""Maps of ROS: a YAML file and its image, whose light pixels are free."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from esplanade.files.text import decoded
from esplanade.scenery.plans.storey import Storey, library

_MODES: Final = ("trinary", "scale", "raw")
MAX_YAML_BYTES: Final = 65_536
MAX_RUNS: Final = 200_000
MAX_PIXELS: Final = 16_000_000


def read_ros_map(path: Path, data: bytes) -> Storey:
    """The storey of a map; what is occupied or unknown cannot be walked.

    Raises
    ------
    ValueError
        A key is missing or wrong, or the image cannot be read.
    """
    shapely = library("shapely", "plans")
    yaml = library("yaml", "ROS maps")
    if len(data) > MAX_YAML_BYTES:
        raise ValueError(f"it has more than {MAX_YAML_BYTES} bytes, which no map has")
    try:
        content = yaml.safe_load(decoded(data).text)
    except (yaml.YAMLError, RecursionError) as error:
        raise ValueError(f"it is no YAML: {error}") from None
    if not isinstance(content, dict) or "image" not in content:
        raise ValueError("it names no image")
    try:
        resolution = float(content["resolution"])
        x0, y0, yaw = (float(value) for value in content["origin"])
        occupied = float(content.get("occupied_thresh", 0.65))
        free = float(content.get("free_thresh", 0.196))
        negate = bool(int(content.get("negate", 0)))
        mode = str(content.get("mode", "trinary")).lower()
    except (KeyError, TypeError, ValueError) as error:
        raise ValueError(
            f"resolution, origin or a threshold is missing or wrong: {error}"
        ) from None
    if not (0.0 < resolution < 10.0 and math.isfinite(x0 + y0 + yaw) and free < occupied):
        raise ValueError("resolution, origin or thresholds cannot be meant")
    if mode not in _MODES:
        raise ValueError(f"its mode {mode!r:.40} is none of {', '.join(_MODES)}")
    light = _light(path.parent / str(content["image"]))
    light = 1.0 - light if negate else light
    # In raw maps a pixel is the occupancy itself, in percent; what is above is unknown.
    darkness = 255.0 * light / 100.0 if mode == "raw" else 1.0 - light
    darkness[darkness > 1.0] = np.nan
    walkable = _boxes(darkness[::-1] < free, resolution)
    area = shapely.union_all(walkable)
    affinity = library("shapely.affinity", "plans")
    if yaw:
        area = affinity.rotate(area, yaw, origin=(0.0, 0.0), use_radians=True)
    rows, columns = darkness.shape
    between = int((~(darkness < free) & ~(darkness > occupied)).sum())
    storey = Storey(path.stem, affinity.translate(area, x0, y0))
    storey.remarks.append(
        f"{rows * columns} pixels of {resolution:g} m; {between / (rows * columns):.1%} of them "
        "are unknown and cannot be walked"
    )
    return storey


def _light(path: Path) -> NDArray[np.float64]:
    """The pixels of an image, 0 to 1, (rows, columns); NaN where they are transparent."""
    images: Any = library("PIL.Image", "ROS maps")
    if not path.is_file():
        raise ValueError(f"there is no image {path.name!r} beside it")
    try:
        with images.open(path) as image:
            if image.width * image.height > MAX_PIXELS:
                raise ValueError(f"{path.name} has more than {MAX_PIXELS} pixels")
            if image.mode.startswith(("I", "F")):
                deep = np.asarray(image, dtype=np.float64)
                return deep / (65_535.0 if deep.max(initial=0.0) > 255.0 else 255.0)
            light = np.asarray(image.convert("L"), dtype=np.float64) / 255.0
            if image.has_transparency_data:
                light[np.asarray(image.convert("RGBA"))[..., 3] == 0] = np.nan
            return light
    except (OSError, SyntaxError, images.DecompressionBombError) as error:
        raise ValueError(f"{path.name}: it is no image that can be read: {error}") from None


def _boxes(free: NDArray[np.bool_], size: float) -> NDArray[Any]:
    """A box for each run of free pixels of a row, from the south."""
    shapely = library("shapely", "plans")
    edges = np.diff(np.pad(free.astype(np.int8), ((0, 0), (1, 1))), axis=1)
    rows, begins = np.nonzero(edges == 1)
    _, ends = np.nonzero(edges == -1)
    if len(rows) > MAX_RUNS:
        raise ValueError(f"its free pixels are torn into {len(rows)} runs, {MAX_RUNS} are possible")
    boxes: NDArray[Any] = shapely.box(begins * size, rows * size, ends * size, (rows + 1) * size)
    return boxes
