"""Ways on meshes that are turned about the vertical: ours, and those of Recast.

    python -m benchmarks.turned_meshes                       three hundred pairs on every mesh
    python -m benchmarks.turned_meshes --mesh house.obj --angles 0 27 45
    python -m benchmarks.turned_meshes --edge-cells 10000    without the rule of edges

What can be walked must not depend on how a building lies in the grid. Pairs of points are drawn on
the mesh as it is, where the body fits as we see it, and turned along with it. For every angle
the table says how many of the ways of the unturned mesh are found, how many are lost and won, and
how much longer or shorter they become at most. Recast has cells of 0.05 m.
"""

import argparse
import dataclasses
import sys
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

import numpy as np
import trimesh
from benchmarks._detour import Detour, NavMeshSettings
from benchmarks._esplanade import Esplanade
from benchmarks._node_process import recast_missing
from benchmarks._pairs import SHORTEST_M, Answer, Floats, ground_points, pairs_of
from benchmarks.meshes import BODIES, standing_meshes
from rich import box
from rich.console import Console
from rich.table import Table

from esplanade.planning import Body
from esplanade.planning.scene.mesh_file import read_triangles

ANGLES_DEG: Final = (0.0, 9.0, 18.0, 27.0, 36.0, 45.0, 54.0, 63.0, 72.0, 81.0, 90.0)
RECAST_CELL_M: Final = 0.05
CANDIDATES: Final = 6
MOVED_M: Final = 0.05
"""An end that is moved further is none at which the body fits."""


def main(argv: Sequence[str] | None = None) -> int:
    options = parser().parse_args(argv)
    paths = options.mesh or standing_meshes()
    if not paths:
        print("skipped: there are no meshes: name some by --mesh")
        return 0
    with_recast = not options.ours and recast_missing() is None
    if not with_recast:
        print(f"without Recast: {recast_missing() or 'not asked for'}")
    console = Console()
    for path in paths:
        measure(console, path, options, with_recast)
    return 0


def parser() -> argparse.ArgumentParser:
    """The options."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.turned_meshes", description=__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("--mesh", type=Path, nargs="+", metavar="F", help="OBJ, glTF or GLB")
    parser.add_argument("--up", choices=("y", "z"), default="y", help="the axis that is up")
    parser.add_argument("--angles", type=float, nargs="+", default=ANGLES_DEG, metavar="DEG")
    parser.add_argument("--pairs", type=int, default=300)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--body", choices=BODIES, default="adult")
    parser.add_argument(
        "--edge-cells",
        type=int,
        metavar="M",
        help="so many cells on edges in a row, not the body's",
    )
    parser.add_argument("--cell", type=float, default=0.25, metavar="M", help="side of our cells")
    parser.add_argument("--ours", action="store_true", help="leave Recast out")
    parser.add_argument("--list", action="store_true", help="list our pairs that are lost and won")
    return parser


def measure(console: Console, path: Path, options: argparse.Namespace, with_recast: bool) -> None:
    """Print the table of one mesh."""
    body = BODIES[options.body]
    if options.edge_cells is not None:
        body = dataclasses.replace(body, edge_cells=options.edge_cells)
    triangles = read_triangles(path, options.up)
    table = Table(title=path.stem, box=box.SIMPLE, padding=(0, 0, 0, 1))
    for title in ("degrees", "found", "lost", "won", "shortest", "longest"):
        table.add_column(title, justify="right", no_wrap=True)
    for title in ("theirs", "lost", "won", "shortest", "longest") if with_recast else ():
        table.add_column(title, justify="right", no_wrap=True)
    with TemporaryDirectory() as folder:
        ours = ours_on(triangles, Path(folder), options.cell, body)
        pairs = drawn_pairs(triangles, ours, options.pairs, options.seed)
        first: list[list[Answer]] = []
        for angle in options.angles:
            turned, ends = turn(triangles, angle), turn(pairs, angle)
            answers = [ours_on(turned, Path(folder), options.cell, body).find_paths(ends)]
            if with_recast:
                with Detour(turned, recast_settings(body)) as theirs:
                    answers.append(theirs.find_paths(ends))
            first = first or answers
            cells = [cell for pair in zip(first, answers, strict=True) for cell in row(*pair)]
            table.add_row(f"{angle:g}", *cells)
            if options.list:
                list_changes(console, angle, pairs, first[0], answers[0])
    console.print(table)


def drawn_pairs(triangles: Floats, ours: Esplanade, count: int, seed: int) -> Floats:
    """Random pairs of points (N, 2, 3) on the ground at which the body fits without being moved."""
    random = np.random.default_rng(seed)
    points = ground_points(triangles, CANDIDATES * count, random)
    found = ours.find_paths(np.stack([points, points], axis=1))
    ends = np.array([answer.points[0] if answer.found else (np.inf,) * 3 for answer in found])
    fits = np.linalg.norm(ends - points, axis=1) < MOVED_M
    return pairs_of(points, fits, count, random)


def recast_settings(body: Body) -> NavMeshSettings:
    """The same body for Recast."""
    return NavMeshSettings(body.radius_m, body.height_m, body.step_on_m, cell_m=RECAST_CELL_M)


def ours_on(triangles: Floats, folder: Path, cell_m: float, body: Body) -> Esplanade:
    """Our planner on triangles, by way of a file."""
    path = folder / "turned.obj"
    corners = triangles.reshape(-1, 3)
    faces = np.arange(len(corners)).reshape(-1, 3)
    trimesh.Trimesh(corners, faces, process=False).export(path)
    return Esplanade(path, "z", cell_m, body)


def turn(points: Floats, degrees: float) -> Floats:
    """Points (..., 3) turned about the vertical through the origin."""
    matrix = trimesh.transformations.rotation_matrix(np.radians(degrees), (0.0, 0.0, 1.0))
    turned: Floats = points @ matrix[:3, :3].T
    return turned


def row(before: list[Answer], after: list[Answer]) -> tuple[str, ...]:
    """Counts of ways that are found, lost and won against before, and ratios of lengths."""
    both = [(a, b) for a, b in zip(before, after, strict=True) if a.found and b.found]
    ratios = [b.length_m / a.length_m for a, b in both if a.length_m >= SHORTEST_M] or [1.0]
    known = sum(a.found for a in before)
    won = sum(b.found and not a.found for a, b in zip(before, after, strict=True))
    lengths = f"{min(ratios):.3f}", f"{max(ratios):.3f}"
    return f"{len(both)} of {known}", str(known - len(both)), str(won), *lengths


def list_changes(
    console: Console, angle: float, pairs: Floats, before: list[Answer], after: list[Answer]
) -> None:
    """Print every pair that is lost or won, or whose length changes by more than 5 %."""
    for number, (a, b) in enumerate(zip(before, after, strict=True)):
        if a.found != b.found:
            word = "won" if b.found else "lost"
            start, goal = (np.round(end, 2).tolist() for end in pairs[number])
            console.print(f"{angle:g}: {word} {number} {start} to {goal} {b.stands}")
        elif a.found and a.length_m >= SHORTEST_M and abs(b.length_m / a.length_m - 1.0) > 0.05:
            lengths = f"{a.length_m:.2f} m becomes {b.length_m:.2f} m"
            console.print(f"{angle:g}: {number} {pairs[number].round(2).tolist()}, {lengths}")


if __name__ == "__main__":
    sys.exit(main())
