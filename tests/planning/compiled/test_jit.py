"""Compiled kernels are kept apart for every way of compiling them and for every text of theirs."""

import ast
import os
import shutil
import subprocess
import sys
from pathlib import Path

import esplanade
from esplanade.planning.compiled import cache
from esplanade.planning.compiled.jit import kernel
from tests.planning.worlds import COMPILED

SHOW = "from esplanade.planning.compiled import cache; print(cache.folder())"
PROBE = """
from esplanade.planning.compiled.jit import kernel

@kernel
def probe(falls):
    return falls.landing[0, 0]
"""
ASK = """
import numpy as np
from esplanade.actors.locomotion._probe_kernels import probe
from esplanade.actors.locomotion.planted.footprints import StepFootprints
feet = [np.full((1, 4), float(k)) for k in range(3)]
print(probe(StepFootprints(np.ones(1, np.bool_), *feet, np.ones(1))))
"""
PACKAGE = Path(esplanade.__file__).parent


def python(code: str, **environment: str) -> str:
    variables = {k: v for k, v in os.environ.items() if not k.startswith("NUMBA_")}
    done = subprocess.run(
        [sys.executable, "-c", code],
        env={**variables, **environment},
        check=True,
        capture_output=True,
        text=True,
    )
    return done.stdout.strip()


def imported_by(path: Path) -> set[Path]:
    """Our own modules that a module imports, wherever in it."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text())):
        names = []
        if isinstance(node, ast.ImportFrom) and node.module:
            names = [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
        elif isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        for name in names:
            base = PACKAGE.parent.joinpath(*name.split("."))
            found |= {p for p in (base.with_suffix(".py"), base / "__init__.py") if p.is_file()}
    return found


def test_kernels_with_checked_bounds_are_kept_apart() -> None:
    plain = python(SHOW)
    assert "kernels-" in plain
    assert python(SHOW) == plain
    assert python(SHOW, NUMBA_BOUNDSCHECK="1") != plain


def test_every_file_that_compiled_code_can_reach_is_in_the_digest() -> None:
    reached: set[Path] = set()
    ahead = {p for folder in PACKAGE.iterdir() for p in folder.rglob("*.py")}
    ahead = {path for path in ahead if "compiled.jit import" in path.read_text()}
    assert len(ahead) > 30
    while ahead:
        path = ahead.pop()
        if path not in reached:
            reached.add(path)
            ahead |= imported_by(path)
    outside = {p for p in reached if p.name != "__init__.py"} - set(cache.sources())
    assert not outside


def test_kernels_are_compiled_anew_when_a_helper_changes(tmp_path) -> None:
    """Two fields of a record change places in a copy: its kernels must read the other one."""
    copy = tmp_path / "esplanade"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("client_assets", "__pycache__"))
    (copy / "actors" / "locomotion" / "_probe_kernels.py").write_text(PROBE)
    at = {"PYTHONPATH": str(tmp_path), "HOME": str(tmp_path)}
    assert python(ASK, **at) == "2.0"
    helper = copy / "actors" / "locomotion" / "planted" / "footprints.py"
    text = helper.read_text()
    swapped = text.replace("lifted: Floats", "_: Floats").replace(
        "landing: Floats", "lifted: Floats"
    )
    helper.write_text(swapped.replace("_: Floats", "landing: Floats"))
    assert python(ASK, **at) == "0.0"


def test_a_kernel_computes() -> None:
    @kernel
    def twice(x: float) -> float:
        return 2.0 * x

    assert twice(1.5) == 3.0
    assert hasattr(twice, "nopython_signatures") == COMPILED
