"""Some hundred mutated files of every form; `make fuzz-files` tries many more."""

import random
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from esplanade.recordings import RecordingError, read_crowd
from tests.recordings.forms import FORMS
from tests.recordings.fuzz import fault_of, mutated, tried


@pytest.mark.parametrize("name", FORMS)
def test_mutated_files_are_refused_or_right(tmp_path: Path, name: str) -> None:
    form = FORMS[name]
    for number in range(20):
        tried(tmp_path / form.name, form, mutated(form.content, random.Random(f"{name}{number}")))


cell = st.one_of(
    st.floats(-50, 50).map(lambda v: f"{v:.3f}"),
    st.integers(-5, 300).map(str),
    st.sampled_from(["", "nan", "x", "1,5", '"2"', "?", "1e9"]),
)


@settings(
    max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(
    head=st.sampled_from(["", "t,id,x,y", "frame,id,x,y", "# framerate: 10", "id;x/cm;y/cm;t/ms"]),
    mark=st.sampled_from(",; \t"),
    rows=st.lists(st.lists(cell, min_size=3, max_size=6), max_size=8),
)
def test_any_table(tmp_path: Path, head: str, mark: str, rows: list[list[str]]) -> None:
    path = tmp_path / "any.txt"
    path.write_text("\n".join([head, *(mark.join(row) for row in rows)]))
    try:
        crowd = read_crowd(path)
    except RecordingError:
        return
    assert fault_of(crowd) is None
