"""A folder as one recording: a file for each person, each frame, or each piece of time."""

import json
from pathlib import Path

import pytest

from esplanade.recordings import RecordingError, read_crowd
from tests.recordings.forms import CSV, SAMPLES, SPEED_MPS, walk


def write(folder: Path, files: dict[str, str]) -> Path:
    for name, content in files.items():
        (folder / name).write_text(content)
    return folder


def test_a_file_for_each_person_without_ids(tmp_path: Path) -> None:
    rows = {1: [",timestamp,x,y"], 2: [",timestamp,x,y"]}
    for n, who, x, y in walk(0.02):
        rows[who].append(f"{n},{0.02 * n:.2f},{x},{y}")
    folder = write(tmp_path, {f"1008_{who}.csv": "\n".join(own) for who, own in rows.items()})
    (folder / "README.md").write_text("what this is")
    crowd = read_crowd(folder)
    assert [track.id for track in crowd.tracks] == ["1008_1", "1008_2"]
    assert [len(track.times) for track in crowd.tracks] == [SAMPLES, SAMPLES]
    assert crowd.report is not None
    assert crowd.report.median_mps == pytest.approx(SPEED_MPS)
    assert any("2 files of the folder are read as one" in text for text in crowd.report.remarks)
    alone = read_crowd(folder / "1008_2.csv")
    assert [track.id for track in alone.tracks] == ["1008_2"]


def test_a_file_for_each_frame_of_wildtrack(tmp_path: Path) -> None:
    for n, who, x, y in walk(0.5):
        path = tmp_path / f"{5 * n:08d}.json"
        known = json.loads(path.read_text()) if path.is_file() else []
        cell = round((x + 3.0) / 0.025) + 480 * round((y + 9.0) / 0.025)
        path.write_text(json.dumps([*known, {"personID": who, "positionID": cell, "views": []}]))
    crowd = read_crowd(tmp_path)
    assert [track.id for track in crowd.tracks] == ["1", "2"]
    assert crowd.tracks[0].positions[0] == pytest.approx([0.0, 0.0], abs=0.03)
    assert crowd.tracks[1].positions[0] == pytest.approx([4.0, 1.0], abs=0.03)
    assert crowd.report is not None
    assert crowd.report.sample_s == pytest.approx(0.5)
    assert crowd.report.median_mps == pytest.approx(SPEED_MPS, rel=0.05)


def test_an_id_in_two_files_is_of_two_people(tmp_path: Path) -> None:
    folder = write(tmp_path, {"monday.csv": CSV.decode(), "sunday.csv": CSV.decode()})
    crowd = read_crowd(folder)
    assert sorted(track.id for track in crowd.tracks) == [
        "monday/1", "monday/2", "sunday/1", "sunday/2",
    ]  # fmt: skip


def test_files_of_another_kind_are_refused(tmp_path: Path) -> None:
    folder = write(tmp_path, {"a.csv": CSV.decode(), "b.csv": "# framerate: 25\n1 2 3 4 1.7\n"})
    with pytest.raises(RecordingError, match=r"a folder of different files: a\.csv is"):
        read_crowd(folder)
    write(tmp_path, {"b.csv": "t,id,x,y\n0,1,north,2\n"})
    with pytest.raises(RecordingError, match=r"b\.csv:2: x is 'north'"):
        read_crowd(folder)


def test_people_without_ids_who_are_several_are_refused(tmp_path: Path) -> None:
    folder = write(tmp_path, {"a.csv": "t,x,y\n0,1,2\n0,5,5\n1,1,3\n"})
    with pytest.raises(RecordingError, match=r"none of 't, x, y' is id; --columns names them"):
        read_crowd(folder / "a.csv")


def test_a_folder_keeps_heights_for_worlds_with_y_up(tmp_path: Path) -> None:
    lines = [f"{0.4 * n:.1f},1,{0.5 * n:.1f},0.1,{0.2 * n:.1f}" for n in range(20)]
    content = "\n".join(["t,id,x,y,z", *lines, ""])
    alone = tmp_path / "alone.csv"
    alone.write_text(content)
    (tmp_path / "many").mkdir()
    folder = write(tmp_path / "many", {"a.csv": content, "b.csv": content})
    expected = read_crowd(alone).tracks[0].positions
    for track in read_crowd(folder).tracks:
        assert track.positions == pytest.approx(expected)
    assert expected[-1] == pytest.approx([9.5, 3.8])


def test_a_files_name_that_is_an_id_elsewhere_is_of_another_person(tmp_path: Path) -> None:
    def of(who: int) -> str:
        return "\n".join(["t,id,x,y", *[f"{0.4 * n:.1f},{who},{n},0" for n in range(5)], ""])

    folder = write(tmp_path, {"1.csv": of(5), "2.csv": of(5), "3.csv": of(1)})
    assert len(read_crowd(folder).tracks) == 3


def test_files_of_a_rarer_suffix_are_told_of(tmp_path: Path) -> None:
    day = CSV.decode()
    folder = write(tmp_path, {"a.csv": day, "b.csv": day, "c.txt": day})
    report = read_crowd(folder).report
    assert report is not None
    assert "1 files of other suffixes are passed over" in report.remarks
