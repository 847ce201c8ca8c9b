"""One crowd, moved by several planners: a tiny case with whoever is installed."""

import json
from pathlib import Path

import numpy as np
import pytest
from benchmarks import _crowd_movers, crowds

from esplanade.planning import LayeredGrid, Scene

ROOM = Scene.open_space((0.0, 0.0, 64.0, 64.0))


@pytest.fixture
def on_open_ground(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(crowds, "make_scene", lambda _: ROOM)
    monkeypatch.setattr(crowds, "WARM_UP_TICKS", 2)
    monkeypatch.setattr(crowds, "PLACES", 4)


@pytest.mark.usefixtures("on_open_ground")
def test_every_mover_that_is_there_tells_its_figures(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "figures.json"
    words = ["--actors", "6", "--people", "3", "--ticks", "40", "--intervals", "1", "2"]
    crowds.main([*words, "--json", str(file)])
    told = " ".join(capsys.readouterr().out.split())
    rows = {row["mover"]: row for row in json.loads(file.read_text())}
    assert {"esplanade", "esplanade, interval 2"} <= rows.keys()
    for absent, mover in (
        (_crowd_movers.recast_missing(), "DetourCrowd"),
        (_crowd_movers.orca_missing(), "ORCA"),
    ):
        assert (mover in rows) == (absent is None)
        assert absent is None or f"skipped: {absent}" in told
    for row in rows.values():
        assert row["us_an_actor"] == pytest.approx(1e3 * row["ms"] / 6)
        assert row["with_actors"] == 0.0


def test_actors_of_every_mover_make_the_same_trips() -> None:
    grid = LayeredGrid.from_scene(ROOM)
    start = crowds.start_of(ROOM, grid, 4, np.zeros((0, 2)))
    movers, _ = _crowd_movers.movers_of(start, [1])
    nobody, nothing = np.zeros((0, 2)), np.zeros(0, dtype=np.int64)
    for mover in movers:
        for _ in range(60):
            places, took_s = mover.tick(start.goals, nothing, nobody, nobody)
        mover.close()
        assert took_s >= 0.0
        goals = start.places[start.goals]
        gone = np.hypot(*(goals - start.starts).T) - np.hypot(*(goals - places).T)
        assert (gone > 2.0).all(), mover.name


def test_overlaps_are_told_by_their_pairs() -> None:
    actors = np.array([[0.0, 0.0], [0.4, 0.0], [5.0, 0.0]])
    people = np.array([[5.3, 0.0], [9.0, 0.0]])
    assert crowds._touching(actors, None).tolist() == [1]
    assert crowds._touching(actors, people).tolist() == [2_000_000]
    assert crowds._touching(actors, np.zeros((0, 2))).tolist() == []
