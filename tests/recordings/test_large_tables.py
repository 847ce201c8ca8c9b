"""Large tables are read as small ones are, and a fault at their end is named with its line."""

from pathlib import Path

import numpy as np
import pytest

from esplanade.recordings import RecordingError, large_tables, read_crowd
from tests.recordings.forms import FORMS

pytest.importorskip("pyarrow")


@pytest.mark.parametrize("name", FORMS)
def test_large_tables_are_read_as_small_ones(
    tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    form = FORMS[name]
    path = tmp_path / form.name
    path.write_bytes(form.content)
    small = read_crowd(path, **form.given)
    monkeypatch.setattr(large_tables, "LARGE_BYTES", 0)
    if name == "csv":
        assert large_tables.read_large(path) is not None
    large = read_crowd(path, **form.given)
    assert small.report == large.report
    for one, other in zip(small.tracks, large.tracks, strict=True):
        assert one.id == other.id
        np.testing.assert_array_equal(one.positions, other.positions)
        np.testing.assert_allclose(one.times, other.times)


@pytest.mark.parametrize(
    ("last", "fault"),
    [
        ("9999,1,north,0", "x is 'north', expected a number"),
        ("9999,1,2", "expected 4 columns t,id,x,y, not 3"),
        ("9999,1,2,3,4", "expected 4 columns t,id,x,y, not 5"),
        ("9999,1,nan,3", "x is nan, expected a finite number"),
    ],
)
def test_a_fault_at_the_end_is_named(
    tmp_path: Path, last: str, fault: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(large_tables, "LARGE_BYTES", 0)
    path = tmp_path / "a.csv"
    rows = [f"{0.4 * n:.1f},1,{0.5 * n:.1f},0" for n in range(40_000)]
    path.write_text("\n".join(["t,id,x,y", *rows, last, ""]))
    with pytest.raises(RecordingError, match=f":40002: {fault}"):
        read_crowd(path)
