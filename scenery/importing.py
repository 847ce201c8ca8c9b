"""Import of a mesh as a scene: floors are derived, a spawn is chosen, and places are spread."""

import math
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.commandline.errors import UsageError
from esplanade.planning import LayeredGrid, Scene
from esplanade.planning.routes.storey_heights import storeys_of
from esplanade.planning.scene.bodies import Body
from esplanade.planning.scene.mesh_file import Mesh, MeshError, Up, read_mesh
from esplanade.planning.scene.scene import Bounds, Place, Spawn
from esplanade.planning.traversal.stability import Stability
from esplanade.planning.traversal.traversability import Traversability
from esplanade.planning.traversal.wavefront import UNREACHED, metres, spread_wave
from esplanade.scenery.meshes import as_glb
from esplanade.scenery.place_names import PlaceNamer
from esplanade.scenery.reach import cell_near, centres, largest_region
from esplanade.scenery.scene_text import scene_text
from esplanade.scenery.values import Point

_SPAWN_RADIUS_M = 1.0
NAME_LENGTH = 64


class Imported(NamedTuple):
    """A scene made of a mesh, with what it was made of."""

    scene: Scene
    grid: LayeredGrid
    mesh: Mesh


def import_mesh(
    source: Path,
    target: Path,
    up: Up | None,
    metres_a_unit: float,
    cell_m: float,
    name: str | None,
    spawn: Point | None,
    places: int,
    report: Callable[[str, float], None],
    recentre: bool = False,
) -> Imported:
    """Make a scene of a mesh, and write both: the scene, and the mesh beside it as GLB.

    The scene contains no floors, since they are derived from the mesh whenever it is read.

    Parameters
    ----------
    source : the mesh, in any form that `read_mesh` reads
    target : the scene file to write
    up : the axis of the mesh that is up, `y` or `z`; None takes what is usual for its form
    metres_a_unit : the length of the unit of the mesh, metres
    cell_m : the size of the cells that the mesh is examined with
    name : the name of the scene; None takes that of the mesh
    spawn : where people enter; None chooses a point amid the largest region
    places : the greatest number of places to make
    report : is called with the current activity and the fraction of the whole that is done
    recentre : moves the middle of the mesh to the origin, and keeps in the scene by how much

    Raises
    ------
    UsageError
        The mesh cannot be used, nobody can stand at the spawn, or a file cannot be written.
    """
    kept = target.with_suffix(".glb")
    if kept.resolve() == source.resolve() and (up == "z" or metres_a_unit != 1.0 or recentre):
        raise UsageError(f"--out: {kept.name} would be written over the mesh itself")
    report(f"reading {source.name}", 0.0)
    try:
        read = read_mesh(source, up, metres_a_unit, recentre)
    except MeshError as error:
        raise UsageError(f"{error}; check --up and --scale") from None
    mesh = as_glb({"mesh": read.triangles})
    # The floors must be those of the GLB file that is kept, which may differ from the original.
    with TemporaryDirectory() as folder:
        copy = Path(folder) / kept.name
        copy.write_bytes(mesh)
        try:
            grid = LayeredGrid.from_mesh(
                copy, cell_m, "y", lambda activity, share: report(activity, _overall(share))
            )
        except MeshError as error:
            words = str(error).replace(kept.name, source.name)
            raise UsageError(f"{words}; check --up and --scale") from None
    report("choosing places", _overall(1.0))
    traversability = grid.traversability.of(Body.adult())
    start = _spawn_cell(traversability, spawn)
    x, y, z = _rounded(traversability, start)
    scene = Scene(
        name=(name or source.stem)[:NAME_LENGTH],
        bounds=_whole_metres(grid.bounds),
        mesh=Path(kept.name),
        spawns=(Spawn(position=(x, y), z_m=z, radius_m=_SPAWN_RADIUS_M),),
        places=tuple(_places(traversability, start, _namer(grid, traversability, start), places)),
        origin_m=read.offset_m,
    )
    report(f"writing {target.name}", 0.95)
    try:
        kept.write_bytes(mesh)
        target.write_text(scene_text(scene), encoding="utf-8")
    except OSError as error:
        raise UsageError(f"--out: {error}") from None
    return Imported(scene, grid, read)


def with_places(
    scene: Scene, cell_m: float, spawn: Point | None, places: int
) -> tuple[Scene, LayeredGrid]:
    """A scene with a spawn, and with places spread over it where it has none; and its grid.

    Raises
    ------
    UsageError
        Nobody can stand at the spawn.
    """
    grid = LayeredGrid.from_scene(scene, cell_m)
    traversability = grid.traversability.of(Body.adult())
    start = _spawn_cell(traversability, spawn)
    x, y, z = _rounded(traversability, start)
    spread = _places(traversability, start, _namer(grid, traversability, start), places)
    made = scene.model_copy(
        update={
            "spawns": (Spawn(position=(x, y), z_m=z, radius_m=_SPAWN_RADIUS_M),),
            "places": scene.places or tuple(spread),
        }
    )
    return made, grid


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
        raise UsageError("an adult can stand nowhere in it; is --up or --scale right?")
    cells = np.flatnonzero(region)
    points = centres(traversability, cells)
    points -= points.mean(axis=0)
    return int(cells[np.einsum("nk,nk->n", points, points).argmin()])


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
    points = centres(traversability, np.flatnonzero(reached))
    return PlaceNamer(points, storeys_of(grid, reached))


def _path_lengths(traversability: Traversability, cell: int) -> NDArray[np.float32]:
    """The length of the path to each cell, metres, float32 (N,).

    It is -1 for cells that no path leads to, and for those that are not stable.
    """
    left = spread_wave(traversability, cell)
    lengths = metres(traversability, left)
    lengths[(left == UNREACHED) | (traversability.classes != Stability.STABLE)] = -1.0
    return lengths


def _rounded(traversability: Traversability, cell: int) -> Point:
    centre = centres(traversability, np.array([cell]))[0]
    x, y, z = (round(float(value), 3) for value in centre)
    return x, y, z
