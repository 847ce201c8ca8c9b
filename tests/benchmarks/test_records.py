"""Bodies that are drawn from records of steps are where they were computed, within bounds."""

import json

import numpy as np
import pytest
from benchmarks import records as benchmark


@pytest.mark.parametrize("walk", ["gallery.json", "steered people"])
def test_clients_draw_bodies_where_they_were_computed(walk: str) -> None:
    ticks = 300
    people = walk == "steered people"
    walked = benchmark.steered_people(ticks) if people else benchmark.actors(walk, ticks, 12)
    assert len(walked.steps.ticks) > 200
    assert walked.steps.re_aimed.any()
    found = benchmark.deviations(walked)
    assert not benchmark.falls_short(found)
    assert np.percentile(found["ankles"], 99) < 2.5
    assert np.percentile(found["hips"], 99) < 1.5
    assert np.percentile(found["head"], 99) < 6.0
    assert np.percentile(found["hands"], 99) < 8.0


def test_the_figures_are_written_for_programs(tmp_path) -> None:
    file, picture = tmp_path / "figures.json", tmp_path / "step.svg"
    benchmark.main(["--ticks", "60", "--json", str(file), "--picture", str(picture)])
    assert "<svg" in picture.read_text()
    found = json.loads(file.read_text())
    assert found["step_bytes"] == 140
    assert set(found["off"]) == {"plaza.json", "gallery.json", "steered people"}
