"""Rates, units and glitches: what a file says, shows, or has to be told, and what is said of it."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from esplanade.recordings import Crowd, RecordingError, Report, read_crowd


def read(folder: Path, content: str, name: str = "a.txt", **given: Any) -> tuple[Crowd, Report]:
    path = folder / name
    path.write_text(content)
    crowd = read_crowd(path, **given)
    assert crowd.report is not None
    return crowd, crowd.report


def table(times: Any, x: Any, y: Any = None, head: str = "t,id,x,y") -> str:
    ys = np.zeros(len(times)) if y is None else y
    rows = [f"{t:.6g},1,{a:.6g},{b:.6g}" for t, a, b in zip(times, x, ys, strict=True)]
    return "\n".join([head, *rows])


TIMES = 0.4 * np.arange(30)


@pytest.mark.parametrize("fps", [10.0, 12.5, 15.0, 16.0, 24.0, 25.0, 29.97, 30.0, 50.0])
@pytest.mark.parametrize("step", [1, 6, 10])
def test_velocities_show_the_rate(tmp_path: Path, fps: float, step: int) -> None:
    rows = [
        f"{n * step} 1 {1.1 * n * step / fps:.4f} 0 {0.5 * n * step / fps:.4f} 1.1 0 0.5"
        for n in range(20)
    ]
    _, report = read(tmp_path, "\n".join(rows))
    assert report.sample_s == pytest.approx(step / fps, rel=0.01)
    assert "as its velocities show" in report.line


def test_an_option_wins_and_a_contradiction_is_said(tmp_path: Path) -> None:
    content = "# framerate: 25\n" + "\n".join(f"1 {n} {0.05 * n} 0 1.7" for n in range(9))
    _, report = read(tmp_path, content)
    assert report.median_mps == pytest.approx(1.25)
    _, report = read(tmp_path, content, fps=20.0)
    assert report.median_mps == pytest.approx(1.0)
    assert report.warnings == ("--fps 20 is taken, but the file says 25",)


@pytest.mark.parametrize("unit", ["cm", "mm", "ft"])
def test_units_that_nobody_names_are_refused_or_warned_of(tmp_path: Path, unit: str) -> None:
    metres = {"cm": 0.01, "mm": 0.001, "ft": 0.3048}[unit]
    content = table(TIMES, 1.25 * TIMES / metres)
    if unit == "ft":
        _, report = read(tmp_path, content)
        assert "--unit ft (1.25 m/s)" in report.warnings[0]
    else:
        with pytest.raises(RecordingError, match=rf"--unit {unit} \(1.25 m/s\)"):
            read(tmp_path, content)
    crowd, report = read(tmp_path, content, unit=unit)
    assert report.median_mps == pytest.approx(1.25, rel=1e-3)
    assert report.warnings == ()
    assert crowd.bounds[2] == pytest.approx(1.25 * TIMES[-1], rel=1e-3)
    assert read(tmp_path, content, scale=metres)[1].median_mps == pytest.approx(1.25, rel=1e-3)


@pytest.mark.parametrize(
    "head",
    ["t,id,x/cm,y/cm", "t,id,x [cm],y [cm]", "t,id,x(cm),y(cm)", "t,id,x_cm,y_cm",
     "time_s,id,X cm,Y cm", "# all in cm\nt,id,x,y", "# unit: centimetres\nt,id,x,y"],
)  # fmt: skip
def test_units_in_headers(tmp_path: Path, head: str) -> None:
    _, report = read(tmp_path, table(TIMES, 125.0 * TIMES, head=head))
    assert report.median_mps == pytest.approx(1.25)
    assert "in cm as its header says" in report.line


@pytest.mark.parametrize(
    ("head", "fault"),
    [("t,id,x [ell],y [ell]", "its x is in 'ell', which is no known unit: taken for metres"),
     ("t [jiffies],id,x,y", "its times are in 'jiffies', which is no known unit")],
)  # fmt: skip
def test_units_without_a_known_name_are_warned_of(tmp_path: Path, head: str, fault: str) -> None:
    _, report = read(tmp_path, table(TIMES, 1.25 * TIMES, head=head))
    assert report.warnings[0].startswith(fault)
    assert "--" in report.warnings[0]


def test_a_rate_that_is_guessed_is_doubted_where_people_are_slow(tmp_path: Path) -> None:
    each = "\n".join(f"{n} 1 {0.125 * n:.4f} 0" for n in range(20))
    _, report = read(tmp_path, each)
    assert "--fps 10 (1.25 m/s)" in report.warnings[0]
    fifth = "\n".join(f"{5 * n} 1 {0.125 * n:.4f} 0" for n in range(20))
    _, report = read(tmp_path, fifth)
    assert report.warnings == ()
    assert "--fps 50 (1.25 m/s)" in report.remarks[0]


def test_a_point_among_decimal_commas_is_refused(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"a.txt:2: x is '1\.250' in a table with decimal"):
        read(tmp_path, "t;id;x;y\n0,0;1;1.250;0\n0,4;1;1.750;0")


def test_slow_recordings_are_warned_of(tmp_path: Path) -> None:
    _, report = read(tmp_path, table(TIMES, 0.01 * TIMES))
    assert "the median speed is 0.01 m/s" in report.warnings[0]


@pytest.mark.parametrize("sample_s", [0.04, 0.1, 0.4, 1.0])
@pytest.mark.parametrize("at", [0, 7, 8, 29])
def test_a_jump_is_passed_over_at_any_rate(tmp_path: Path, sample_s: float, at: int) -> None:
    times = sample_s * np.arange(30)
    x = 1.25 * times
    x[at] += 60.0
    crowd, report = read(tmp_path, table(times, x))
    assert report.passed_over == 1
    assert crowd.max_speed_mps == pytest.approx(1.25, rel=1e-3)
    assert "1 sample is a glitch" in " ".join(report.remarks)
    with pytest.raises(RecordingError, match=f":{at + 2}: pedestrian '1' jumps to"):
        read(tmp_path, table(times, x), strict=True)


def test_several_jumps_and_short_runs_of_them(tmp_path: Path) -> None:
    x, y = 1.25 * TIMES, np.zeros(30)
    x[4:7] += 40.0
    y[15] = 1.6
    y[22:24] = -9.0
    crowd, report = read(tmp_path, table(TIMES, x, y))
    assert report.passed_over == 6
    assert crowd.max_speed_mps == pytest.approx(1.25, rel=1e-3)


def test_a_track_that_jumps_for_good_is_two_people(tmp_path: Path) -> None:
    x = 1.25 * TIMES
    x[15:] += 50.0
    crowd, report = read(tmp_path, table(TIMES, x))
    assert [track.id for track in crowd.tracks] == ["1", "1#2"]
    assert report.passed_over == 0
    assert any("jump for good" in remark for remark in report.remarks)


def test_runners_noise_and_turns_are_no_glitches(tmp_path: Path) -> None:
    starts_to_run = np.cumsum(np.append(0.0, np.clip(0.2 + 0.12 * np.arange(29), 0.0, 2.4)))
    assert read(tmp_path, table(TIMES, starts_to_run))[1].passed_over == 0
    there_and_back = 0.5 * np.append(np.arange(15), np.arange(15)[::-1])
    assert read(tmp_path, table(TIMES, there_and_back))[1].passed_over == 0
    times = 0.04 * np.arange(300)
    noise = np.random.default_rng(5).normal(0.0, 0.02, (2, 300))
    assert read(tmp_path, table(times, 1.25 * times + noise[0], noise[1]))[1].passed_over == 0


def test_missing_and_odd_frames_leave_the_step_as_it_is(tmp_path: Path) -> None:
    frames = [0, 10, 20, 40, 50, 61, 70, 80, 90, 100, 110, 120]
    rows = [f"{f} 1 {0.05 * f:.3f} 0" for f in frames]
    crowd, report = read(tmp_path, "\n".join(rows))
    assert report.sample_s == pytest.approx(0.4)
    assert crowd.duration_s == pytest.approx(4.8)
    assert any("the first is 61 in line 6" in remark for remark in report.remarks)


def test_one_line_says_it_all(tmp_path: Path) -> None:
    _, report = read(tmp_path, table(TIMES, 1.25 * TIMES))
    assert report.line == (
        "1 person, 11.6 s, 0.4 s a sample, median 1.25 m/s, greatest 1.25 m/s, 0 % of samples "
        "passed over; table with named columns, times in seconds, taken for metres"
    )


def test_times_that_may_be_milliseconds_are_warned_of(tmp_path: Path) -> None:
    content = table(1000.0 * TIMES, 1.25 * TIMES)
    _, report = read(tmp_path, content)
    assert "were its times milliseconds, people would walk at 1.25 m/s" in report.warnings[0]
    _, report = read(tmp_path, content, columns="t/ms,id,x,y")
    assert report.warnings == ()
    assert report.median_mps == pytest.approx(1.25, rel=1e-3)


def test_nobody_who_walks_is_warned_of(tmp_path: Path) -> None:
    _, report = read(tmp_path, "t,id,x,y\n0,1,2,3\n0,2,5,5\n")
    assert report.warnings == (
        "nobody has two samples: nothing shows that these are people who walk",
    )


def test_degrees_become_metres(tmp_path: Path) -> None:
    east = 8.5 + 1.25 * TIMES / (111_319.49 * np.cos(np.radians(48.0)))
    rows = [f"{t:.1f},1,{x:.9f},48.0" for t, x in zip(TIMES, east, strict=True)]
    _, report = read(tmp_path, "\n".join(["t,id,longitude,latitude", *rows]))
    assert report.median_mps == pytest.approx(1.25, rel=1e-3)
    assert any("in degrees becomes the origin" in remark for remark in report.remarks)


def test_heights_of_heads_are_no_ground(tmp_path: Path) -> None:
    heights = 1.7 + 0.02 * np.sin(TIMES)
    rows = [f"{t:.1f},1,{1.25 * t:.3f},0,{z:.3f}" for t, z in zip(TIMES, heights, strict=True)]
    crowd, report = read(tmp_path, "\n".join(["t,id,x,y,z", *rows]))
    assert report.remarks == ()
    assert np.all(crowd.tracks[0].positions[:, 1] == 0.0)


def test_smoothed_velocities_show_the_nearest_rate_of_cameras(tmp_path: Path) -> None:
    chance = np.random.default_rng(3)
    rows = [
        f"{10 * n} 1 {0.2 * n:.4f} 0 0 {0.46 * chance.uniform(0.85, 1.15):.4f} 0 0"
        for n in range(200)
    ]
    _, report = read(tmp_path, "\n".join(rows))
    assert "25 frames a second, as its velocities show" in report.line
