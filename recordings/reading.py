"""Reading a file of any known format as a `Crowd`.

Each format is one module, which turns a file into rows with the file's own numbers. What they mean
in seconds and metres, and the checks that apply to all recordings, are here.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from esplanade.recordings.crowd import Crowd
from esplanade.recordings.errors import RecordingError
from esplanade.recordings.formats import read_rows
from esplanade.recordings.meanings import near_the_origin, on_the_ground, since_1970
from esplanade.recordings.ordering import in_order
from esplanade.recordings.plausibility import (
    Report,
    advice,
    beyond_meaning,
    warnings_of,
)
from esplanade.recordings.rates import Rate, frame_rate, likely_rates, pairs_of
from esplanade.recordings.rows import Floats, Given, Rows
from esplanade.recordings.tracks import Steps, tracks_of
from esplanade.recordings.units import DEGREES, MAX_METRES, PIXELS, UNITS

MOST_PEOPLE: Final = 500_000
MAX_SECONDS: Final = 1e10
"""Times beyond this, either way, are taken for errors of the file."""


def read_crowd(
    path: str | Path,
    fps: float | None = None,
    *,
    unit: str | None = None,
    scale: float | None = None,
    strict: bool = False,
    columns: str | Sequence[str] = (),
) -> Crowd:
    """Read the crowd of a recording, a file or a folder; its `report` says how it was understood.

    `fps` > 0 is the number of frame numbers in a second, for files that count frames and do not
    say it. `unit` is the unit of coordinates (`UNITS`), or `scale` the metres in one unit of them.
    `columns` names the columns of a table, whatever its header says: a name for each, as in
    `frame,id,,x/cm,y/cm`, or `role=name` for those that count, in a text or as a list.
    Samples that nobody can have been at are passed over; with `strict`, they are an error. Exact
    repeats and unsorted samples are forgiven. A pedestrian with a single sample becomes a track of
    zero duration.

    Raises
    ------
    RecordingError
        The file cannot be read, has no known format or no samples, a sample is not finite, out of
        range or at two places, or nobody can have moved as it says.
    """
    path = Path(path)
    named = columns.split(",") if isinstance(columns, str) else columns
    given = Given(fps, unit, scale, strict, tuple(name.strip() for name in named))
    rows = _with_places(read_rows(path, given))
    if not len(rows.clock):
        raise RecordingError(path, "holds no samples of people, expected at least one")
    if len(rows.ids) > MOST_PEOPLE:
        fault = f"has {len(rows.ids)} people, {MOST_PEOPLE} are possible: is that column their id?"
        raise RecordingError(path, fault)
    _check_finite(path, rows)
    metres, unit_source = _metres(path, rows, given)
    rows = on_the_ground(rows, metres)
    if rows.counts_frames:
        rate = frame_rate(rows, given, metres)
    else:
        rate = _seconds(given)
        rows = since_1970(rows)
    if rate.fps is None:
        raise RecordingError(path, _no_rate(rows, metres))
    if rate.fps != 1.0:
        rows = replace(rows, clock=rows.clock / rate.fps)
    if metres != 1.0:
        rows = replace(rows, x=rows.x * metres, y=rows.y * metres)
    rows = near_the_origin(rows)
    _check_range(path, rows, unit_known=bool(rows.unit or given.unit or given.scale))
    rows, repeats = in_order(path, rows)
    return _crowd(path, rows, repeats, given, rate, unit_source)


def _with_places(rows: Rows) -> Rows:
    """The samples that are somewhere: tables often have lines of people who are not seen."""
    if not len(rows.x) or not np.isnan(rows.x.min()):
        return rows
    nowhere = np.isnan(rows.x) & np.isnan(rows.y)
    count = int(np.count_nonzero(nowhere))
    if not count:
        return rows
    there = ~nowhere
    remark = f"{count} {'sample' if count == 1 else 'samples'} without a place are left out"
    return replace(
        rows,
        lines=rows.lines_listed[there],
        who=rows.who[there],
        clock=rows.clock[there],
        x=rows.x[there],
        y=rows.y[there],
        velocities=None if rows.velocities is None else rows.velocities[there],
        z=None if rows.z is None else rows.z[there],
        remarks=(*rows.remarks, remark),
        dropped=rows.dropped + count,
    )


def _name(path: Path) -> str:
    """The name of a recording; files called `obsmat.txt` are named after their folder."""
    stem = Path(path.stem).stem if path.suffix.lower() == ".gz" else path.stem
    return path.resolve().parent.name if stem == "obsmat" else stem


def _check_finite(path: Path, rows: Rows) -> None:
    clock = "frame" if rows.counts_frames else "t"
    for column, values in ((clock, rows.clock), ("x", rows.x), ("y", rows.y)):
        if np.isfinite(values.min()) and np.isfinite(values.max()):
            continue
        wrong = np.flatnonzero(~np.isfinite(values))
        if len(wrong):
            value, line = float(values[wrong[0]]), int(rows.lines[wrong[0]])
            raise RecordingError(path, f"{column} is {value}, expected a finite number", line)
    for person, name in enumerate(rows.ids):
        if name.lower() == "nan":
            line = int(rows.lines[np.argmax(rows.who == person)])
            raise RecordingError(path, f"id is {name}, expected the id of a pedestrian", line)


def _metres(path: Path, rows: Rows, given: Given) -> tuple[float, str]:
    """The metres in one unit of the file, and where that comes from."""
    if given.scale is not None:
        return given.scale, f"{given.scale:g} m a unit by --scale"
    if given.unit is not None and given.unit not in UNITS:
        raise RecordingError(path, f"unit {given.unit!r} is none of {', '.join(UNITS)}")
    unit = given.unit or rows.unit
    if unit == DEGREES:
        return 1.0, "in degrees, made metres around their middle"
    if unit == PIXELS:
        raise RecordingError(
            path,
            "its coordinates are pixels: give --scale, the metres in one pixel (0.02 to 0.06 in "
            "most films from above)",
        )
    if unit is None:
        return 1.0, "taken for metres"
    return UNITS[unit], f"in {unit} {'by --unit' if given.unit else rows.unit_from}"


def _seconds(given: Given) -> Rate:
    remarks = ("--fps is not needed: the file gives times",) if given.fps is not None else ()
    return Rate(1.0, "times in seconds", remarks)


def _no_rate(rows: Rows, metres: float) -> str:
    pairs = pairs_of(rows)
    away = metres * np.hypot(*(v[pairs.second] - v[pairs.first] for v in (rows.x, rows.y)))
    step = float(np.median(away / pairs.frames))
    fitting = likely_rates(step)
    hints = [f"--fps {rate:g} ({step * rate:.3g} m/s)" for rate in fitting]
    if not fitting and rows.unit is None:
        hints = [
            f"--unit {unit} with --fps {rate:g} ({step * UNITS[unit] * rate:.3g} m/s)"
            for unit in ("cm", "mm")
            for rate in likely_rates(step * UNITS[unit])
        ]
    told = f"; people would walk with {', '.join(hints)}" if hints else ""
    return f"it counts frames and does not say how many a second: give --fps{told}"


def _check_range(path: Path, rows: Rows, *, unit_known: bool) -> None:
    hints = {"t": "", "x": "" if unit_known else "; is its unit the metre? --unit and --scale say"}
    hints["y"] = hints["x"]
    for column, values, limit in (
        ("t", rows.clock, MAX_SECONDS),
        ("x", rows.x, MAX_METRES),
        ("y", rows.y, MAX_METRES),
    ):
        if values.max() <= limit and values.min() >= -limit:
            continue
        wrong = np.flatnonzero(np.abs(values) > limit)
        if len(wrong):
            text = f"{column} is {values[wrong[0]]:g}, expected at most {limit:g} either way"
            raise RecordingError(path, text + hints[column], int(rows.lines[wrong[0]]))


def _places(rows: Rows) -> Floats:
    """The places (N, 2), metres; those of large tables are together already."""
    together = rows.x.base
    if (
        together is not None
        and together is rows.y.base
        and together.shape[1:] == (2,)
        and rows.x.ctypes.data == together.ctypes.data
        and rows.x.strides == rows.y.strides == together.strides[:1]
        and rows.y.ctypes.data == together.ctypes.data + together.strides[1]
    ):
        return together[: len(rows.x)]
    return np.column_stack([rows.x, rows.y])


def _crowd(
    path: Path, rows: Rows, repeats: int, given: Given, rate: Rate, unit_source: str
) -> Crowd:
    unit_known = bool(rows.unit or given.unit or given.scale)
    said = (given.fps, rows.fps, rows.samples_per_s)
    rate_known = not rows.counts_frames or any(rate is not None for rate in said)
    places = _places(rows)
    steps = Steps(rows, places)
    paces = steps.paces[~np.isnan(steps.paces)]
    usual_mps = float(np.median(paces)) if len(paces) else 0.0
    if beyond_meaning(usual_mps):
        told = advice(usual_mps, rate.fps or 0.0, unit_known=unit_known, rate_known=rate_known)
        raise RecordingError(path, f"people would move at {usual_mps:.4g} m/s; {told}")
    found = tracks_of(rows, places, steps, usual_mps)
    if found.glitches and given.strict:
        raise RecordingError(path, *_glitch(rows, found.first_glitch))
    if found.divided and given.strict:
        raise RecordingError(path, f"{found.divided} tracks jump to another place for good")
    remarks = [*rows.remarks, *rate.remarks]
    if repeats:
        remarks.append(f"{repeats} exact repeats are left out")
    if found.divided:
        count = found.divided
        remarks.append(f"{count} tracks jump for good: read as more people, named ID#2 and so on")
    if found.glitches:
        remarks.append(_first_glitch(found.glitches))
    tracks = found.tracks
    report = Report(
        format=rows.format,
        people=len(tracks),
        samples=sum(len(track.times) for track in tracks),
        seconds=max(t.end_s for t in tracks) - min(t.start_s for t in tracks),
        sample_s=found.sample_s,
        median_mps=found.median_mps,
        greatest_mps=max(track.max_speed_mps for track in tracks),
        passed_over=found.glitches,
        rate=f"{rate.fps:.6g} frames a second, {rate.source}"
        if rows.counts_frames
        else rate.source,
        unit=unit_source,
        remarks=tuple(remarks),
    )
    warnings = warnings_of(
        found.median_mps,
        rate.fps or 0.0,
        found.glitches,
        report.share_passed_over,
        unit_known=unit_known,
        rate_known=rate_known,
        times_known=rows.counts_frames or rows.times_named,
    )
    unknown = tuple(_unknown_units(rows, given))
    told_of = replace(report, warnings=(*unknown, *rate.warnings, *warnings))
    return Crowd(_name(path), tuple(tracks), told_of)


def _unknown_units(rows: Rows, given: Given) -> Iterator[str]:
    """Remarks on units without a known name: what they are taken for, and the option for that."""
    for column, unit in rows.unknown_units.items():
        if column == "time":
            yield (
                f"its times are in {unit!r:.40}, which is no known unit: taken for seconds; "
                "--columns says otherwise, as in --columns t=NAME/ms,id=NAME,.."
            )
        elif not (given.unit or given.scale):
            yield (
                f"its {column} is in {unit!r:.40}, which is no known unit: taken for metres; "
                "--unit or --scale say otherwise"
            )


def _glitch(rows: Rows, sample: int) -> tuple[str, int]:
    text = (
        f"pedestrian {rows.ids[rows.who[sample]]!r} jumps to ({rows.x[sample]:g}, "
        f"{rows.y[sample]:g}) at t={rows.clock[sample]:g}; without --strict this is passed over"
    )
    return text, int(rows.lines[sample])


def _first_glitch(count: int) -> str:
    what = "sample is a glitch" if count == 1 else "samples are glitches"
    return f"{count} {what} of tracking and passed over; --strict names the first"
