"""The short leg of `make chaos`: a few attacks on a real server, with counts instead of times."""

from pathlib import Path

import pytest
from chaos import trial
from chaos.attacks.catalogue import ATTACKS
from chaos.processes import raise_file_limit
from chaos.resumes import resumes

SECONDS = 2.0
LEAST_SHARE = 0.25
"""Of the snapshots that are due: a busy machine makes fewer, a world that stands still none."""


@pytest.mark.parametrize(
    ("name", "metric"),
    [
        ("pings", 'esplanade_floods_total{what="frames"}'),
        ("single-bytes", 'esplanade_floods_total{what="frames"}'),
        ("silent", 'esplanade_sockets_refused_total{why="address_sockets"}'),
    ],
)
def test_an_attack_is_named_and_nobody_else_feels_it(
    name: str, metric: str, tmp_path: Path
) -> None:
    raise_file_limit()
    seen = trial.run(ATTACKS[name], tmp_path, SECONDS, seed=3, actors=2)
    assert seen.sighting.lost == ""
    assert seen.sighting.dropped == 0
    assert seen.sighting.snapshots >= LEAST_SHARE * seen.sighting.due > 0
    assert seen.sighting.turned_away == 0
    assert seen.named[metric] > 0
    assert any(metric.split('"')[1] in line for line in seen.lines)
    assert (seen.unnamed, seen.faults) == ([], [])
    assert seen.memory_most_mb < 1.2 * seen.memory_before_mb


def test_bots_that_are_killed_come_back_as_themselves(tmp_path: Path) -> None:
    run = resumes(tmp_path, bots=8, seconds=5.0, seed=3, actors=0)
    assert run.faults == []
    assert run.people == 8
    assert run.resumes == run.kills + run.takeovers > 0
