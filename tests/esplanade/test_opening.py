"""Worlds of files that are no scenes: made into scenes once, and then run as any other."""

import gzip
import json
import os
from argparse import Namespace
from pathlib import Path
from typing import Any

import pytest

from esplanade import opening
from esplanade.cli import main
from esplanade.commandline.errors import UsageError
from esplanade.planning import Scene
from esplanade.recordings import read_crowd
from esplanade.scenery import pictures

pytest.importorskip("shapely")
HALL = "POLYGON ((0 0, 12 0, 12 8, 0 8, 0 0), (5 3, 7 3, 7 5, 5 5, 5 3))"


@pytest.fixture(autouse=True)
def kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of its own for scenes that are made."""
    folder = tmp_path / "kept"
    monkeypatch.setattr(opening, "scenes_folder", lambda: folder)
    return folder


def test_a_plan_is_run_with_one_command_and_imported_once(
    tmp_path: Path, kept: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plan, out = tmp_path / "hall.wkt", tmp_path / "hall.csv"
    plan.write_text(HALL)
    words = ["run", str(plan), "--actors", "2", "--seconds", "1", "--out", str(out)]
    assert main(words) == 0
    assert "92.0 m² of floor in all" in capsys.readouterr().out
    assert len(read_crowd(out).tracks) == 2
    (scene,) = kept.glob("*/hall.json")
    assert "# scene: hall.json\n" in out.read_text()
    assert main(words) == 0
    shown = capsys.readouterr()
    assert "of floor" not in shown.out
    assert f"imported before, as {scene}" in shown.err


def test_an_import_that_is_interrupted_is_made_anew(
    tmp_path: Path, kept: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plan = tmp_path / "hall.wkt"
    plan.write_text(HALL)

    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(pictures, "draw_heights", interrupted)
        with pytest.raises(KeyboardInterrupt):
            opening.with_scene(Namespace(scene=plan))
    assert list(kept.iterdir()) == []
    options = Namespace(scene=plan)
    opening.with_scene(options)
    assert Scene.model_validate_json(options.scene.read_text()).polygons
    assert list(kept.glob("*/hall.json")) == [options.scene]


def test_who_comes_second_takes_what_is_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    plan, twin = tmp_path / "hall.wkt", tmp_path / "twin.wkt"
    plan.write_text(HALL)
    twin.write_text(HALL)
    draw, first = pictures.draw_heights, Namespace(scene=plan)

    def other_is_faster(*given: Any) -> None:
        monkeypatch.setattr(pictures, "draw_heights", draw)
        opening.with_scene(first)
        draw(*given)

    monkeypatch.setattr(pictures, "draw_heights", other_is_faster)
    second, other = Namespace(scene=plan), Namespace(scene=twin)
    opening.with_scene(second)
    assert first.scene == second.scene
    assert second.scene.exists()
    told = capsys.readouterr().out
    assert told.count(f"run it: esplanade serve --scene {second.scene}\n") == 2
    opening.with_scene(other)
    assert other.scene.name == "twin.json"
    assert other.scene.exists()


def test_what_cannot_be_imported_is_named_and_leaves_nothing(tmp_path: Path, kept: Path) -> None:
    plan = tmp_path / "hall.wkt"
    plan.write_text("POLYGON ((0 0, 1 1")
    with pytest.raises(UsageError, match=r"hall\.wkt: .*bracket"):
        opening.with_scene(Namespace(scene=plan))
    assert list(kept.iterdir()) == []


def test_what_was_not_used_for_long_goes_when_another_is_opened(
    tmp_path: Path, kept: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    old = kept / "0123456789abcdef"
    old.mkdir(parents=True)
    os.utime(old, (0.0, 0.0))
    plan = tmp_path / "hall.wkt"
    plan.write_text(HALL)
    for _ in range(2):
        options = Namespace(scene=plan)
        opening.with_scene(options)
        assert options.scene.exists()
    assert "imported before" in capsys.readouterr().err
    assert not old.exists()


@pytest.mark.parametrize(
    ("name", "content", "made"),
    [
        ("a.json", {"bounds": [0, 0, 4, 4]}, False),
        ("a.json", {"type": "FeatureCollection", "features": []}, True),
        ("a.json", [1, 2], False),
        ("a.IFC", "", True),
        ("a.glb", "", True),
        ("a.toml", "", False),
    ],
)
def test_which_files_are_made_into_scenes(
    tmp_path: Path, name: str, content: object, made: bool
) -> None:
    path = tmp_path / name
    path.write_text(json.dumps(content))
    assert opening.is_made_into_a_scene(path) is made


def test_a_scene_that_cannot_be_read_is_left_to_its_reader(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_text("{")
    options = Namespace(scene=path)
    opening.with_scene(options)
    assert options.scene == path


@pytest.mark.parametrize("name", ["hall.txt", "hall.wkt.gz", "hall.json.gz"])
def test_a_plan_is_known_by_what_it_holds(tmp_path: Path, name: str) -> None:
    plan = tmp_path / name
    text = HALL.encode() if "json" not in name else b'{"type": "Polygon", "coordinates": []}'
    plan.write_bytes(gzip.compress(text) if name.endswith("gz") else text)
    assert opening.is_made_into_a_scene(plan)
    plan.write_bytes(b"neither\n")
    assert opening.is_made_into_a_scene(plan) == (name == "hall.wkt.gz")
    assert not opening.is_made_into_a_scene(tmp_path / "absent.txt")
