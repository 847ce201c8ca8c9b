"""Import of a mesh as a scene: floors are derived, a spawn is chosen, and places are spread."""

import json
import math
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray

from esplanade.commandline.errors import UsageError
from esplanade.planning import LayeredGrid, Scene
from esplanade.planning.routes.storey_heights import storeys_of
from esplanade.planning.scene.bodies import Body
from esplanade.planning.scene.mesh_file import MeshError
from esplanade.planning.scene.scene import Bounds, Place, Spawn
from esplanade.planning.traversal.stability import Stability
from esplanade.planning.traversal.traversability import Traversability
from esplanade.planning.traversal.wavefront import UNREACHED, metres, spread_wave
from esplanade.scenery.meshes import as_glb
from esplanade.scenery.place_names import PlaceNamer
from esplanade.scenery.reach import cell_near, centres, largest_region
from esplanade.scenery.values import Point

_SPAWN_RADIUS_M = 1.0
_NAME_LENGTH = 64


def import_mesh(
    source: Path,
    target: Path,
    up: str,
    metres_a_unit: float,
    cell_m: float,
    name: str | None,
    spawn: Point | None,
    places: int,
    report: Callable[[str, float], None],
) -> Scene:
    """Make a scene of a mesh, and write both: the scene, and the mesh beside it as GLB.

    The scene contains no floors, since they are derived from the mesh whenever it is read.

    Parameters
    ----------
    source : the mesh, in any form that trimesh reads
    target : the scene file to write
    up : the axis of the mesh that is up, `y` or `z`
    metres_a_unit : the length of the unit of the mesh, metres
    cell_m : the size of the cells that the mesh is examined with
    name : the name of the scene; None takes that of the mesh
    spawn : where people enter; None chooses a point amid the largest region
    places : the greatest number of places to make
    report : is called with the current activity and the fraction of the whole that is done

    Raises
    ------
    UsageError
        The mesh cannot be used, nobody can stand at the spawn, or a file cannot be written.
    """
    kept = target.with_suffix(".glb")
    if kept.resolve() == source.resolve() and (up != "y" or metres_a_unit != 1.0):
        raise UsageError(f"--out: {kept.name} would be written over the mesh itself")
    report(f"reading {source.name}", 0.0)
    try:
        mesh = as_glb(source, up, metres_a_unit)
    except MeshError as error:
        raise UsageError(str(error)) from None
    # The floors must be those of the GLB file that is kept, which may differ from the original.
    with TemporaryDirectory() as folder:
        copy = Path(folder) / kept.name
        copy.write_bytes(mesh)
        try:
            grid = LayeredGrid.from_mesh(
                copy, cell_m, "y", lambda activity, share: report(activity, _overall(share))
            )
        except MeshError as error:
            raise UsageError(f"{error}; check --up and --scale") from None
    report("choosing places", _overall(1.0))
    traversability = grid.traversability.of(Body.adult())
    start = _spawn_cell(traversability, spawn)
    x, y, z = _rounded(traversability, start)
    scene = Scene(
        name=(name or source.stem)[:_NAME_LENGTH],
        bounds=_whole_metres(grid.bounds),
        mesh=Path(kept.name),
        spawns=(Spawn(position=(x, y), z_m=z, radius_m=_SPAWN_RADIUS_M),),
        places=tuple(_places(traversability, start, _namer(grid, traversability, start), places)),
    )
    report(f"writing {target.name}", 0.95)
    try:
        kept.write_bytes(mesh)
        target.write_text(_scene_text(scene))
    except OSError as error:
        raise UsageError(f"--out: {error}") from None
    return scene


def _overall(share_of_floors: float) -> float:
    """The fraction of the whole import, of which deriving floors takes most of the time."""
    return 0.1 + 0.7 * share_of_floors


def _whole_metres(bounds: Bounds) -> Bounds:
    """Bounds rounded outward, so that they contain cells of another size too."""
    x0, y0, x1, y1 = bounds
    return math.floor(x0), math.floor(y0), math.ceil(x1), math.ceil(y1)


def _spawn_cell(traversability: Traversability, spawn: Point | None) -> int:
    """The cell nearest to `spawn`, or a cell amid the largest region if it is None."""
    if spawn is not None:
        cell = cell_near(traversability, spawn, _SPAWN_RADIUS_M)
        if cell < 0:
            raise UsageError("--spawn: an adult cannot stand there")
        return cell
    region = largest_region(traversability) & (traversability.classes == Stability.STABLE)
    if not region.any():
        raise UsageError("an adult can stand nowhere in this mesh; is --up or --scale right?")
    cells = np.flatnonzero(region)
    points = centres(traversability)[cells]
    return int(cells[np.linalg.norm(points - points.mean(axis=0), axis=1).argmin()])


def _places(
    traversability: Traversability, start: int, namer: PlaceNamer, count: int
) -> list[Place]:
    """Choose places that are as far as possible, along paths, from the spawn and each other."""
    nearest = _path_lengths(traversability, start)
    names: Counter[str] = Counter()
    made: list[Place] = []
    for _ in range(count):
        cell = int(nearest.argmax())
        if nearest[cell] <= 0.0:
            break
        point = x, y, z = _rounded(traversability, cell)
        name = namer.name_of(point)
        names[name] += 1
        again = f" {names[name]}" if names[name] > 1 else ""
        made.append(Place(name=f"{name}{again}", position=(x, y), z_m=z))
        nearest = np.minimum(nearest, _path_lengths(traversability, cell))
    return made


def _namer(grid: LayeredGrid, traversability: Traversability, start: int) -> PlaceNamer:
    reached = spread_wave(traversability, start) != UNREACHED
    return PlaceNamer(centres(traversability)[reached], storeys_of(grid, reached))


def _path_lengths(traversability: Traversability, cell: int) -> NDArray[np.float32]:
    """The length of the path to each cell, metres, float32 (N,).

    It is -1 for cells that no path leads to, and for those that are not stable.
    """
    left = spread_wave(traversability, cell)
    lengths = metres(traversability, left)
    lengths[(left == UNREACHED) | (traversability.classes != Stability.STABLE)] = -1.0
    return lengths


def _scene_text(scene: Scene) -> str:
    """The text of the scene file, with one line for each part so that it is easy to edit."""
    fields = scene.model_dump(mode="json", exclude_defaults=True)
    lines = []
    for key, value in fields.items():
        text = json.dumps(value, ensure_ascii=False)
        if value and isinstance(value, list) and isinstance(value[0], dict):
            parts = ",\n".join(f"    {json.dumps(part, ensure_ascii=False)}" for part in value)
            text = f"[\n{parts}\n  ]"
        lines.append(f"  {json.dumps(key)}: {text}")
    return "{\n" + ",\n".join(lines) + "\n}\n"


def _rounded(traversability: Traversability, cell: int) -> Point:
    x, y, z = (round(float(value), 3) for value in centres(traversability)[cell])
    return x, y, z
