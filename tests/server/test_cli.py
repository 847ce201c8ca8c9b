import socket
from pathlib import Path

import pytest

from esplanade.server import app
from esplanade.server.cli import parser, run
from esplanade.server.settings import ServerSettings


def test_help_explains_every_setting_in_its_group(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        run(["--help"])
    assert end.value.code == 0
    text = " ".join(capsys.readouterr().out.split())
    for name, field in ServerSettings.model_fields.items():
        assert "--" + name.replace("_", "-") in text
        assert field.description is not None
        assert field.description in text
    for group in ("world:", "people:", "network:", "limits on clients:", "logs:"):
        assert group in text
    assert "[per second, 5 to 60, default 20]" in text


def test_options_become_settings() -> None:
    given = vars(parser().parse_args(["--tick-rate", "30", "--scene", "x.json"]))
    settings = ServerSettings(**given)
    assert (settings.tick_rate, settings.scene) == (30, Path("x.json"))


@pytest.mark.parametrize(
    ("argv", "fault"),
    [
        (["--port", "many"], "--port: Input should be a valid integer"),
        (["--tick-rate", "1000"], "--tick-rate: Input should be less than or equal to 60"),
        (["--scene", "a", "--crowd", "b"], "scene and crowd: give one of them, not both"),
        (["--scene", "no such file.json"], "no such file.json: cannot be read: No such file"),
        (["--crowd", "no such file.csv"], "no such file.csv: cannot be read"),
    ],
)
def test_bad_options_end_with_one_clear_line(
    argv: list[str], fault: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(argv) == 2
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 1
    assert lines[0].startswith(f"esplanade serve: {fault}")


def test_a_bad_variable_is_named_as_such(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("ESPLANADE_ACTORS", "-3")
    assert run([]) == 2
    assert "esplanade serve: ESPLANADE_ACTORS: Input should be greater" in capsys.readouterr().err


@pytest.mark.parametrize("option", ["--port", "--private-port"])
def test_a_taken_port_is_named_before_anything_is_built(
    option: str,
    room_file: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    def build(*_: object) -> None:
        raise AssertionError("it takes a minute or two")

    monkeypatch.setattr(app, "_build", build)
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = str(taken.getsockname()[1])
        places = {"--host": "127.0.0.1", "--port": "0", "--private-port": "0", option: port}
        argv = [word for pair in places.items() for word in pair]
        assert run(["--scene", str(room_file), *argv]) == 1
    assert f"127.0.0.1:{port}" in capsys.readouterr().err
