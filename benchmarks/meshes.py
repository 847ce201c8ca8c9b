"""Paths on meshes, compared with those of a navigation mesh of Recast and Detour.

    python -m benchmarks.meshes                              a thousand pairs on every mesh
    python -m benchmarks.meshes --mesh house.obj --body child --plots pictures

Both planners answer the same random pairs of points on the ground. The benchmark compares whether
a path exists, its length, and the time of the answer. Every disagreement is listed with the rule
that causes it, and with the point up to which the refusing planner gets. Both plan for one body
with its radius, height and step-on height, and neither uses slopes above 45 degrees. An end is
valid if the body can stand within 0.5 m of it on the map and 1 m in height. Times are processor
times of compiled code. The exit code is 1 if a disagreement stays unexplained.
"""

import argparse
import json
import os
import sys
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict
from functools import reduce
from operator import getitem
from pathlib import Path
from typing import Any, Final

from benchmarks._comparison import UNEXPLAINED, Comparison, compare, random_pairs
from benchmarks._detour import Detour, NavMeshSettings
from benchmarks._esplanade import Esplanade
from benchmarks._node_process import recast_missing
from benchmarks._pairs import Finders
from benchmarks._pictures import draw
from rich import box
from rich.console import Console
from rich.table import Table

from esplanade.planning import Body
from esplanade.planning.scene.mesh_file import read_triangles

PROJECT: Final = Path(__file__).resolve().parents[1]
BODIES: Final = {"adult": Body.adult(), "child": Body.child()}
SUFFIXES: Final = (".obj", ".gltf", ".glb")

ROWS: Final = (
    ("import, ms", ("import", "ms"), "{:.0f}"),
    ("  theirs", ("import, theirs", "ms"), "{:.0f}"),
    ("layers", ("import", "layers"), "{:d}"),
    ("cells", ("import", "cells"), "{:d}"),
    ("memory, KiB", ("import", "KiB"), "{:.0f}"),
    ("  theirs", ("import, theirs", "KiB"), "{:.0f}"),
    ("pairs", ("pairs",), "{:d}"),
    *((f"  a path: {finders}", (str(finders),), "{:d}") for finders in Finders),
    ("length / theirs, median", ("length ratio", "p50"), "{:.3f}"),
    ("  p95", ("length ratio", "p95"), "{:.3f}"),
    ("query, median µs", ("us", "p50"), "{:.0f}"),
    ("  p95", ("us", "p95"), "{:.0f}"),
    ("  theirs, median µs", ("us, theirs", "p50"), "{:.0f}"),
    ("  theirs, p95", ("us, theirs", "p95"), "{:.0f}"),
)


def main(argv: Sequence[str] | None = None) -> int:
    options = parser().parse_args(argv)
    paths = options.mesh or standing_meshes()
    absent = recast_missing() or (None if paths else "there are no meshes: name some by --mesh")
    if absent:
        print(f"skipped: {absent}")
        return 0
    console = Console()
    figures: dict[str, dict[str, Any]] = {}
    for path in paths:
        console.print(f"{path.name} ...", style="dim")
        found, measured = measure(path, options)
        figures[path.name] = measured
        list_disagreements(console, found)
    show(console, figures)
    if options.json is not None:
        options.json.write_text(json.dumps(figures, indent=1, allow_nan=False) + "\n")
    refusals = [refusal for each in figures.values() for refusal in each["disagreements"]]
    return int(any(refusal["why"] == UNEXPLAINED for refusal in refusals))


def parser() -> argparse.ArgumentParser:
    """The options."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.meshes", description=__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("--mesh", type=Path, nargs="+", metavar="F", help="OBJ, glTF or GLB")
    parser.add_argument("--up", choices=("y", "z"), default="y", help="the axis that is up")
    parser.add_argument("--pairs", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--body", choices=BODIES, default="adult")
    parser.add_argument("--cell", type=float, default=0.25, metavar="M", help="side of our cells")
    parser.add_argument("--json", type=Path, metavar="F")
    parser.add_argument("--plots", type=Path, metavar="DIR", help="draw one of each reason, as PNG")
    return parser


def standing_meshes() -> list[Path]:
    """The meshes beside the recorded crowds; `ESPLANADE_RECORDINGS` names another folder."""
    elsewhere = PROJECT.parent / "shared" / "data"
    data = Path(os.environ.get("ESPLANADE_RECORDINGS", elsewhere))
    return sorted(path for path in data.glob("meshes/*") if path.suffix.lower() in SUFFIXES)


def measure(path: Path, options: argparse.Namespace) -> tuple[Comparison, dict[str, Any]]:
    """Compare the planners on one mesh; draw pictures if the options ask for them."""
    body = BODIES[options.body]
    ours = Esplanade(path, options.up, options.cell, body)
    settings = NavMeshSettings(
        body.radius_m, body.height_m, body.step_on_m, cell_m=body.radius_m / 2.0
    )
    mesh = read_triangles(path, options.up)
    with Detour(mesh, settings) as theirs:
        pairs = random_pairs(mesh, (ours, theirs), options.pairs, options.seed)
        found = compare(ours, theirs, pairs)
        if options.plots is not None:
            picture_each_reason(options.plots, path.stem, found, ours, theirs)
        figures = found.figures() | {
            "import": dict(ours.build_figures),
            "import, theirs": dict(theirs.build_figures),
            "disagreements": [asdict(refusal) for refusal in found.disagreements],
        }
    return found, figures


def picture_each_reason(
    folder: Path, name: str, found: Comparison, ours: Esplanade, theirs: Detour
) -> None:
    """Draw the first disagreement of every kind."""
    triangles = theirs.triangles()
    firsts = {(refusal.finders, refusal.why): refusal for refusal in reversed(found.disagreements)}
    for (finders, why), refusal in firsts.items():
        answers = found.ours if finders is Finders.ONLY_OURS else found.theirs
        file = folder / f"{name}, {finders}, {why}.png".replace(", ", "-").replace(" ", "_")
        draw(file, name, refusal, answers[refusal.number].points, ours.cells(), triangles)


def list_disagreements(console: Console, found: Comparison) -> None:
    """Print the number of disagreements of each kind, and every one with its points."""
    kinds = Counter((refusal.finders, refusal.why) for refusal in found.disagreements)
    for (finders, why), count in kinds.most_common():
        console.print(f"  {count:4d} {finders}: {why}")
        for refusal in found.disagreements:
            if (refusal.finders, refusal.why) == (finders, why):
                start, goal, gap = map(point, (refusal.start, refusal.goal, refusal.gap))
                line = f"       {refusal.number:4d} {start} to {goal}, gap at {gap}"
                console.print(line, highlight=False, soft_wrap=True)


def point(xyz: Sequence[float]) -> str:
    """The coordinates as text."""
    return "(" + ", ".join(f"{value:.2f}" for value in xyz) + ")"


def show(console: Console, figures: dict[str, dict[str, Any]]) -> None:
    """Print a table with a column for every mesh."""
    table = Table(box=box.SIMPLE, padding=(0, 0, 0, 1))
    table.add_column("", no_wrap=True)
    for name in figures:
        table.add_column(Path(name).stem, justify="right")
    for title, keys, shape in ROWS:
        values: list[Any] = [reduce(getitem, keys, measured) for measured in figures.values()]
        table.add_row(title, *("–" if v is None else shape.format(v) for v in values))
    console.print(table)


if __name__ == "__main__":
    sys.exit(main())
