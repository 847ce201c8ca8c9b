"""No state of the cache stops a program: what cannot be read is compiled anew."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.planning.worlds import COMPILED

pytestmark = pytest.mark.skipif(not COMPILED, reason="kernels are not compiled here")

MODULE = """
from typing import NamedTuple
from esplanade.planning.compiled.jit import kernel

class Pair(NamedTuple):
    a: float
    b: float

@kernel
def half(x):
    return {half}

@kernel
def total(pair):
    return pair.a + half(pair.b)
"""
ASK = """
import logging
from small import Pair, total
logging.basicConfig(level=logging.INFO, format="%(message)s")
print(total(Pair(1.0, 2.0)))
print(total._cache_hits.total())
"""


class Program:
    """A program with two kernels, run again and again in a home of its own."""

    def __init__(self, folder: Path) -> None:
        self.home = folder / "home"
        self.home.mkdir()
        self.code = folder / "code"
        self.code.mkdir()
        self.write("0.5 * x")

    def write(self, half: str, name: str = "small.py") -> None:
        (self.code / name).write_text(MODULE.format(half=half))

    def start(self, code: str = ASK) -> subprocess.Popen[str]:
        kept = {k: v for k, v in os.environ.items() if not k.startswith("NUMBA_")}
        paths = os.pathsep.join([str(self.code), *sys.path])
        return subprocess.Popen(
            [sys.executable, "-c", code],
            env={**kept, "HOME": str(self.home), "TMPDIR": str(self.home), "PYTHONPATH": paths},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            cwd=self.home,
        )

    def run(self, code: str = ASK) -> tuple[float, int, list[str]]:
        """The result of the program, the number of cache hits, and the lines that were logged."""
        return outcome(self.start(code))

    def entries(self) -> list[Path]:
        return [path for path in self.home.rglob("small.*") if path.is_file()]


def outcome(process: subprocess.Popen[str]) -> tuple[float, int, list[str]]:
    told, logged = process.communicate()
    assert process.returncode == 0, logged
    result, hits = told.split()
    return float(result), int(hits), logged.splitlines()


@pytest.fixture
def program(tmp_path: Path) -> Program:
    return Program(tmp_path)


def test_what_was_compiled_is_kept_and_told_of_once(program: Program) -> None:
    result, hits, logged = program.run()
    assert (result, hits, len(logged)) == (2.0, 0, 1)
    assert "compiling kernels" in logged[0]
    assert str(program.home) in logged[0]
    assert program.run() == (2.0, 1, [])


def test_another_text_of_a_kernel_is_compiled_anew(program: Program) -> None:
    program.run()
    program.write("0.25 * x")
    assert program.run()[:2] == (1.5, 0)


@pytest.mark.parametrize("damage", ["truncated", "empty", "overwritten", "one bit", "a folder"])
def test_a_damaged_entry_is_compiled_anew(program: Program, damage: str) -> None:
    program.run()
    (entry,) = program.entries()
    content = bytearray(entry.read_bytes())
    middle = len(content) // 2
    if damage == "a folder":
        entry.unlink()
        (entry / "in the way").mkdir(parents=True)
    elif damage == "one bit":
        content[middle] ^= 1
        entry.write_bytes(content)
    else:
        entry.write_bytes({"truncated": content[:middle], "empty": b""}.get(damage, b"no kernel"))
    assert program.run()[:2] == (2.0, 0)
    if damage != "a folder":
        assert program.run() == (2.0, 1, [])


def test_an_entry_of_a_type_that_is_gone_stops_nobody(program: Program) -> None:
    program.write("0.5 * x", "other.py")
    program.run(
        "import other, small; small.Pair = other.Pair\n" + ASK.replace("Pair, total", "total, Pair")
    )
    (program.code / "other.py").unlink()
    assert program.run()[0] == 2.0
    assert program.run() == (2.0, 1, [])


def test_a_read_only_folder_is_read(program: Program) -> None:
    program.run()
    read_only = (
        "import errno, pathlib\n"
        "def refuse(*_, **__): raise OSError(errno.EROFS, 'Read-only file system')\n"
        "pathlib.Path.touch = pathlib.Path.write_bytes = refuse\n"
    )
    assert program.run(read_only + ASK) == (2.0, 1, [])
    program.write("0.25 * x")
    assert program.run(read_only + ASK)[:2] == (1.5, 0)


def test_a_full_disk_is_told_of_and_stops_nobody(program: Program) -> None:
    full = (
        "import errno, pathlib\n"
        "def refuse(*_): raise OSError(errno.ENOSPC, 'No space left on device')\n"
        "pathlib.Path.write_bytes = refuse\n"
    )
    result, hits, logged = program.run(full + ASK)
    assert (result, hits) == (2.0, 0)
    assert any("No space left" in line for line in logged)
    assert program.entries() == []


def test_without_any_folder_it_is_compiled_anew(program: Program) -> None:
    (program.home / ".cache").write_text("in the way")
    (program.home / "esplanade").write_text("in the way")
    result, hits, logged = program.run()
    assert (result, hits) == (2.0, 0)
    assert any("no folder" in line for line in logged)


def test_where_nothing_can_be_written_it_is_compiled_anew(program: Program) -> None:
    (program.home / ".cache").write_text("in the way")
    nowhere = "import tempfile\ndef none():\n    raise FileNotFoundError('no usable folder')\n"
    result, hits, logged = program.run(f"{nowhere}tempfile.gettempdir = none\n{ASK}")
    assert (result, hits) == (2.0, 0)
    assert any("no folder" in line for line in logged)


def test_two_that_start_at_once_with_an_empty_cache_both_work(program: Program) -> None:
    both = [program.start(), program.start()]
    assert [outcome(process)[0] for process in both] == [2.0, 2.0]
    assert program.run() == (2.0, 1, [])
    assert len(program.entries()) == 1


def test_the_digest_goes_by_what_changes_compiled_code() -> None:
    ask = "from esplanade.planning.compiled import cache; print(cache.folder().name)"

    def name(**variables: str) -> str:
        kept = {k: v for k, v in os.environ.items() if not k.startswith("NUMBA_")}
        done = subprocess.run(
            [sys.executable, "-c", ask],
            env={**kept, "PYTHONPATH": os.pathsep.join(sys.path), **variables},
            check=True,
            capture_output=True,
            text=True,
        )
        return done.stdout.strip()

    assert name(NUMBA_NUM_THREADS="1") == name()
    assert name(NUMBA_OPT="1") != name()
