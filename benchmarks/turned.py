"""Buildings at any angle: who finds the ways of doors, flights, ramps, plans and meshes.

    python -m benchmarks.turned                       everything
    python -m benchmarks.turned plans --scenes 100    a short run of the random plans alone
    python -m benchmarks.turned flights doors ramps --angles 0 18 45

Parts:

    flights   eight steps up to a floor, by width
    doors     a door in a wall, by width
    ramps     a ramp up to a floor, by width
    edges     low flights on which all counts as edges, by the number of cells M
    plans     random plans in a room, judged by shapely
    meshes    the meshes that --mesh names, turned: ways of tool, people and actors

Every scene is turned and moved by a part of a cell. Each way is asked for in both directions, of
four of ours and of Recast: `find_path` (tool), `scene check` (check), a person who walks along the
route of `walk_to` (person), and a live actor that really goes (actor). On flights and ramps a
person also walks straight on by the keys (keys). The judge of plans is shapely: free is what is
left of the room without everything that is widened by the body's radius. Nothing is asked where
bodies that are 3 cm wider or narrower have different answers. Recast has cells of 0.05 m, and
bodies are whole cells of it wide. The exit code is 1 if one of ours is wrong anywhere.
"""

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from benchmarks._node_process import recast_missing
from benchmarks._turned_meshes import measure_meshes
from benchmarks._turned_tables import Tables, doors, edges, flights, ramps
from benchmarks._turned_trials import measure_plans
from rich.console import Console

ANGLES_DEG: Final = (0.0, 9.0, 18.0, 27.0, 36.0, 45.0, 54.0, 63.0, 72.0, 81.0, 90.0)
PARTS: Final = ("flights", "doors", "ramps", "edges", "plans", "meshes")
WIDTH: Final = 110


def main(argv: Sequence[str] | None = None) -> int:
    options = parser().parse_args(argv)
    unknown = sorted(set(options.parts) - set(PARTS))
    if unknown:
        raise SystemExit(f"{unknown[0]!r} is no part, expected one of {', '.join(PARTS)}")
    absent = "not asked for" if options.ours else recast_missing()
    console = Console(width=None if sys.stdout.isatty() else WIDTH)
    if absent:
        console.print(f"without Recast: {absent}")
    tables = Tables(console, options.angles, with_recast=absent is None)
    one = {"flights": flights, "doors": doors, "ramps": ramps, "edges": edges}
    figures: dict[str, Any] = {}
    for part in options.parts or PARTS:
        if part == "plans":
            figures[part] = measure_plans(tables, options.scenes, options.seed, options.actors)
        elif part == "meshes":
            figures[part] = measure_meshes(tables, options.mesh, options.pairs, options.seed)
        else:
            figures[part] = one[part](tables)
    if options.json is not None:
        options.json.write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")
    return int(tables.wrong > 0)


def parser() -> argparse.ArgumentParser:
    """The options."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.turned", description=__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("parts", nargs="*", metavar="PART", help="[all]")
    parser.add_argument("--scenes", type=int, default=2000, metavar="N", help="plans [2000]")
    parser.add_argument("--angles", type=float, nargs="+", default=ANGLES_DEG, metavar="DEG")
    parser.add_argument("--seed", type=int, default=0, help="of plans and pairs [0]")
    parser.add_argument(
        "--actors", type=int, default=1, metavar="N",
        help="angles of each plan at which a live actor walks, there and back [1]",
    )  # fmt: skip
    parser.add_argument("--mesh", type=Path, nargs="+", default=[], metavar="F")
    parser.add_argument("--pairs", type=int, default=20, help="of points on every mesh [20]")
    parser.add_argument("--ours", action="store_true", help="leave Recast out")
    parser.add_argument("--json", type=Path, metavar="F", help="also write the figures here")
    return parser


if __name__ == "__main__":
    sys.exit(main())
