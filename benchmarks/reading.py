"""How fast files are read: a large table of a crowd, and a mesh of two million triangles.

    python -m benchmarks.reading                     1 GB of CSV, the plain reader beside it, a mesh
    python -m benchmarks.reading --mb 200 --triangles 0

The files are made first, from a seed. Each is read in a process of its own, whose processor time
and greatest memory are told. The plain reader goes line by line, and gets no more than 100 MB: it
refuses larger tables. Last, the table is read once more with a last line that is wrong: the fault
has to name that line. The exit code is 1 if it does not.
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
from rich.console import Console
from rich.table import Table

_PEOPLE: Final = 400
_SAMPLE_S: Final = 0.04
_FRAMES_OF_ONE: Final = 2000
_PLAIN_MB: Final = 100


def main(argv: Sequence[str] | None = None) -> int:
    """Make the files and read them; returns the exit code."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--mb", type=int, default=1000, help="megabytes of the table")
    parser.add_argument("--triangles", type=int, default=2_000_000, help="0 leaves the mesh out")
    parser.add_argument("--one", nargs=2, metavar=("WHAT", "FILE"), help=argparse.SUPPRESS)
    options = parser.parse_args(argv)
    if options.one:
        print(json.dumps(read_one(options.one[0], Path(options.one[1]))))
        return 0
    rows: list[tuple[str, dict[str, Any]]] = []
    with tempfile.TemporaryDirectory() as folder:
        table = Path(folder, "crowd.csv")
        write_table(table, options.mb)
        rows.append((f"table, {options.mb} MB", measured("crowd", table)))
        small = Path(folder, "small.csv")
        write_table(small, min(_PLAIN_MB, options.mb))
        rows.append((f"  the plain reader, {_PLAIN_MB} MB at most", measured("plain", small)))
        with table.open("ab") as file:
            file.write(b"north,1,2,3\n")
        wrong = measured("crowd", table)
        rows.append(("  the same with a wrong last line", wrong))
        if options.triangles:
            mesh = Path(folder, "mesh.obj")
            write_mesh(mesh, options.triangles)
            rows.append(
                (f"mesh, {options.triangles} triangles, to a scene", measured("mesh", mesh))
            )
    _show(rows)
    return 0 if "expected a number" in str(wrong.get("fault")) else 1


def write_table(path: Path, megabytes: int) -> None:
    """Write the samples of a crowd by time, as recordings have them."""
    chance = np.random.default_rng(1)
    who = np.arange(_PEOPLE)
    at = chance.uniform(0.0, (100.0, 50.0), (_PEOPLE, 2))
    pace = chance.normal(0.0, 1.0, (_PEOPLE, 2))
    size = frame = 0
    with path.open("w", encoding="ascii") as file:
        file.write("t,id,x,y\n")
        while size < megabytes * 1e6:
            if frame % _FRAMES_OF_ONE == 0:
                who = who + _PEOPLE
            at += pace * _SAMPLE_S
            time_s = f"{frame * _SAMPLE_S:.2f}"
            lines = [
                f"{time_s},{number},{x:.4f},{y:.4f}\n"
                for number, (x, y) in zip(who.tolist(), at.tolist(), strict=True)
            ]
            size += file.write("".join(lines))
            frame += 1


def write_mesh(path: Path, triangles: int) -> None:
    """Write a ground of little hills as OBJ, y up, in squares of 25 cm."""
    side = max(1, round((triangles / 2) ** 0.5))
    step_m = min(0.25, 600.0 / side)
    x, z = np.meshgrid(np.arange(side + 1) * step_m, np.arange(side + 1) * -step_m)
    y = 0.1 * np.sin(0.5 * x) * np.cos(0.5 * z)
    first = (np.arange(side)[:, None] * (side + 1) + np.arange(side) + 1).reshape(-1)
    with path.open("w", encoding="ascii") as file:
        np.savetxt(file, np.stack([x, y, z], axis=-1).reshape(-1, 3), fmt="v %.4f %.4f %.4f")
        faces = np.stack([first, first + 1, first + side + 2, first + side + 1], axis=1)
        np.savetxt(file, faces, fmt="f %d %d %d %d")


def measured(what: str, path: Path) -> dict[str, Any]:
    """Read a file in a process of its own."""
    command = [sys.executable, "-m", "benchmarks.reading", "--one", what, str(path)]
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=dict(os.environ))
    found: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return found


def read_one(what: str, path: Path) -> dict[str, Any]:
    """Read a file, and tell times and memory."""
    from esplanade.recordings import RecordingError, large_tables, read_crowd  # noqa: PLC0415

    if what == "plain":
        large_tables.LARGE_BYTES = 2**62  # type: ignore[misc]
    found: dict[str, Any] = {"bytes": path.stat().st_size}
    before = _peak_bytes()
    processor, wall = time.process_time(), time.perf_counter()
    if what == "mesh":
        _import(path)
    else:
        try:
            tracks = read_crowd(path).tracks
            found["arrays"] = sum(t.times.nbytes + t.positions.nbytes for t in tracks)
        except RecordingError as error:
            found["fault"] = str(error)
    found["processor_s"] = time.process_time() - processor
    found["wall_s"] = time.perf_counter() - wall
    found["memory"] = _peak_bytes() - before
    return found


def _import(path: Path) -> None:
    from esplanade.scenery.importing import import_mesh  # noqa: PLC0415

    import_mesh(
        path, path.with_suffix(".json"), "y", 1.0, 0.25, None, None, 2, lambda *_: None, False
    )


def _peak_bytes() -> int:
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else 1024 * peak


def _show(rows: list[tuple[str, dict[str, Any]]]) -> None:
    table = Table("", "processor s", "wall s", "MB/s", "memory MB", "of the arrays", box=None)
    for name, found in rows:
        arrays = found.get("arrays")
        table.add_row(
            name,
            f"{found['processor_s']:.1f}",
            f"{found['wall_s']:.1f}",
            f"{found['bytes'] / 1e6 / found['processor_s']:.0f}",
            f"{found['memory'] / 1e6:.0f}",
            f"{found['memory'] / arrays:.2f}" if arrays else "",
        )
    console = Console()
    console.print(table)
    for name, found in rows:
        if fault := found.get("fault"):
            console.print(f"{name.strip()}: {fault}", soft_wrap=True, markup=False)


if __name__ == "__main__":
    raise SystemExit(main())
