"""A second process compiles into the same cache, and never outlives the first."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from esplanade.planning.compiled import beside, cache
from tests.planning.worlds import COMPILED

pytestmark = pytest.mark.skipif(not COMPILED, reason="kernels are not compiled here")

PART = """
from numba import types
from esplanade.planning.compiled.jit import compile_for, kernel

@kernel
def double(x):
    return 2.0 * x

def compile_all():
    compile_for(double, types.float64)
"""
USE = """
heard = []
from esplanade.planning.compiled.beside import compiled_beside
with compiled_beside("part", lambda: heard.append(1)) as wait:
    wait()
from part import double
double(1.5)
print(len(heard), double._cache_hits.total())
"""
LINGER = """
import time
def compile_all():
    open("began", "w").close()
    time.sleep(600)
"""
LEFT = """
import os, pathlib, time
from esplanade.planning.compiled import beside
popen = beside.subprocess.Popen
def noted(*a, **k):
    process = popen(*a, **k)
    print(process.pid, flush=True)
    return process
beside.subprocess.Popen = noted
with beside.compiled_beside("part", lambda: None) as wait:
    while not pathlib.Path("began").exists():
        time.sleep(0.05)
    print("began", flush=True)
    wait()
"""


def start(folder: Path, part: str, code: str) -> subprocess.Popen[str]:
    (folder / "part.py").write_text(part)
    paths = os.pathsep.join([str(folder), *sys.path])
    return subprocess.Popen(
        [sys.executable, "-c", code],
        env={**os.environ, "HOME": str(folder), "PYTHONPATH": paths},
        cwd=folder,
        stdout=subprocess.PIPE,
        text=True,
    )


def is_alive(process: int) -> bool:
    state = subprocess.run(
        ["ps", "-o", "stat=", "-p", str(process)], capture_output=True, text=True, check=False
    )
    return state.stdout.strip()[:1] not in ("", "Z")


def test_what_the_second_process_compiles_is_found_in_the_first(tmp_path: Path) -> None:
    with start(tmp_path, PART, USE) as process:
        assert process.stdout is not None
        heard, hits = process.stdout.read().split()
    assert int(heard) >= 1
    assert int(hits) == 1


def test_a_second_process_that_fails_is_done_without(tmp_path: Path) -> None:
    broken = PART.replace("compile_for(double", "compile_for(nothing")
    with start(tmp_path, broken, USE) as process:
        assert process.stdout is not None
        assert process.stdout.read().split() == ["0", "0"]


def test_the_second_process_ends_with_the_first_even_if_that_is_killed(tmp_path: Path) -> None:
    with start(tmp_path, LINGER, LEFT) as process:
        assert process.stdout is not None
        second = int(process.stdout.readline())
        assert process.stdout.readline() == "began\n"
        process.send_signal(signal.SIGKILL)
    while is_alive(second):
        time.sleep(0.05)


def test_what_is_complete_is_known_to_later_runs(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(cache, "folder", lambda: tmp_path)
    assert not beside.is_complete("served")
    beside.complete("served")
    assert beside.is_complete("served")
    monkeypatch.setattr(cache, "folder", lambda: None)
    assert not beside.is_complete("served")
