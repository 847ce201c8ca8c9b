"""The command: helps, refuses with a hint, and imports a part only when it is asked for."""

import subprocess
import sys
from collections.abc import Sequence
from importlib.metadata import entry_points
from types import SimpleNamespace

import pytest

from esplanade import __version__, cli


@pytest.mark.parametrize("arguments", [[], ["--help"], ["-h"], ["help"]])
def test_help_names_every_command(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(arguments) == 0
    shown = capsys.readouterr().out
    for name, command in cli.COMMANDS.items():
        assert f"  {name} " in shown
        assert command.summary in shown


def test_help_imports_no_part() -> None:
    program = (
        "import sys, esplanade.cli; esplanade.cli.main(['--help']); "
        "sys.exit(any(m.split('.')[0] in {'server', 'bots', 'planning', 'numba', 'numpy'}"
        " for m in sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", program], check=False, capture_output=True)
    assert done.returncode == 0


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["--version"]) == 0
    assert capsys.readouterr().out == f"esplanade {__version__}\n"


@pytest.mark.parametrize(
    ("typed", "meant"), [("srve", "serve"), ("bot", "bots"), ("Demo", "demo"), ("xyzzy", None)]
)
def test_unknown_command_is_refused_with_a_hint(
    typed: str, meant: str | None, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main([typed]) == cli.EXIT_USAGE
    shown = capsys.readouterr()
    assert shown.out == ""
    assert f"unknown command '{typed}'" in shown.err
    assert (f"`{meant}`" in shown.err) if meant else ("Did you mean" not in shown.err)


def test_unknown_option_is_called_an_option(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["--verbose"]) == cli.EXIT_USAGE
    assert "unknown option '--verbose'" in capsys.readouterr().err


def test_command_gets_the_rest_of_the_line_and_gives_the_exit_code(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    received: list[Sequence[str]] = []

    def run(argv: Sequence[str]) -> int:
        received.append(argv)
        return 3

    monkeypatch.setattr(cli, "import_module", lambda name: SimpleNamespace(run=run, name=name))
    assert cli.main(["serve", "--port", "9000"]) == 3
    assert received == [["--port", "9000"]]


def test_interrupt_ends_without_a_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    def run(argv: Sequence[str]) -> int:
        raise KeyboardInterrupt

    monkeypatch.setattr(cli, "import_module", lambda name: SimpleNamespace(run=run))
    assert cli.main(["bots"]) == cli.EXIT_INTERRUPTED


@pytest.mark.parametrize("name", list(cli.COMMANDS))
def test_every_command_explains_itself(name: str) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "esplanade", name, "--help"],
        check=False,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    assert f"esplanade {name}" in done.stdout


def test_script_is_the_command() -> None:
    (script,) = entry_points(group="console_scripts", name="esplanade")
    assert script.load() is cli.main
