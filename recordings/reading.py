"""Reading a file of any known format as a `Crowd`.

Each format is one module, which turns a file into rows with the file's own numbers. What they mean
in seconds and metres, and the checks that apply to all recordings, are here.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from esplanade.recordings.crowd import Crowd, Floats, Track
from esplanade.recordings.errors import RecordingError
from esplanade.recordings.formats import read_rows
from esplanade.recordings.glitches import own_pace, sound_part
from esplanade.recordings.meanings import on_the_ground, since_1970
from esplanade.recordings.plausibility import (
    Report,
    advice,
    beyond_meaning,
    measured,
    warnings_of,
)
from esplanade.recordings.rates import Rate, frame_rate, likely_rates, pairs_of
from esplanade.recordings.rows import Given, Rows, Whole
from esplanade.recordings.units import DEGREES, MAX_METRES, PIXELS, UNITS

MIN_STEP_S: Final = 1e-3
"""Two samples of one pedestrian that are closer in time than this count as simultaneous."""

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
    rows = replace(rows, clock=rows.clock / rate.fps, x=rows.x * metres, y=rows.y * metres)
    _check_range(path, rows, unit_known=bool(rows.unit or given.unit or given.scale))
    order, repeats = _in_order(path, rows)
    return _crowd(path, rows, order, repeats, given, rate, unit_source)


def _with_places(rows: Rows) -> Rows:
    """The samples that are somewhere: tables often have lines of people who are not seen."""
    nowhere = np.isnan(rows.x) & np.isnan(rows.y)
    count = int(np.count_nonzero(nowhere))
    if not count:
        return rows
    there = ~nowhere
    remark = f"{count} {'sample' if count == 1 else 'samples'} without a place are left out"
    return replace(
        rows,
        lines=rows.lines[there],
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
        wrong = np.flatnonzero(np.abs(values) > limit)
        if len(wrong):
            text = f"{column} is {values[wrong[0]]:g}, expected at most {limit:g} either way"
            raise RecordingError(path, text + hints[column], int(rows.lines[wrong[0]]))


def _order(rows: Rows) -> Whole:
    """The samples by person and time; files that are in this order already are not sorted."""
    people, times = np.diff(rows.who), np.diff(rows.clock)
    if np.all((people > 0) | ((people == 0) & (times >= 0.0))):
        return np.arange(len(rows.who))
    if np.all(times >= 0.0) and len(rows.ids) < 2**16:
        return np.argsort(rows.who.astype(np.uint16), kind="stable")  # by digits, not comparisons
    return np.lexsort((rows.lines, rows.clock, rows.who))


def _in_order(path: Path, rows: Rows) -> tuple[Whole, int]:
    """The samples by person and time, without exact repeats, and how many of these there are."""
    order = _order(rows)
    same = np.diff(rows.who[order]) == 0
    at_once = same & (np.diff(rows.clock[order]) < MIN_STEP_S)
    if not at_once.any():
        return order, 0
    first, second = order[:-1][at_once], order[1:][at_once]
    moved = (rows.x[first] != rows.x[second]) | (rows.y[first] != rows.y[second])
    if moved.any():
        here, there = int(first[np.argmax(moved)]), int(second[np.argmax(moved)])
        here, there = sorted((here, there), key=lambda i: int(rows.lines[i]))
        raise RecordingError(
            path,
            f"pedestrian {rows.ids[rows.who[here]]!r} is already at t={rows.clock[here]:g} in line "
            f"{rows.lines[here]}, elsewhere; expected one sample",
            int(rows.lines[there]),
        )
    kept = np.append(True, ~at_once)
    return order[kept], int(np.count_nonzero(at_once))


def _crowd(
    path: Path,
    rows: Rows,
    order: Whole,
    repeats: int,
    given: Given,
    rate: Rate,
    unit_source: str,
) -> Crowd:
    unit_known = bool(rows.unit or given.unit or given.scale)
    rate_known = not rows.counts_frames or given.fps is not None or rows.fps is not None
    cuts = np.flatnonzero(np.diff(rows.who[order])) + 1
    parts = np.split(order, cuts)
    places = np.column_stack([rows.x, rows.y])
    paces = [own_pace(rows.clock[part], places[part]) for part in parts]
    usual_mps = float(np.nanmedian(paces)) if not np.all(np.isnan(paces)) else 0.0
    if beyond_meaning(usual_mps):
        told = advice(usual_mps, rate.fps or 0.0, unit_known=unit_known, rate_known=rate_known)
        raise RecordingError(path, f"people would move at {usual_mps:.4g} m/s; {told}")
    tracks: list[tuple[float, int, Track]] = []
    glitches = divided = 0
    for part, pace in zip(parts, paces, strict=True):
        sound = sound_part(rows.clock[part], places[part], usual_mps, pace)
        glitches += sound.glitches
        if sound.glitches and given.strict:
            raise RecordingError(path, *_glitch(rows, part[np.argmax(sound.pieces < 0)]))
        name = rows.ids[rows.who[part[0]]]
        for piece in range(int(sound.pieces.max()) + 1):
            own = part[sound.pieces == piece]
            if len(own):
                divided += piece > 0
                made = _track(
                    f"{name}#{piece + 1}" if piece else name, rows.clock[own], places[own]
                )
                tracks.append((made.start_s, int(own.min()), made))
    if divided and given.strict:
        raise RecordingError(path, f"{divided} tracks jump to another place for good")
    tracks.sort(key=lambda each: each[:2])
    found = tuple(track for _, _, track in tracks)
    remarks = [*rows.remarks, *rate.remarks]
    if repeats:
        remarks.append(f"{repeats} exact repeats are left out")
    if divided:
        remarks.append(f"{divided} tracks jump for good: read as more people, named ID#2 and so on")
    if glitches:
        remarks.append(_first_glitch(glitches))
    sample_s, median_mps = measured(found)
    report = Report(
        format=rows.format,
        people=len(found),
        samples=sum(len(track.times) for track in found),
        seconds=max(t.end_s for t in found) - min(t.start_s for t in found),
        sample_s=sample_s,
        median_mps=median_mps,
        greatest_mps=max(track.max_speed_mps for track in found),
        passed_over=glitches,
        rate=f"{rate.fps:.6g} frames a second, {rate.source}"
        if rows.counts_frames
        else rate.source,
        unit=unit_source,
        remarks=tuple(remarks),
    )
    warnings = warnings_of(
        median_mps,
        rate.fps or 0.0,
        glitches,
        report.share_passed_over,
        unit_known=unit_known,
        rate_known=rate_known,
        times_known=rows.counts_frames or rows.times_named,
    )
    return Crowd(_name(path), found, replace(report, warnings=(*rate.warnings, *warnings)))


def _glitch(rows: Rows, sample: int) -> tuple[str, int]:
    text = (
        f"pedestrian {rows.ids[rows.who[sample]]!r} jumps to ({rows.x[sample]:g}, "
        f"{rows.y[sample]:g}) at t={rows.clock[sample]:g}; without --strict this is passed over"
    )
    return text, int(rows.lines[sample])


def _first_glitch(count: int) -> str:
    what = "sample is a glitch" if count == 1 else "samples are glitches"
    return f"{count} {what} of tracking and passed over; --strict names the first"


def _track(name: str, times: Floats, positions: Floats) -> Track:
    times.setflags(write=False)
    positions.setflags(write=False)
    return Track(name, times, positions)
