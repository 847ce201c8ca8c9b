"""Writing a crowd so that others can read it: CSV, Jülich text, JuPedSim's SQLite, Parquet.

What a file comes from is written into it: comments at its head, the metadata of JuPedSim's table or
of Parquet's schema.
"""

import json
import sqlite3
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing
from importlib import import_module
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from esplanade.recordings.crowd import Crowd, Floats
from esplanade.recordings.jupedsim_tables import INSERT_FRAME, INSERT_SAMPLE, box, new_tables
from esplanade.recordings.rows import Whole

RESAMPLED_HZ: Final = 25.0
OFF_GRID: Final = 1e-3
"""Samples that lie further off the frames, in frames, are not written as frames as they are."""


class WritingError(ValueError):
    """A crowd cannot be written; the message says why."""


class Samples(NamedTuple):
    """All samples in the order of time: frame, person (from 1), seconds and metres, each (N,)."""

    frame: Whole
    person: Whole
    t: Floats
    x: Floats
    y: Floats


def write_crowd(
    path: Path, crowd: Crowd, provenance: Mapping[str, str], hz: float | None = None
) -> None:
    """Write a crowd in the format that the name ends in: .csv, .txt, .sqlite or .parquet.

    `hz` is the number of samples a second that are taken of everyone. Without it, samples are
    written as they are; formats that count frames then need samples at equal times.

    Raises
    ------
    WritingError
        The format is unknown, its library is not installed, times do not fit into frames, or the
        file cannot be written.
    """
    write = _WRITERS.get(path.suffix.lower())
    if write is None:
        raise WritingError(f"{path.name} ends in none of {', '.join(_WRITERS)}")
    rate = hz or _common_rate(crowd)
    try:
        write(path, crowd, _samples(crowd, rate, resample=hz is not None), rate, provenance)
    except OSError as error:
        raise WritingError(f"{path} cannot be written: {error.strerror or error}") from None
    except sqlite3.Error as error:
        raise WritingError(f"{path} cannot be written: {error}") from None


def _common_rate(crowd: Crowd) -> float:
    gaps = [np.diff(track.times) for track in crowd.tracks if len(track.times) > 1]
    if not gaps:
        return RESAMPLED_HZ
    steps, counts = np.unique(np.round(np.concatenate(gaps), 6), return_counts=True)
    return float(1.0 / steps[np.argmax(counts)])


def _samples(crowd: Crowd, rate: float, *, resample: bool) -> Samples:
    parts = []
    for person, track in enumerate(crowd.tracks, start=1):
        times, places = track.times, track.positions
        if resample:
            first, last = np.ceil(track.start_s * rate - 1e-9), np.floor(track.end_s * rate + 1e-9)
            times = np.arange(first, last + 1.0) / rate
            places = np.column_stack([np.interp(times, track.times, p) for p in places.T])
        parts.append(np.column_stack([np.full(len(times), person), times, places]))
    block = np.concatenate(parts)
    block = block[np.lexsort((block[:, 0], block[:, 1]))]
    frames = np.round(block[:, 1] * rate).astype(np.int64)
    return Samples(frames, block[:, 0].astype(np.int64), block[:, 1], block[:, 2], block[:, 3])


def _check_frames(path: Path, samples: Samples, rate: float) -> None:
    off = np.abs(samples.t * rate - samples.frame)
    if len(off) and off.max() > OFF_GRID:
        raise WritingError(
            f"{path.name} counts frames, but samples are not {1.0 / rate:.4g} s apart: give --hz"
        )


def told(provenance: Mapping[str, str]) -> Iterator[str]:
    """The origin of a file, as comments of one line each."""
    yield from (f"# {name}: {' '.join(text.split())}" for name, text in provenance.items())


def _write_csv(
    path: Path, crowd: Crowd, samples: Samples, _rate: float, provenance: Mapping[str, str]
) -> None:
    names = [_quoted(track.id) for track in crowd.tracks]
    with path.open("w", encoding="utf-8", newline="\n") as file:
        file.writelines(f"{line}\n" for line in told(provenance))
        file.write("t,id,x,y\n")
        rows = zip(*(column.tolist() for column in samples[1:]), strict=True)
        file.writelines(f"{t!r},{names[p - 1]},{x!r},{y!r}\n" for p, t, x, y in rows)


def _quoted(name: str) -> str:
    return '"' + name.replace('"', '""') + '"' if any(mark in name for mark in ",\"'") else name


def _write_text(
    path: Path, _crowd: Crowd, samples: Samples, rate: float, provenance: Mapping[str, str]
) -> None:
    _check_frames(path, samples, rate)
    with path.open("w", encoding="utf-8", newline="\n") as file:
        file.writelines(f"{line}\n" for line in told(provenance))
        file.write(f"# framerate: {rate:.10g} fps\n# id frame x/m y/m z/m\n")
        rows = zip(*(column.tolist() for column in samples), strict=True)
        file.writelines(f"{p} {frame} {x!r} {y!r} 0\n" for frame, p, _, x, y in rows)


def _write_sqlite(
    path: Path, crowd: Crowd, samples: Samples, rate: float, provenance: Mapping[str, str]
) -> None:
    _check_frames(path, samples, rate)
    x0, y0, x1, y1 = crowd.bounds
    area = box((x0 - 1, y0 - 1, x1 + 1, y1 + 1))
    with closing(new_tables(path, rate, crowd.bounds, area, provenance)) as connection, connection:
        rows = zip(*(column.tolist() for column in samples), strict=True)
        connection.executemany(
            INSERT_SAMPLE, ((frame, p, x, y, 1.0, 0.0) for frame, p, _, x, y in rows)
        )
        connection.executemany(INSERT_FRAME, ((f,) for f in np.unique(samples.frame).tolist()))


def _write_parquet(
    path: Path, crowd: Crowd, samples: Samples, _rate: float, provenance: Mapping[str, str]
) -> None:
    try:
        pa, parquet = import_module("pyarrow"), import_module("pyarrow.parquet")
    except ImportError:
        raise WritingError(
            "Parquet needs pyarrow: install it, or everything of `esplanade[recordings]`"
        ) from None
    names = np.array([track.id for track in crowd.tracks])
    columns = {"t": samples.t, "id": names[samples.person - 1], "x": samples.x, "y": samples.y}
    table = pa.table(columns).replace_schema_metadata(
        {"esplanade": json.dumps(dict(provenance)), "units": "t: seconds; x, y: metres"}
    )
    parquet.write_table(table, path)


_Writer = Callable[[Path, Crowd, Samples, float, Mapping[str, str]], None]
_WRITERS: Final[dict[str, _Writer]] = {
    ".csv": _write_csv,
    ".txt": _write_text,
    ".sqlite": _write_sqlite,
    ".parquet": _write_parquet,
}
SUFFIXES: Final = tuple(_WRITERS)
