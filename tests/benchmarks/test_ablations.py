"""Rules that are switched off: settings that exist, and a comparison that is run to its end."""

import json

import numpy as np
import pytest
from benchmarks import ablations
from benchmarks._walks import Walks

from esplanade.evaluation.settings import DEFAULTS, check


@pytest.mark.parametrize("ablation", ablations.ABLATIONS, ids=lambda each: each.name)
def test_each_switches_something_off(ablation) -> None:
    assert ablation.alone or ablation.together
    settings = check(ablation.settings)
    assert settings
    assert all(value != DEFAULTS[name] for name, value in settings.items())


def test_throughput_counts_who_has_come_through() -> None:
    x = np.array([[1.0, 1.0, 9.0], [6.0, 1.0, 9.0], [6.0, 4.0, 4.0], [7.0, 4.0, 3.0]])
    walks = Walks(np.stack([x, np.zeros_like(x)], axis=2), x, 0.5, 0.25, 1.3, 0.2)
    assert ablations.throughput(walks, 5.0, 2.0) == pytest.approx(2 / (0.5 * 4) / 2.0)


def test_a_table_is_printed_and_written(tmp_path, capsys) -> None:
    file = tmp_path / "found.json"
    options = ["--only", "sidesteps", "--actors", "4", "--doors", "2", "--seeds", "0", "1"]
    assert ablations.main([*options, "--until", "16", "--markdown", "--json", str(file)]) == 0
    told = json.loads(file.read_text())
    (line,) = told["differences"].values()
    assert line[: ablations.ALONE] == [None] * ablations.ALONE
    for mean, low, high in line[ablations.ALONE :]:
        assert low <= mean <= high
    printed = capsys.readouterr().out.splitlines()
    assert [row.count("|") for row in printed] == [len(ablations.COLUMNS) + 2] * 4
