"""Meshes turned about the vertical: whether tools, people and actors find the same ways."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

import numpy as np
from benchmarks import _four_answers as four
from benchmarks._detour import Detour
from benchmarks._turned_scenes import Case
from benchmarks._turned_tables import RECAST, Tables, recast_settings
from benchmarks.meshes import standing_meshes
from benchmarks.turned_meshes import drawn_pairs, ours_on, turn
from rich import box
from rich.table import Table

from esplanade.commandline.progress import progress
from esplanade.planning import Body, LayeredGrid, Scene
from esplanade.planning.scene.mesh_file import read_triangles

NAMES: Final = ("tool", "person", "actor")
_CELL_M: Final = 0.25
_MARGIN_M: Final = 1.0


def measure_meshes(tables: Tables, meshes: Sequence[Path], pairs: int, seed: int) -> dict[str, Any]:
    """Print how many of the pairs of points have a way for each, on every mesh, at every angle."""
    paths = list(meshes) or standing_meshes()
    if not paths:
        tables.console.print("skipped: there are no meshes: name some by --mesh")
    return {path.stem: _measure(tables, path, pairs, seed) for path in paths}


def _measure(tables: Tables, path: Path, count: int, seed: int) -> dict[str, Any]:
    body = Body.adult()
    triangles = read_triangles(path)
    names = [*NAMES, *([RECAST] if tables.with_recast else [])]
    table = Table(title=f"{path.stem}: ways of {count} pairs", box=box.SIMPLE, padding=(0, 0, 0, 1))
    for name in ("degrees", *names, "disagreeing"):
        table.add_column(name, justify="right", no_wrap=True)
    figures: dict[str, Any] = {}
    with TemporaryDirectory() as folder, progress(time_left=True) as bar:
        task = bar.add_task(path.stem, total=len(tables.angles) * count)
        pairs = drawn_pairs(triangles, ours_on(triangles, Path(folder), _CELL_M, body), count, seed)
        for degrees in tables.angles:
            turned, ends = turn(triangles, degrees), turn(pairs, degrees)
            grid, scene = _grid_of(turned, Path(folder))
            found = dict.fromkeys(names, 0)
            apart = 0
            for start, goal in ends.tolist():
                case = Case(scene, tuple(start), tuple(goal), body)
                said = {name: four.ANSWERS[name](grid, case) for name in NAMES}
                apart += len(set(said.values())) > 1
                for name, one in said.items():
                    found[name] += one
                bar.advance(task)
            if tables.with_recast:
                with Detour(turned, recast_settings(body)) as theirs:
                    found[RECAST] = sum(answer.found for answer in theirs.find_paths(ends))
            tables.wrong += apart
            figures[f"{degrees:g}"] = {**found, "disagreeing": apart}
            table.add_row(f"{degrees:g}", *(str(found[name]) for name in names), str(apart))
    tables.console.print(table)
    return figures


def _grid_of(triangles: Any, folder: Path) -> tuple[LayeredGrid, Scene]:
    """The grid of triangles (T, 3, 3), and a scene with its bounds and nothing in it."""
    ours_on(triangles, folder, _CELL_M, Body.adult())
    low = triangles.reshape(-1, 3).min(axis=0) - _MARGIN_M
    high = triangles.reshape(-1, 3).max(axis=0) + _MARGIN_M
    scene = Scene(bounds=(*np.floor(low[:2]).tolist(), *np.ceil(high[:2]).tolist()))
    return LayeredGrid.from_mesh(folder / "turned.obj", _CELL_M, "z"), scene
