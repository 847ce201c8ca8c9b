"""The command: tables, JSON, pictures, exit codes, and usage errors."""

import json
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

from esplanade.cli import main
from esplanade.commandline import exit_codes
from esplanade.evaluation import measures, options, policies
from tests.evaluation.worlds import busy_plaza, crowd, walk, write_csv


@pytest.fixture
def plaza(tmp_path: Path) -> Path:
    return write_csv(tmp_path, busy_plaza())


def run(*arguments: object) -> int:
    return main(["evaluate", "--processes=1", *map(str, arguments)])


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


def test_a_table_for_every_recording_and_one_for_all(
    tmp_path: Path, plaza: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    other = write_csv(tmp_path, busy_plaza(), "market")
    assert run(plaza, other, "--policy", "straight", "human", "--episodes", 4) == exit_codes.OK
    shown = capsys.readouterr().out
    assert [line for line in shown.split("\n") if line.strip() in {"plaza", "market"}]
    assert "all together" in shown
    assert shown.count("contacts, % of episodes") == 3
    assert "human" in shown


def test_every_episode_and_summary_is_in_the_json(tmp_path: Path, plaza: Path) -> None:
    target = tmp_path / "all.json"
    assert run(plaza, "--policy", "straight", "--episodes", 6, "--json", target) == exit_codes.OK
    found: dict[str, Any] = json.loads(target.read_text())
    assert found["settings"]["max_acceleration_mps2"] == 2.0
    (summary,) = found["summaries"]
    assert summary["recording"] == "plaza"
    assert summary["episodes"] == len(found["episodes"]) == 6
    touched = [episode["people_touched"] > 0 for episode in found["episodes"]]
    assert summary["contacts_percent"] == pytest.approx(100 * sum(touched) / 6)
    assert [episode["number"] for episode in found["episodes"]] == list(range(6))


def test_figures_have_intervals_and_policies_are_compared_on_the_same_episodes(
    tmp_path: Path,
    plaza: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(measures, "PIECE_S", 4.0)  # this recording is short
    target = tmp_path / "all.json"
    names = ["discs", "straight", "human"]
    assert run(plaza, "--policy", *names, "--episodes", 20, "--json", target) == exit_codes.OK
    shown = capsys.readouterr().out
    found = json.loads(target.read_text())
    for summary in found["summaries"]:
        counts = {"recording", "policy", "episodes", "decision_max_ms", "intervals"}
        assert summary["intervals"].keys() == summary.keys() - counts
        for name, (low, high) in summary["intervals"].items():
            assert low <= summary[name] <= high, name
    straight = next(s for s in found["summaries"] if s["policy"] == "straight")
    low, high = straight["intervals"]["contacts_percent"]
    assert f"{straight['contacts_percent']:.1f} ({low:.1f} to {high:.1f})" in shown
    assert "Differences from discs in the same episodes" in shown
    compared = {(d["policy"], d["measure"]): d for d in found["differences"]}
    assert {policy for policy, _ in compared} == {"straight", "human"}
    contacts = compared["straight", "contacts_percent"]
    by = {
        policy: [e["people_touched"] > 0 for e in found["episodes"] if e["policy"] == policy]
        for policy in names
    }
    difference = 100.0 * (sum(by["straight"]) - sum(by["discs"])) / 20
    assert contacts["mean"] == pytest.approx(difference)
    assert contacts["episodes"] == 20
    # The pedestrian's own trip is no reversed one.
    assert compared["human", "contacts_percent"]["episodes"] == len(by["human"]) < 20


@pytest.mark.parametrize("form", ["csv", "tex", "html"])
def test_a_report_has_the_tables_that_are_printed(
    tmp_path: Path, plaza: Path, capsys: pytest.CaptureFixture[str], form: str
) -> None:
    target = tmp_path / f"all.{form}"
    words = ["--policy", "straight", "human", "--episodes", 4, "--report", target]
    assert run(plaza, *words) == exit_codes.OK
    text = target.read_text()
    assert "Differences from straight" in capsys.readouterr().out
    assert "Differences from straight" in text
    assert "smallest clearance" in text


def test_episodes_that_did_not_arrive_have_no_time_in_the_json(tmp_path: Path) -> None:
    walls = tmp_path / "cage.json"
    walls.write_text('{"segments": [[6, -3, 6, 3]]}')
    path = write_csv(
        tmp_path, crowd(walk("1", 0, (0, 0), (9, 0)), walk("2", 90, (0, 0), (1, 0))), "cage"
    )
    target = tmp_path / "all.json"
    run(path, "--walls", walls, "--set", "speed_mps=0.1", "--set=max_speed_mps=0.1",
        "--episodes=1", "--json", target)  # fmt: skip
    found = json.loads(target.read_text())
    assert found["episodes"][0]["reached"] is False
    assert found["episodes"][0]["time_s"] is None
    assert found["summaries"][0]["time_ratio"] is None


def test_reacting_people_add_a_row_and_the_recorded_do_not(
    tmp_path: Path, plaza: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    target, row = tmp_path / "all.json", "displacement imposed on people, m an episode"
    straight = (plaza, "--policy", "straight", "--episodes", 6, "--json", target)
    assert run(*straight) == exit_codes.OK
    assert row not in capsys.readouterr().out
    assert json.loads(target.read_text())["episodes"][0]["displacement_m"] == 0.0
    imposed = []
    for reaction in ("0", "0.5", "1"):
        assert run(*straight, "--people", "reacting", "--reaction", reaction) == exit_codes.OK
        assert row in capsys.readouterr().out
        found = json.loads(target.read_text())
        assert found["settings"]["people"] == "reacting"
        assert found["settings"]["reaction"] == float(reaction)
        (summary,) = found["summaries"]
        each = [episode["displacement_m"] for episode in found["episodes"]]
        assert summary["displacement_m"] == pytest.approx(sum(each) / 6)
        imposed.append(summary["displacement_m"])
    assert imposed[0] == 0.0 < imposed[1] < imposed[2]


def test_strict_fails_where_somebody_was_touched(plaza: Path) -> None:
    assert run(plaza, "--policy", "straight", "--episodes", 20) == exit_codes.OK
    assert run(plaza, "--policy", "straight", "--episodes", 20, "--strict") == exit_codes.FAILED


@pytest.mark.skipif(find_spec("matplotlib") is None, reason="matplotlib is absent")
@pytest.mark.parametrize("form", ["png", "svg"])
def test_chosen_episodes_are_drawn(tmp_path: Path, plaza: Path, form: str) -> None:
    folder = tmp_path / "strips" / "today"
    words = ["--plots", folder, "--plot-episodes=0,2", "--picture", form]
    run(plaza, "--policy", "straight", "--episodes", 4, *words)
    assert sorted(path.name for path in folder.iterdir()) == [
        f"plaza-straight-000.{form}",
        f"plaza-straight-002.{form}",
    ]


@pytest.mark.skipif(find_spec("matplotlib") is None, reason="matplotlib is absent")
def test_people_who_were_displaced_are_drawn_with_where_they_were(
    tmp_path: Path, plaza: Path
) -> None:
    folder = tmp_path / "strips"
    run(plaza, "--policy", "straight", "--episodes", 1, "--plots", folder, "--plot-episodes=0",
        "--people=reacting")  # fmt: skip
    assert [path.name for path in folder.iterdir()] == ["plaza-straight-000.png"]


@pytest.mark.skipif(find_spec("matplotlib") is None, reason="matplotlib is absent")
def test_failed_episodes_are_drawn(tmp_path: Path, plaza: Path) -> None:
    folder, target = tmp_path / "strips", tmp_path / "all.json"
    run(plaza, "--policy=straight", "--episodes=5", "--plots", folder, "--json", target)
    failed = [
        f"plaza-straight-{episode['number']:03d}.png"
        for episode in json.loads(target.read_text())["episodes"]
        if episode["people_touched"] or not episode["reached"]
    ]
    assert failed
    assert sorted(path.name for path in folder.iterdir()) == failed


def test_predictions_are_measured_and_fitted(
    tmp_path: Path, plaza: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    other = write_csv(tmp_path, busy_plaza(), "market")
    target = tmp_path / "all.json"
    assert run(plaza, other, "--fit", "--json", target) == exit_codes.OK
    shown = capsys.readouterr().out
    assert "Prediction, default" in shown
    assert "Prediction, eq. (1) as printed" in shown
    assert "Fitted deviation" in shown
    found = json.loads(target.read_text())
    assert [row["left_out"] for row in found["fitted_deviations"]] == ["plaza", "market", None]
    assert found["fitted_spreads"] == [], "everyone goes on as expected"
    assert len(found["predictions"]) == 12


def test_nothing_is_cut_off_in_a_file_or_pipe(
    plaza: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", "20")
    assert run(plaza, "--prediction") == exit_codes.OK
    shown = capsys.readouterr().out
    assert "neg. log-likelihood" in shown
    assert "…" not in shown


def test_one_recording_is_fitted_as_a_whole(plaza: Path, tmp_path: Path) -> None:
    target = tmp_path / "all.json"
    assert run(plaza, "--fit", "--json", target) == exit_codes.OK
    found = json.loads(target.read_text())
    assert [row["left_out"] for row in found["fitted_deviations"]] == [None]


def test_recordings_of_one_name_are_told_apart_by_their_paths(
    tmp_path: Path, plaza: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "other"
    folder.mkdir()
    other = write_csv(folder, busy_plaza())
    assert run(plaza, other, "--policy=straight", "--episodes=2") == exit_codes.OK
    assert "other/plaza" in capsys.readouterr().out.replace("\n", "")


@pytest.mark.parametrize(
    ("arguments", "fault"),
    [
        (["--policy", "magic"], "--policy: 'magic' is no policy; there are esplanade, straight"),
        (["--episodes", "0"], "--episodes: '0' is no whole number from 1 to 100000"),
        (["--a-max", "fast"], "'fast' is no number from 0.2 to 20"),
        (["--fps", "nan"], "'nan' is no number"),
        (["--people", "polite"], "--people: 'polite' is no choice; there are recorded, reacting"),
        (["--reaction", "2"], "--reaction is for --people reacting"),
        (
            ["--people", "reacting", "--reaction", "-1"],
            "--reaction: '-1' is no number from 0 to 10",
        ),
        (["--set", "tempo=3"], "--set: tempo: there is no such setting"),
        (["--set", "risk_weigth=3"], "there is no such setting; did you mean risk_weight?"),
        (["--sensitivity", "--vary", "tempo"], "--vary: tempo: there is no such setting"),
        (["--set", "risk_weight=-1"], "--set risk_weight: Input should be greater"),
        (["--json", "/nowhere/all.json"], "--json: there is no folder /nowhere"),
        (["--plots", "/dev/null/x"], "--plots: "),
        (["--plot-episodes", "many"], "'many' is neither `failed` nor numbers"),
        (["--plot-episodes", "1,500"], "but there are episodes 0 to"),
        (["--report", "all.doc"], "--report: all.doc is none of .html, .tex, .csv"),
        (["--report", "all.csv", "--fit"], "--report is for episodes that are walked once"),
        (["--walls", "nowhere.json"], "nowhere.json: cannot be read"),
        (["missing.csv"], "missing.csv: cannot be read"),
        ([__file__, "--walls", __file__], "--walls belongs to one recording"),
        (["--prediction", "--sample-s", "0.3"], "'0.3' is no choice; there are 0.1, 0.2, 0.4"),
    ],
)
def test_wrong_usage(
    arguments: list[str], fault: str, plaza: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert fault in refused(capsys, plaza, *arguments)


def test_a_broken_file_is_named_with_its_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "obsmat.txt"
    path.write_text("1 1 0 0 0 0 0 0\n2 1 0\n")
    said = refused(capsys, path)
    assert said.startswith(f"esplanade evaluate: {path}:2: expected 8 columns")


def test_recordings_in_which_nothing_can_be_judged(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write_csv(tmp_path, crowd(walk("1", 0.0, (0, 0), (1, 0))))
    assert "it has no trip that can be an episode" in refused(capsys, path)
    assert "nobody in it is followed for long enough" in refused(capsys, path, "--prediction")


def test_no_limit_of_acceleration(tmp_path: Path, plaza: Path) -> None:
    target = tmp_path / "all.json"
    run(plaza, "--policy=straight", "--episodes=1", "--a-max=none", "--json", target)
    assert json.loads(target.read_text())["settings"]["max_acceleration_mps2"] is None


def test_the_help_names_every_policy() -> None:
    """The help has its own table, because the policies import numpy."""
    assert list(policies.POLICIES) == list(options.POLICIES)
