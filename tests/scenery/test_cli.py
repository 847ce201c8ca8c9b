"""The command: its output, files, exit codes and usage errors."""

import json
import re
from importlib.util import find_spec
from pathlib import Path

import pytest

from esplanade.cli import main
from esplanade.commandline import exit_codes
from esplanade.planning.scene.scene_file import read_scene
from tests.scenery.worlds import LOFT, write, write_building

needs_matplotlib = pytest.mark.skipif(find_spec("matplotlib") is None, reason="no matplotlib")


def run(*arguments: object) -> int:
    return main(["scene", *map(str, arguments)])


def refused(capsys: pytest.CaptureFixture[str], *arguments: object) -> str:
    """The error message of a command that is refused."""
    try:
        code: object = run(*arguments)
    except SystemExit as end:  # the parser of options raises this
        code = end.code
    assert code == exit_codes.USAGE
    shown = capsys.readouterr()
    assert shown.out == ""
    assert "Traceback" not in shown.err
    return shown.err


def test_check_says_what_a_scene_holds(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("check", write(tmp_path, LOFT)) == exit_codes.OK
    shown = capsys.readouterr()
    assert "Loft" in shown.out
    assert "but not den" in shown.out
    assert shown.err == ""


def test_check_says_what_is_wrong_and_where(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    polygons = [*LOFT["polygons"][:3], {**LOFT["polygons"][3], "height_m": -1}]
    path = write(tmp_path, {**LOFT, "polygons": polygons})
    assert run("check", path) == exit_codes.FAILED
    shown = capsys.readouterr()
    assert re.fullmatch(rf"{path}:1:\d+: polygons.3.height_m: must be > 0, got -1\n", shown.err)
    assert shown.out == ""
    assert run("check", path, "--json") == exit_codes.FAILED
    faults = json.loads(capsys.readouterr().out)["faults"]
    assert faults == ["polygons.3.height_m: must be > 0, got -1"]


def test_check_names_places_that_nobody_reaches(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(tmp_path, {**LOFT, "walls": [{"start": [3, 6], "end": [4.5, 6]}]})
    assert run("check", path) == exit_codes.FAILED
    shown = capsys.readouterr()
    assert shown.err == f"{path}: place 'den': nobody gets there from the spawns\n"
    assert "Loft" in shown.out


def test_check_gives_figures_as_json(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write(tmp_path, LOFT)
    assert run("check", path, "--json", "--cell", "0.5") == exit_codes.OK
    figures = json.loads(capsys.readouterr().out)
    assert figures["cell_m"] == 0.5
    assert figures["layers"][1]["cells"] == 8 * 16
    assert figures["faults"] == []


@needs_matplotlib
def test_render_draws_every_layer(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "made" / "here"
    arguments = ["--body", "child,height=1.2", "--from", "den", "--to", "10,4,3", "--out", out]
    assert run("render", write(tmp_path, LOFT), *arguments) == exit_codes.OK
    files = sorted(file.name for file in out.iterdir())
    subjects = ("classes", "heights", "path", "reachability")
    assert files == [f"layer-{n}-{subject}.png" for n in (0, 1) for subject in subjects]
    shown = capsys.readouterr()
    assert all(str(out / name) in shown.out for name in files)


@needs_matplotlib
@pytest.mark.parametrize(("form", "begins"), [("svg", b"<?xml"), ("pdf", b"%PDF")])
def test_pictures_for_papers(tmp_path: Path, form: str, begins: bytes) -> None:
    out, target = tmp_path / "pictures", tmp_path / "house.json"
    assert run("render", write(tmp_path, LOFT), "--picture", form, "--out", out) == exit_codes.OK
    assert {path.suffix for path in out.iterdir()} == {f".{form}"}
    mesh = write_building(tmp_path)
    assert run("import", mesh, "--picture", form, "--out", target) == exit_codes.OK
    assert target.with_suffix(f".{form}").read_bytes().startswith(begins)


@needs_matplotlib
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--to", "moon"], "--to: no place named 'moon'"),
        (["--body", "giant"], "--body: 'giant' is no body"),
        (["--body", "height=9"], "--body: height_m must lie between"),
        (["--from", "1,2,x"], "is not X,Y,Z"),
        (["--cell", "9"], "--cell: '9' is no number from 0.05 to 2"),
    ],
)
def test_render_refuses_what_it_cannot_draw(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], message: str
) -> None:
    path = write(tmp_path, LOFT)
    assert message in refused(capsys, "render", path, "--out", tmp_path / "out", *arguments)


def test_a_folder_that_cannot_be_made_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(tmp_path, LOFT)
    assert "--out" in refused(capsys, "render", path, "--out", path / "out")


@pytest.mark.parametrize("command", ["check", "render"])
def test_a_file_that_is_not_there_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], command: str
) -> None:
    more = ["--out", tmp_path] if command == "render" else []
    said = refused(capsys, command, tmp_path / "none.json", *more)
    assert f"esplanade scene {command}: FILE: {tmp_path / 'none.json'}: cannot be read" in said


def test_the_help_of_the_whole_names_all_options(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        run("--help")
    shown = capsys.readouterr().out
    for option in ("--json", "--cell", "--body", "--from", "--to", "--out"):
        assert option in shown


def test_a_command_is_needed(capsys: pytest.CaptureFixture[str]) -> None:
    assert "COMMAND" in refused(capsys)


def test_schema_tells_scenes_from_others(tmp_path: Path) -> None:
    validator_for = pytest.importorskip("jsonschema_rs").validator_for
    out = tmp_path / "scene.schema.json"
    assert run("schema", "--out", out) == exit_codes.OK
    schema = json.loads(out.read_text())
    assert "metres" in schema["$defs"]["Polygon"]["properties"]["points"]["description"]
    judge = validator_for(schema)
    named = {"$schema": out.name, **LOFT}
    assert judge.is_valid(named)
    assert not judge.is_valid({**named, "colour": "red"})
    assert not judge.is_valid({**named, "walls": [{"start": [0, 0]}]})
    assert read_scene(write(tmp_path, named)) == read_scene(write(tmp_path, named))


def test_import_makes_a_scene_that_check_accepts(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    target = tmp_path / "house.json"
    assert run("import", write_building(tmp_path), "--out", target) == exit_codes.OK
    assert f"esplanade serve --scene {target}" in capsys.readouterr().out
    assert run("check", target) == exit_codes.OK
    assert "8 places" in capsys.readouterr().out


def test_import_refuses_what_is_no_mesh_and_no_scene(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mesh = write_building(tmp_path)
    assert "--out: a.glb is no .json file" in refused(
        capsys, "import", mesh, "--out", tmp_path / "a.glb"
    )
    assert "none.obj" in refused(capsys, "import", tmp_path / "none.obj", "--out", "a.json")
