import socket
from pathlib import Path

import pytest

from esplanade.cli import main
from esplanade.commandline.settings import given_settings
from esplanade.server import served_zone
from esplanade.server.options import SETTINGS, parser
from esplanade.server.settings import ServerSettings


def run(arguments: list[str]) -> object:
    """The exit code, whether the parser refuses or the command."""
    try:
        return main(["serve", *arguments])
    except SystemExit as end:
        return end.code


def test_help_explains_every_setting_in_its_group(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["--help"]) == 0
    text = " ".join(capsys.readouterr().out.split())
    for name, field in ServerSettings.model_fields.items():
        assert "--" + name.replace("_", "-") in text
        assert field.description is not None
        assert field.description in text
    for group in ("world:", "people:", "network:", "limits on clients:", "logs:"):
        assert group in text
    assert "[per second, 5 to 60, default 20]" in text


def test_options_become_settings() -> None:
    options = parser().parse_args(["--tick-rate", "30", "--scene", __file__])
    settings = ServerSettings(**given_settings(options, SETTINGS))
    assert (settings.tick_rate, settings.scene) == (30, Path(__file__))


@pytest.mark.parametrize(
    ("argv", "fault"),
    [
        (["--port", "many"], "--port: 'many' is no whole number from 0 to 65535; see"),
        (["--tick-rate", "1000"], "--tick-rate: '1000' is no whole number from 5 to 60; see"),
        (["--prot", "80"], "there is no option --prot; did you mean --port? see"),
        (["--scene", __file__, "--crowd", __file__], "scene and crowd: give one of them, not both"),
        (["--walls", __file__], "walls: they belong to a crowd, but none is given"),
        (["--drop-bytes", "2048"], "drop_bytes: must be greater than slow_bytes"),
        (["--scene", "no such file.json"], "--scene: no such file.json: cannot be read: No such"),
        (["--crowd", "no such file.csv"], "--crowd: no such file.csv: cannot be read"),
        (["--tls-cert", __file__], "tls_cert and tls_key: give both of them, or none"),
        (["--tls-cert", "no such.pem"], "--tls-cert: no such.pem: cannot be read: No such file"),
        (["--tls-cert", __file__, "--tls-key", __file__], f"tls_cert: {__file__}: holds no cert"),
        (["--root-path", "world"], "root_path: 'world' is no path such as /world"),
        (["--log-level", "inof"], "--log-level: 'inof' is no choice; did you mean info? see"),
        (["--scene", __file__], f"{__file__}: "),
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
    fault = "esplanade serve: ESPLANADE_ACTORS: '-3' is no whole number from 0 to 1000; see"
    assert capsys.readouterr().err.startswith(fault)


@pytest.mark.parametrize("option", ["--port", "--private-port"])
def test_a_taken_port_is_named_before_anything_is_built(
    option: str,
    room_file: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    def build(*_: object) -> None:
        raise AssertionError("it takes about a minute")

    monkeypatch.setattr(served_zone, "build_world", build)
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = str(taken.getsockname()[1])
        places = {"--host": "127.0.0.1", "--port": "0", "--private-port": "0", option: port}
        argv = [word for pair in places.items() for word in pair]
        assert run(["--scene", str(room_file), *argv]) == 1
    assert f"127.0.0.1:{port}" in capsys.readouterr().err
