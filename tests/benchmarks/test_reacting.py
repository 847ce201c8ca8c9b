"""The benchmark of reacting people tells its figures."""

import json
from pathlib import Path

from benchmarks import reacting


def test_figures_are_told_for_every_number_of_people(tmp_path: Path) -> None:
    target = tmp_path / "figures.json"
    assert reacting.main(["--people", "20", "60", "--json", str(target)]) == 0
    rows = json.loads(target.read_text())
    assert [row["people"] for row in rows] == [20, 60]
    assert all(row["ms"] > 0.0 and row["moved_percent"] > 0.0 for row in rows)
