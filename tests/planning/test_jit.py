"""Where compiled kernels are kept: apart for every way of compiling them."""

import os
import subprocess
import sys

import pytest

from planning import _jit
from planning._jit import kernel
from tests.planning.worlds import COMPILED

SHOW = "from planning import _jit; import numba; print(numba.config.CACHE_DIR)"


def folder(**environment: str) -> str:
    variables = {k: v for k, v in os.environ.items() if not k.startswith("NUMBA_")}
    done = subprocess.run(
        [sys.executable, "-c", SHOW],
        env={**variables, **environment},
        check=True,
        capture_output=True,
        text=True,
    )
    return done.stdout.strip()


def test_kernels_with_checked_bounds_are_kept_apart() -> None:
    plain = folder()
    assert "kernels-" in plain
    assert folder() == plain
    assert folder(NUMBA_BOUNDSCHECK="1") != plain


@pytest.mark.parametrize(
    "edited",
    [
        "planning/_one_kernels.py",
        "actors/locomotion/_a_kernels.py",
        "actors/locomotion/skeleton.py",
    ],
)
def test_an_edit_of_any_kernel_leads_to_another_folder(edited, tmp_path, monkeypatch) -> None:
    for folder in ("planning", "actors/locomotion"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / edited).write_text("a = 1")
    monkeypatch.setattr(_jit, "__file__", str(tmp_path / "planning" / "_jit.py"))
    before = _jit._source_digest()
    assert _jit._source_digest() == before
    (tmp_path / edited).write_text("a = 2")
    assert _jit._source_digest() != before


def test_a_kernel_computes() -> None:
    @kernel
    def twice(x: float) -> float:
        return 2.0 * x

    assert twice(1.5) == 3.0
    assert hasattr(twice, "nopython_signatures") == COMPILED
