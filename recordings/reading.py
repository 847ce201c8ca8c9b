"""Reading a file of any known format as a `Crowd`.

Each format is one module, which turns a file into samples in file order. The checks that apply to
all recordings are here. A new format needs a module and a row in `_FORMATS`.
"""

import math
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Final

import numpy as np

from esplanade.recordings.crowd import Crowd, Track
from esplanade.recordings.csv_format import read_csv
from esplanade.recordings.errors import RecordingError
from esplanade.recordings.ndjson_format import read_ndjson
from esplanade.recordings.obsmat_format import read_obsmat
from esplanade.recordings.sample import MAX_METRES, Sample

_FORMATS: Final[dict[str, Callable[[Path, float | None], Iterable[Sample]]]] = {
    ".csv": lambda path, _: read_csv(path),
    ".ndjson": read_ndjson,
    ".txt": read_obsmat,
}

MIN_STEP_S: Final = 1e-3
"""Two samples of one pedestrian that are closer in time than this count as simultaneous."""

MAX_SECONDS: Final = 1e10
"""Times beyond this, either way, are taken for errors of the file."""


def read_crowd(path: str | Path, fps: float | None = None) -> Crowd:
    """Read the crowd of a recording.

    `fps` > 0 is the number of frames in a second, for formats that count frames: ETH's
    `obsmat.txt` (15 by default) and TrajNet++ ndjson (by default the `fps` of its scenes).
    A pedestrian with a single sample becomes a track of zero duration.

    Raises
    ------
    RecordingError
        The file cannot be read, has no known format or no samples, or a sample is not finite, out
        of range, repeated, or earlier than the one before.
    """
    path = Path(path)
    read = _FORMATS.get(path.suffix.lower())
    if read is None:
        known = ", ".join(sorted(_FORMATS))
        raise RecordingError(path, f"unknown format {path.suffix!r}, expected one of: {known}")
    samples_by_id: dict[str, list[Sample]] = {}
    for sample in read(path, fps):
        samples = samples_by_id.setdefault(sample.id, [])
        _check(path, sample, samples[-1] if samples else None)
        samples.append(sample)
    if not samples_by_id:
        raise RecordingError(path, "holds no samples, expected at least one")
    return Crowd(_name(path), tuple(_track(samples) for samples in samples_by_id.values()))


def _name(path: Path) -> str:
    """The name of a recording; files called `obsmat.txt` are named after their folder."""
    return path.resolve().parent.name if path.stem == "obsmat" else path.stem


def _check(path: Path, sample: Sample, before: Sample | None) -> None:
    for column, value, limit in (
        ("t", sample.t, MAX_SECONDS),
        ("x", sample.x, MAX_METRES),
        ("y", sample.y, MAX_METRES),
    ):
        if not math.isfinite(value):
            raise RecordingError(
                path, f"{column} is {value}, expected a finite number", sample.line
            )
        if abs(value) > limit:
            text = f"{column} is {value:g}, expected at most {limit:g} either way"
            raise RecordingError(path, text, sample.line)
    if before is None or sample.t - before.t >= MIN_STEP_S:
        return
    who = f"pedestrian {sample.id!r}"
    if abs(sample.t - before.t) < MIN_STEP_S:
        text = f"{who} is already at t={before.t:g} in line {before.line}, expected one sample"
    else:
        text = f"{who} goes back in time from t={before.t:g} to t={sample.t:g}, expected a later t"
    raise RecordingError(path, text, sample.line)


def _track(samples: list[Sample]) -> Track:
    times = np.array([sample.t for sample in samples], dtype=np.float64)
    positions = np.array([(sample.x, sample.y) for sample in samples], dtype=np.float64)
    times.setflags(write=False)
    positions.setflags(write=False)
    return Track(samples[0].id, times, positions)
