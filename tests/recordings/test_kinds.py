"""Samples of others than people are left out in every form that tells kinds."""

import json
from pathlib import Path

import pytest

from esplanade.recordings import RecordingError, read_crowd

ROWS = [
    {"t": 0.4 * n, "id": who, "x": 0.5 * n, "y": float(who), "type": kind}
    for n in range(12)
    for who, kind in ((1, "pedestrian"), (2, "car"))
]


def as_csv(path: Path, rows: list[dict[str, object]]) -> None:
    lines = [",".join(rows[0]), *[",".join(map(str, row.values())) for row in rows]]
    path.write_text("\n".join([*lines, ""]))


def as_json(path: Path, rows: list[dict[str, object]]) -> None:
    path.write_text(json.dumps(rows))


def as_parquet(path: Path, rows: list[dict[str, object]]) -> None:
    pa = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    parquet.write_table(pa.Table.from_pylist(rows), path)


FORMS = {"a.csv": as_csv, "a.json": as_json, "a.parquet": as_parquet}


@pytest.mark.parametrize("name", FORMS)
def test_cars_are_left_out_and_told_of(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    FORMS[name](path, ROWS)
    crowd = read_crowd(path)
    assert [track.id for track in crowd.tracks] == ["1"]
    assert crowd.report is not None
    assert "12 of 'car'" in " ".join(crowd.report.remarks)


@pytest.mark.parametrize("name", FORMS)
def test_a_file_of_cars_alone_is_refused(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    FORMS[name](path, [row for row in ROWS if row["type"] == "car"])
    with pytest.raises(RecordingError):
        read_crowd(path)


@pytest.mark.parametrize("name", FORMS)
def test_a_column_of_another_meaning_leaves_nobody_out(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    FORMS[name](path, [{**row, "type": "a"} for row in ROWS])
    assert len(read_crowd(path).tracks) == 2
