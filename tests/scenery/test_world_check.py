import json
from pathlib import Path

import pytest

from esplanade.commandline import exit_codes
from tests.planning.scene.test_world_file import write
from tests.scenery.test_cli import refused, run


def test_a_world_is_told_zone_by_zone(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("check", "--world", write(tmp_path)) == exit_codes.OK
    shown = capsys.readouterr()
    assert shown.err == ""
    assert "Town  newcomers enter yard" in shown.out
    assert "gate → hall" in shown.out
    assert "door → yard" in shown.out


def test_a_portal_that_cannot_be_walked_to_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(tmp_path)
    scene = json.loads((tmp_path / "hall.json").read_text())
    block = {"kind": "wall", "height_m": 3, "points": [[0, 3], [3, 3], [3, 7], [0, 7]]}
    (tmp_path / "hall.json").write_text(
        json.dumps(scene | {"polygons": [block], "spawns": [{"position": [8, 8]}]})
    )
    assert run("check", path, "--world") == exit_codes.FAILED
    assert capsys.readouterr().err == f"{path}: zone 'hall': portal 'door': nobody gets there\n"
    assert run("check", path, "--world", "--json") == exit_codes.FAILED
    told = json.loads(capsys.readouterr().out)
    assert told["faults"] == ["zone 'hall': portal 'door': nobody gets there"]
    assert told["zones"]["yard"]["exits"] == {"gate": "hall"}


def test_what_is_no_world_is_told_with_its_place(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(tmp_path, start="moon")
    assert run("check", "--world", path) == exit_codes.FAILED
    assert "start: there is no zone 'moon'" in capsys.readouterr().err
    assert run("check", "--world", path, "--json") == exit_codes.FAILED
    assert json.loads(capsys.readouterr().out)["faults"]


def test_a_world_that_cannot_be_read_is_wrong_usage(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert "cannot be read" in refused(capsys, "check", "--world", tmp_path)


def test_copies_are_told_with_their_zone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    zones = [
        {"name": "yard", "scene": "yard.json"},
        {"name": "hall", "scene": "hall.json", "people": 40, "copies": 2},
    ]
    assert run("check", "--world", write(tmp_path, zones=zones)) == exit_codes.OK
    assert "hall, hall-2" in capsys.readouterr().out
    assert run("check", "--world", tmp_path / "town.json", "--json") == exit_codes.OK
    told = json.loads(capsys.readouterr().out)["zones"]
    assert {name: zone["copies"] for name, zone in told.items()} == {
        "yard": [],
        "hall": ["hall", "hall-2"],
    }
