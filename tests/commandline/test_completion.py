"""Shell completion: what is offered, asked of the shells that are here."""

import shutil
import subprocess
from pathlib import Path

import pytest

from esplanade.cli import COMMANDS, main
from esplanade.commandline import exit_codes

SHELLS = ("bash", "zsh", "fish")

BASH = r"""
source "$1"
shift
COMP_WORDS=("$@")
COMP_CWORD=$(($# - 1))
COMP_LINE="$*"
COMP_POINT=${#COMP_LINE}
$(complete -p esplanade | sed -E 's/.*-F ([^ ]+).*/\1/')
printf '%s\n' "${COMPREPLY[@]}"
"""


@pytest.fixture
def script(
    request: pytest.FixtureRequest, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> Path:
    """The script for a shell; the test is left out where that shell is absent."""
    shell: str = request.param
    assert main(["completion", shell]) == exit_codes.OK
    path = tmp_path / f"esplanade.{shell}"
    path.write_text(capsys.readouterr().out)
    if shutil.which(shell) is None:
        pytest.skip(f"{shell} is absent")
    return path


def offered_by_bash(script: Path, *words: str) -> list[str]:
    done = subprocess.run(
        ["bash", "-c", BASH, "bash", script, *words], check=True, capture_output=True, text=True
    )
    return [word.strip() for word in done.stdout.split()]


@pytest.mark.parametrize("script", ["bash"], indirect=True)
def test_bash_offers_commands_options_and_choices(script: Path) -> None:
    assert set(offered_by_bash(script, "esplanade", "")) >= set(COMMANDS)
    assert "--tick-rate" in offered_by_bash(script, "esplanade", "serve", "--tick")
    assert set(offered_by_bash(script, "esplanade", "scene", "")) >= {"check", "render", "import"}
    assert "--cell" in offered_by_bash(script, "esplanade", "scene", "check", "--c")
    assert "warning" in offered_by_bash(script, "esplanade", "serve", "--log-level", "w")
    assert "--visitors" in offered_by_bash(script, "esplanade", "demo", "--")
    assert set(offered_by_bash(script, "esplanade", "op", "user", "")) >= {"add", "list"}
    assert set(offered_by_bash(script, "esplanade", "op", "preset", "")) >= {"apply", "import"}
    assert "--guard" in offered_by_bash(script, "esplanade", "op", "preset", "apply", "--g")
    assert "close" in offered_by_bash(script, "esplanade", "op", "door", "lobby", "c")
    assert set(offered_by_bash(script, "esplanade", "op", "")) >= {
        *("login", "logout", "watch", "people", "warn", "walk-out", "ban", "unban", "bans"),
    }
    assert set(offered_by_bash(script, "esplanade", "op", "watch", "")) >= {"events", "changes"}
    assert "late_tick" in offered_by_bash(script, "esplanade", "op", "watch", "--kind", "l")
    assert "address" in offered_by_bash(script, "esplanade", "op", "ban", "Eve", "--by", "a")
    assert "--with-token" in offered_by_bash(script, "esplanade", "op", "login", "--w")
    assert "--verify" in offered_by_bash(script, "esplanade", "op", "audit", "--")
    assert "auditor" in offered_by_bash(script, "esplanade", "op", "user", "add", "--role", "a")


@pytest.mark.parametrize("script", ["fish"], indirect=True)
def test_fish_offers_commands_options_and_choices(script: Path) -> None:
    def offered(line: str) -> set[str]:
        ask = f"source {script}; complete --do-complete '{line}'"
        done = subprocess.run(["fish", "-c", ask], check=True, capture_output=True, text=True)
        return {row.split("\t")[0] for row in done.stdout.splitlines()}

    assert offered("esplanade ") >= set(COMMANDS)
    assert "--tick-rate" in offered("esplanade serve --tick")
    assert "--cell" in offered("esplanade scene check --c")
    assert "warning" in offered("esplanade serve --log-level w")


@pytest.mark.parametrize("script", ["zsh"], indirect=True)
def test_zsh_takes_it_for_the_command(script: Path) -> None:
    function = script.with_name("_esplanade")
    script.rename(function)
    ask = (
        f"fpath=({function.parent} $fpath); autoload -U compinit && compinit -D -u && "
        f"zsh -n {function} && print $_comps[esplanade]"
    )
    done = subprocess.run(["zsh", "-f", "-c", ask], check=True, capture_output=True, text=True)
    assert (done.stdout, done.stderr) == ("_esplanade\n", "")


@pytest.mark.parametrize("shell", SHELLS)
def test_every_option_that_is_explained_is_in_the_script(
    shell: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["completion", shell]) == exit_codes.OK
    shown = capsys.readouterr().out
    for name in ("tick-rate", "replay", "prediction", "places", "no-film", "visitors"):
        assert name in shown
