"""The command: helps, refuses with a hint, and imports a part only when it is asked for."""

from argparse import Namespace
from importlib.metadata import entry_points

import pytest

from esplanade import __main__, __version__, cli
from esplanade import options as commands
from esplanade.commandline import exit_codes
from esplanade.commandline.errors import CommandError, UsageError
from esplanade.server import options


@pytest.mark.parametrize("arguments", [[], ["--help"], ["-h"], ["help"]])
def test_help_names_every_command(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(arguments) == 0
    shown = capsys.readouterr().out
    for name, command in cli.COMMANDS.items():
        assert f"  {name} " in shown
        assert command.summary in shown


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["--version"]) == 0
    assert capsys.readouterr().out == f"esplanade {__version__}\n"


@pytest.mark.parametrize(
    ("typed", "meant"), [("srve", "serve"), ("bot", "bots"), ("Demo", "demo"), ("xyzzy", None)]
)
def test_unknown_command_is_refused_with_a_hint(
    typed: str, meant: str | None, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main([typed]) == exit_codes.USAGE
    shown = capsys.readouterr()
    assert shown.out == ""
    assert f"there is no command {typed}" in shown.err
    assert (
        (f"did you mean {meant}? see" in shown.err) if meant else ("did you mean" not in shown.err)
    )


def test_unknown_option_is_called_an_option(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["--verbose"]) == exit_codes.USAGE
    assert "there is no option --verbose" in capsys.readouterr().err


def command_that(monkeypatch: pytest.MonkeyPatch, outcome: int | BaseException) -> list[Namespace]:
    """Put a command in the place of `serve`; the options that it is given."""
    received: list[Namespace] = []

    def run(found: Namespace) -> int:
        received.append(found)
        if isinstance(outcome, BaseException):
            raise outcome
        return outcome

    monkeypatch.setattr(options, "stand_in", run, raising=False)
    parser = options.parser()
    parser.set_defaults(run="esplanade.server.options:stand_in")
    monkeypatch.setattr(commands, "serve", lambda: parser)
    return received


def test_command_gets_its_options_and_gives_the_exit_code(monkeypatch: pytest.MonkeyPatch) -> None:
    received = command_that(monkeypatch, 3)
    assert cli.main(["serve", "--port", "9000"]) == 3
    assert received[0].port == 9000


@pytest.mark.parametrize(
    ("fault", "code", "said"),
    [
        (UsageError("no such scene"), exit_codes.USAGE, "esplanade serve: no such scene\n"),
        (CommandError("a\nb"), exit_codes.FAILED, "esplanade serve: a\nesplanade serve: b\n"),
        (KeyboardInterrupt(), exit_codes.INTERRUPTED, ""),
    ],
)
def test_faults_are_told_with_the_name_of_the_command(
    fault: BaseException,
    code: int,
    said: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    command_that(monkeypatch, fault)
    assert cli.main(["serve"]) == code
    assert capsys.readouterr().err == said


def test_script_is_the_command() -> None:
    (script,) = entry_points(group="console_scripts", name="esplanade")
    assert script.load() is __main__.main
