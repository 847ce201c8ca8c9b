"""How long meshes of two million triangles take to become scenes, and how much memory.

    python -m benchmarks.importing                           every kind
    python -m benchmarks.importing --kinds city --triangles 200000
    python -m benchmarks.importing --beside ../before        another clone's import in turn with it

Meshes are made from a seed: little hills, a large terrain, a building of twelve storeys, a city,
rubble; the hills as OBJ too, others as GLB. Each is imported in a process of its own, which has
imported a small mesh before, so that no kernel is compiled on the way; the processor time is that
of the import, the memory the greatest of the whole process. The exit code is 1 if an import takes
more than 20 s or 2 GB.
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
from benchmarks._mesh_kinds import KINDS, sheet
from rich.console import Console
from rich.table import Table

from esplanade.scenery.meshes import as_glb

MOST_S: Final = 20.0
MOST_BYTES: Final = 2e9


def main(argv: Sequence[str] | None = None) -> int:
    """Make the meshes and import them; returns the exit code."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--triangles", type=int, default=2_000_000)
    parser.add_argument("--kinds", nargs="+", choices=[*KINDS, "obj"], default=["obj", *KINDS])
    parser.add_argument("--beside", type=Path, help="another clone of Esplanade, to compare with")
    parser.add_argument("--one", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args(argv)
    if options.one:
        print(json.dumps(_import_one(options.one)))
        return 0
    table = Table("", "processor s", "wall s", "memory MB", box=None)
    good = True
    with tempfile.TemporaryDirectory() as folder:
        for kind in options.kinds:
            path = Path(folder, f"{kind}.obj" if kind == "obj" else f"{kind}.glb")
            _write(path, KINDS["hills" if kind == "obj" else kind](options.triangles))
            if options.beside:
                table.add_row(f"{kind}, beside", *_cells(measured(path, options.beside)))
            found = measured(path)
            table.add_row(kind, *_cells(found))
            good &= found["processor_s"] <= MOST_S and found["memory"] <= MOST_BYTES
            path.unlink()
    Console().print(table)
    return 0 if good else 1


def measured(path: Path, clone: Path | None = None) -> dict[str, Any]:
    """Import a mesh in a process of its own, with the sources of a clone if one is given."""
    command = [sys.executable, "-m", "benchmarks.importing", "--one", str(path)]
    env = dict(os.environ)
    if clone is not None:
        env["PYTHONPATH"] = os.pathsep.join((str(clone / "src"), str(Path(__file__).parents[1])))
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=env)
    found: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return found


def _import_one(path: Path) -> dict[str, Any]:
    small = path.with_name("small.glb")
    _write(small, sheet((0, 0, 0), (9, 0, 0), (0, 9, 0), 4, 4))
    _import(small)
    processor, wall = time.process_time(), time.perf_counter()
    _import(path)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return {
        "processor_s": time.process_time() - processor,
        "wall_s": time.perf_counter() - wall,
        "memory": peak if sys.platform == "darwin" else 1024 * peak,
    }


def _import(path: Path) -> None:
    from esplanade.scenery.importing import import_mesh  # noqa: PLC0415

    out = path.with_name(f"{path.stem}-scene.json")
    import_mesh(path, out, "y", 1.0, 0.25, None, None, 2, lambda *_: None)


def _write(path: Path, triangles: np.ndarray[Any, np.dtype[np.float64]]) -> None:
    """Write triangles, z up, as GLB, or as OBJ with shared corners; both y up."""
    if path.suffix == ".glb":
        path.write_bytes(as_glb({"mesh": triangles}))
        return
    corners, numbers = np.unique(triangles.reshape(-1, 3), axis=0, return_inverse=True)
    with path.open("w", encoding="ascii") as file:
        np.savetxt(file, corners[:, [0, 2, 1]] * (1, 1, -1), fmt="v %.4f %.4f %.4f")
        np.savetxt(file, numbers.reshape(-1, 3) + 1, fmt="f %d %d %d")


def _cells(found: dict[str, Any]) -> tuple[str, str, str]:
    memory = f"{found['memory'] / 1e6:.0f}"
    return f"{found['processor_s']:.1f}", f"{found['wall_s']:.1f}", memory


if __name__ == "__main__":
    raise SystemExit(main())
