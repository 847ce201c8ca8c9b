"""Ctrl-C at any moment ends a command quietly."""

import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from esplanade.commandline import exit_codes, interrupts
from tests.patience import PATIENCE_S

AT_A_MODULE = """
import os, signal, sys
from importlib.abc import MetaPathFinder

class Interrupting(MetaPathFinder):
    def find_spec(self, name, path, target=None):
        if name == module:
            os.kill(os.getpid(), signal.SIGINT)

module, *words = sys.argv[1:]
sys.meta_path.insert(0, Interrupting())
sys.argv = ["esplanade", *words]
signal.signal(signal.SIGINT, signal.default_int_handler)
from esplanade.__main__ import main
raise SystemExit(main())
"""
"""Runs a command, and sends it SIGINT as soon as it begins to import the module."""

ENTERED = """
import sys
from esplanade import __main__
sys.argv[1:] = ["serve", "--port=0", "--private-port=0"]
try:
    print("entered", flush=True)
    sys.exit(__main__.main())
except KeyboardInterrupt:
    sys.exit(130)
"""
"""Runs a world, and says when the command is entered: Ctrl-C before that is Python's own."""


def hear_interrupts() -> None:
    """Tests that run in the background of a shell ignore SIGINT, and so would their children."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@pytest.mark.parametrize(
    ("module", "words"),
    [
        ("esplanade.commandline.interrupts", "serve"),
        ("difflib", "--help"),
        ("argparse", "serve --help"),
        ("esplanade.server.options", "serve"),
        ("pydantic_core", "serve"),
        ("numpy", "scene check scenes/gallery.json"),
        ("numba", "serve"),
        ("numba", "evaluate pyproject.toml"),
        ("rich.progress", "gait plots"),
        ("msgpack", "bots"),
        ("structlog", "demo --port 21811 --private-port 21812"),
    ],
)
def test_while_a_module_is_imported(module: str, words: str) -> None:
    done = subprocess.run(
        [sys.executable, "-c", AT_A_MODULE, module, *words.split()],
        check=False,
        capture_output=True,
        text=True,
        cwd=Path(__file__).parents[2],
        preexec_fn=hear_interrupts,
        timeout=PATIENCE_S,
    )
    assert (done.returncode, done.stderr) == (exit_codes.INTERRUPTED, "")


@pytest.mark.parametrize("after_s", [0.0, 0.05, 0.2, 0.5, 1.0, 2.0])
def test_at_several_moments_after_the_entry(after_s: float) -> None:
    """Whatever it is doing then; before the entry Python itself is starting."""
    process = subprocess.Popen(
        [sys.executable, "-c", ENTERED],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=hear_interrupts,  # noqa: PLW1509 (there are no threads here)
    )
    with process:
        assert process.stdout is not None
        assert process.stdout.readline() == "entered\n"
        time.sleep(after_s)
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=PATIENCE_S)
    # A world that has been open is closed in good order.
    assert process.returncode == exit_codes.INTERRUPTED or "summary" in said
    assert "Traceback" not in said


@pytest.fixture
def _handler() -> Iterator[None]:
    before = signal.getsignal(signal.SIGINT)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("_handler")
def test_a_command_at_work_may_tidy_up() -> None:
    signal.signal(signal.SIGINT, signal.default_int_handler)
    interrupts.end_quietly()
    quiet = signal.getsignal(signal.SIGINT)
    with pytest.raises(KeyboardInterrupt), interrupts.raised():
        signal.raise_signal(signal.SIGINT)
    assert signal.getsignal(signal.SIGINT) is quiet


@pytest.mark.usefixtures("_handler")
def test_whoever_ignores_interrupts_goes_on_ignoring_them() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    interrupts.end_quietly()
    with interrupts.raised():
        signal.raise_signal(signal.SIGINT)
    assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
