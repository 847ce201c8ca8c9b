"""Every form of a recording is read as the same two people at 1.25 m/s."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from esplanade.recordings import RecordingError, formats, read_crowd
from tests.files.encodings import SAVED, some_of, text_of
from tests.recordings.forms import FORMS, SAMPLES, SPEED_MPS, Form, jupedsim, parquet, text


def write(folder: Path, form: Form) -> Path:
    path = folder / form.name
    path.write_bytes(form.content)
    return path


@pytest.mark.parametrize("name", ["splines", "grand central"])
def test_large_files_of_forms_that_count_ahead_are_read(
    tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Their beginning alone is no such file."""
    form = FORMS[name]
    path = write(tmp_path, form)
    small = read_crowd(path, **form.given)
    monkeypatch.setattr(formats, "LARGE_CHARACTERS", 0)
    monkeypatch.setattr(formats, "MOST_OF_A_LINE", len(form.content) // 6)
    assert read_crowd(path, **form.given).report == small.report


@pytest.mark.parametrize("form", FORMS.values(), ids=list(FORMS))
def test_two_people_walk(tmp_path: Path, form: Form) -> None:
    crowd = read_crowd(write(tmp_path, form), **form.given)
    report = crowd.report
    assert report is not None
    assert report.warnings == ()
    assert report.sample_s == pytest.approx(form.sample_s, abs=1e-4)
    assert report.median_mps == pytest.approx(SPEED_MPS, rel=0.02)
    assert crowd.max_speed_mps == pytest.approx(SPEED_MPS, rel=0.06)
    assert report.passed_over == 0
    if form.name == "000001.txt":
        assert [track.id for track in crowd.tracks] == ["1"]
        return
    assert [track.id.removeprefix("R").removeprefix("ped") for track in crowd.tracks] == ["1", "2"]
    first, second = (np.diff(track.positions[[0, -1]], axis=0)[0] for track in crowd.tracks)
    assert abs(first[0]) > 5 * abs(first[1])
    assert abs(second[1]) > 5 * abs(second[0])
    if "splines" not in form.name and form.name != "annotation.vsp":
        assert [len(track.times) for track in crowd.tracks] == [SAMPLES, SAMPLES]
    again = read_crowd(write(tmp_path, form), **form.given, strict=True)
    assert again.report == report


@pytest.mark.parametrize("number", range(len(FORMS)), ids=list(FORMS))
def test_a_text_is_read_however_it_is_saved(tmp_path: Path, number: int) -> None:
    form = list(FORMS.values())[number]
    content = text_of(form.content)
    if content is None:
        return
    usual = read_crowd(write(tmp_path, form), **form.given).report
    for way in some_of(number):
        saved = form._replace(content=SAVED[way](content))
        report = read_crowd(write(tmp_path, saved), **form.given).report
        assert usual is not None
        assert report is not None
        assert replace(report, remarks=()) == replace(usual, remarks=()), way


@pytest.mark.parametrize(
    ("name", "given", "fault"),
    [
        ("stanford", {}, "its coordinates are pixels: give --scale"),
        ("juelich without a header", {}, r"give --fps; .*--fps 16 \(1.25 m/s\)"),
        ("splines", {}, "people would move at 25 m/s; give .*--scale"),
    ],
)
def test_what_has_to_be_given_is_named(
    tmp_path: Path, name: str, given: dict[str, float], fault: str
) -> None:
    with pytest.raises(RecordingError, match=fault):
        read_crowd(write(tmp_path, FORMS[name]), **given)


def test_unsorted_rows_and_repeats_are_forgiven_in_every_table(tmp_path: Path) -> None:
    for name in ("csv", "petrack", "trajnet", "obsmat", "trajnet++", "vadere", "citr"):
        form = FORMS[name]
        rows = form.content.splitlines(keepends=True)
        head = sum(not row.lstrip(b' {"track:f')[:1].isdigit() for row in rows)
        mixed = b"".join([*rows[:head], *reversed(rows[head:]), rows[-1], rows[head]])
        crowd = read_crowd(write(tmp_path, form._replace(content=mixed)), **form.given)
        assert crowd.report is not None
        assert crowd.report.median_mps == pytest.approx(SPEED_MPS, rel=0.02), name
        assert any("exact repeats" in remark for remark in crowd.report.remarks), name


def test_parquet_is_read_or_says_what_to_install(tmp_path: Path) -> None:
    path = tmp_path / "a.parquet"
    try:
        content = parquet()
    except ImportError:
        path.write_bytes(b"PAR1 and more")
        with pytest.raises(RecordingError, match="needs pyarrow: install it"):
            read_crowd(path)
        return
    path.write_bytes(content)
    crowd = read_crowd(path)
    assert crowd.report is not None
    assert crowd.report.median_mps == pytest.approx(SPEED_MPS)
    path.write_bytes(content[:200])
    with pytest.raises(RecordingError, match="Parquet file that cannot be read"):
        read_crowd(path)


def test_sqlite_that_is_no_trajectory(tmp_path: Path) -> None:
    path = tmp_path / "a.sqlite"
    path.write_bytes(jupedsim()[:5000])
    with pytest.raises(RecordingError, match="SQLite file"):
        read_crowd(path)
    path.write_bytes(jupedsim().replace(b"trajectory_data", b"trajectory_date"))
    with pytest.raises(RecordingError, match="without the table trajectory_data"):
        read_crowd(path)
    path.write_bytes(jupedsim(fps=None))
    with pytest.raises(RecordingError, match=r"give --fps; .*--fps 25 \(1.25 m/s\)"):
        read_crowd(path)
    path.write_bytes(jupedsim(fps=0.0))
    with pytest.raises(RecordingError, match=r"fps is '0\.0' in its metadata"):
        read_crowd(path)


def test_units_in_two_columns_must_agree(tmp_path: Path) -> None:
    form = Form("a.csv", text(["0,1,2,3"], "t,id,x/m,y/cm"))
    with pytest.raises(RecordingError, match="x is in m and y in cm"):
        read_crowd(write(tmp_path, form))


def test_a_row_of_units_that_is_too_short_is_a_fault(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="expected 4 columns t,id,x,y, not 3"):
        read_crowd(write(tmp_path, Form("a.csv", text(["s,,m", "0,1,2,3"], "t,id,x,y"))))


def test_a_sample_of_pathfinder_that_is_none_is_named(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    ann, ben = '{"0.0": {"x": 0, "y": 0}}', '{"0.0": {"x": 2, "y": 0}, "0.4": [3, 0]}'
    path.write_text(f'{{"ann": {ann}, "ben": {ben}}}')
    with pytest.raises(RecordingError, match=r"'ben' at '0\.4' is no sample"):
        read_crowd(path)
