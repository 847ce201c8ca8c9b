"""Both planners on one small building, from the command line to figures and pictures."""

import json
from importlib.util import find_spec
from pathlib import Path

import pytest
from benchmarks import _detour, _node_process, meshes

STEP_M = 0.5


def write_terrace(path: Path) -> Path:
    """Two floors of 4 m by 6 m, one a step higher than the other; y up."""
    corners, faces = [], []

    def quad(*points: tuple[float, float, float]) -> None:
        first = len(corners) + 1
        corners.extend(points)
        faces.extend([(first, first + 1, first + 2), (first, first + 2, first + 3)])

    for x, y in ((0.0, 0.0), (6.0, STEP_M)):
        quad((x, y, 0.0), (x, y, 4.0), (x + 6.0, y, 4.0), (x + 6.0, y, 0.0))
    quad((6.0, 0.0, 0.0), (6.0, 0.0, 4.0), (6.0, STEP_M, 4.0), (6.0, STEP_M, 0.0))
    lines = [f"v {x} {y} {z}" for x, y, z in corners]
    lines += ["f " + " ".join(map(str, face)) for face in faces]
    path.write_text("\n".join(lines) + "\n")
    return path


def needs_the_navigation_mesh() -> None:
    if absent := _node_process.recast_missing():
        pytest.skip(absent)


def measure(folder: Path, *options: str) -> tuple[int, dict]:
    file = folder / "figures.json"
    mesh = write_terrace(folder / "terrace.obj")
    words = ["--mesh", str(mesh), "--pairs", "40", "--json", str(file), *options]
    code = meshes.main(words)
    return code, json.loads(file.read_text())["terrace.obj"]


def test_both_climb_the_step_that_an_adult_climbs(tmp_path, capsys) -> None:
    needs_the_navigation_mesh()
    code, figures = measure(tmp_path)
    assert code == 0
    assert figures["both"] == figures["pairs"] == 40
    assert figures["disagreements"] == []
    assert 0.95 < figures["length ratio"]["p50"] < 1.05
    assert figures["import"]["layers"] == 1
    assert figures["import"]["cells"] == pytest.approx(48.0 / 0.25**2, rel=0.1)
    assert "a path: both" in capsys.readouterr().out


def test_neither_lets_a_child_climb_it(tmp_path) -> None:
    needs_the_navigation_mesh()
    _, figures = measure(tmp_path, "--body", "child")
    assert 0 < figures["both"] < 40
    assert figures["both"] + figures["neither"] == 40


@pytest.mark.skipif(find_spec("matplotlib") is None, reason="matplotlib is absent")
def test_a_disagreement_is_drawn(tmp_path, monkeypatch) -> None:
    needs_the_navigation_mesh()
    strict = _detour.NavMeshSettings
    monkeypatch.setattr(meshes, "NavMeshSettings", lambda r, h, _, cell_m: strict(r, h, 0.47))
    code, figures = measure(tmp_path, "--plots", str(tmp_path / "new"))
    assert code == 0
    assert figures["only ours"] > 0
    for refusal in figures["disagreements"]:
        assert (refusal["finders"], refusal["why"]) == ("only ours", "step")
        assert refusal["gap"][0] == pytest.approx(6.0, abs=0.6)
    (picture,) = (tmp_path / "new").iterdir()
    assert picture.name == "terrace-only_ours-step.png"
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_skips_in_words_what_is_absent(tmp_path, monkeypatch, capsys) -> None:
    monkeypatch.setenv("ESPLANADE_RECORDINGS", str(tmp_path))
    monkeypatch.setattr(meshes, "recast_missing", lambda: None)
    assert meshes.main([]) == 0
    assert "skipped: there are no meshes" in capsys.readouterr().out
    monkeypatch.setattr(meshes, "recast_missing", lambda: "Recast is absent")
    assert meshes.main([]) == 0
    assert "skipped: Recast is absent" in capsys.readouterr().out
