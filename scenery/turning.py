"""A scene turned about the vertical: every point of it, and its mesh."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from esplanade.commandline.errors import UsageError
from esplanade.planning import Scene
from esplanade.planning.scene.mesh_file import MeshError, read_triangles
from esplanade.planning.scene.scene_file import scene_faults
from esplanade.scenery.meshes import as_glb
from esplanade.scenery.scene_text import scene_text

_DIGITS: Final = 6
"""Digits of a turned coordinate: micrometres."""
_FENCE_M: Final = 1.1
"""Height of the walls along the turned edges of the ground: nobody climbs them."""

Point = tuple[float, float]


def turned_scene(scene: Scene, degrees: float) -> Scene:
    """The scene turned to the left, as one sees it from above, about the middle of its bounds.

    Bounds lie along the axes, so those of the turned scene are wider; walls along the turned
    edges keep everybody where they could go before. Its mesh is not turned here.

    Raises
    ------
    UsageError
        The turned scene is larger than a scene may be.
    """
    x0, y0, x1, y1 = scene.bounds
    turn = _turn(degrees, (0.5 * (x0 + x1), 0.5 * (y0 + y1)))
    corners = [turn(corner) for corner in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))]
    parts = scene.model_dump(exclude={"mesh"})
    xs, ys = zip(*corners, strict=True)
    turned = {name: _with_points_turned(part, turn) for name, part in parts.items()}
    turned["bounds"] = (math.floor(min(xs)), math.floor(min(ys)))
    turned["bounds"] += (math.ceil(max(xs)), math.ceil(max(ys)))
    if scene.mesh is None and degrees % 90.0:
        turned["walls"] = [
            *turned["walls"],
            *(
                {"start": corners[k - 1], "end": corners[k], "height_m": _FENCE_M}
                for k in range(len(corners))
            ),
        ]
    try:
        made = Scene.model_validate(turned)
    except ValidationError as error:
        raise UsageError(f"turned, it is no scene: {'; '.join(scene_faults(error))}") from None
    return made.model_copy(update={"mesh": scene.mesh})


def write_turned(scene: Scene, degrees: float, target: Path) -> Scene:
    """Write a turned scene, and where it has a mesh that of it beside it as GLB.

    Raises
    ------
    UsageError
        It cannot be written, or its mesh cannot be read.
    """
    made = turned_scene(scene, degrees)
    mesh = None
    if scene.mesh is not None:
        kept = target.with_suffix(".glb")
        if kept.resolve() == scene.mesh.resolve():
            raise UsageError(f"--out: {kept.name} would be written over the mesh itself")
        try:
            triangles = read_triangles(scene.mesh)
        except MeshError as error:
            raise UsageError(str(error)) from None
        mesh = as_glb({"mesh": _turned_triangles(triangles, degrees, scene.bounds)})
        made = made.model_copy(update={"mesh": Path(kept.name)})
    try:
        if mesh is not None:
            kept.write_bytes(mesh)
        target.write_text(scene_text(made), encoding="utf-8")
    except OSError as error:
        raise UsageError(f"--out: {error}") from None
    return made


def _turn(degrees: float, middle: Point) -> Callable[[Point], Point]:
    cosine, sine = _cosine_and_sine(degrees)
    mx, my = middle

    def turn(point: Point) -> Point:
        x, y = point[0] - mx, point[1] - my
        return (
            round(mx + cosine * x - sine * y, _DIGITS) + 0.0,
            round(my + sine * x + cosine * y, _DIGITS) + 0.0,
        )

    return turn


def _cosine_and_sine(degrees: float) -> Point:
    """Exact for quarters of a turn."""
    quarter, rest = divmod(degrees % 360.0, 90.0)
    if rest == 0.0:
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[int(quarter)]
    return math.cos(math.radians(degrees)), math.sin(math.radians(degrees))


def _with_points_turned(part: Any, turn: Callable[[Point], Point]) -> Any:
    """A part with every pair of coordinates in it turned."""
    match part:
        case dict():
            return {key: _with_points_turned(value, turn) for key, value in part.items()}
        case (float() | int() as x, float() | int() as y):
            return turn((x, y))
        case list() | tuple():
            return [_with_points_turned(value, turn) for value in part]
    return part


def _turned_triangles(
    triangles: NDArray[np.float64], degrees: float, bounds: tuple[float, float, float, float]
) -> NDArray[np.float64]:
    x0, y0, x1, y1 = bounds
    middle = np.array([0.5 * (x0 + x1), 0.5 * (y0 + y1), 0.0])
    cosine, sine = _cosine_and_sine(degrees)
    matrix = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    turned: NDArray[np.float64] = (triangles - middle) @ matrix.T + middle
    return turned
