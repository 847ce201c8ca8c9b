"""Columns in files of numbers: Parquet, and the HDF5 of the Jülich archive."""

import io
import json
from collections.abc import Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import Any, Final

import numpy as np

from esplanade.recordings.columns import Columns, find_columns, named_by_hand
from esplanade.recordings.errors import RecordingError
from esplanade.recordings.kinds import is_person, others_among, told_others
from esplanade.recordings.rows import Rows, numbered_people, people
from esplanade.recordings.units import FRAMES, length_named, time_named

PARQUET: Final = b"PAR1"
HDF5: Final = b"\x89HDF\r\n\x1a\n"
MOST_SAMPLES: Final = 100_000_000
MOST_SAMPLES_A_BYTE: Final = 2
_FEW_SAMPLES: Final = 200_000
_MOST_ROW_BYTES: Final = 4096


def read_parquet(path: Path, content: bytes, named: Sequence[str] = ()) -> Rows:
    """Read the columns of a Parquet file.

    Raises
    ------
    RecordingError
        It is damaged, lacks a column, or no library for it is installed.
    """
    pq = _library(path, "pyarrow.parquet", "Parquet", "pyarrow")
    try:
        file = pq.ParquetFile(io.BytesIO(content))
        _check_count(path, file.metadata.num_rows, len(content))
        names = list(file.schema_arrow.names)
        columns = _columns(path, names, named)
        table = file.read(columns=[names[place] for place in columns.places.values()])
        found = {role: table[names[p]].to_numpy() for role, p in columns.places.items()}
        said = file.schema_arrow.metadata or {}
    except RecordingError:
        raise
    except Exception as error:  # noqa: BLE001 (the library raises many kinds on damaged files)
        raise RecordingError(
            path, f"is a Parquet file that cannot be read: {error}"[:300]
        ) from None
    fps, unit = _said(path, said)
    return _rows(path, "Parquet", columns, found, fps, unit)


def _said(path: Path, metadata: Mapping[Any, Any]) -> tuple[float | None, str | None]:
    """Frames a second and the unit of length in the metadata of a file, or in pandas' attributes.

    Raises
    ------
    RecordingError
        The rate is none.
    """
    known = {_text(key).lower(): _text(value) for key, value in metadata.items()}
    try:
        attributes = json.loads(known.get("pandas_attrs", "{}"))
        units = json.loads(known.get("units", "{}"))
    except (ValueError, RecursionError):
        attributes, units = {}, {}
    if isinstance(attributes, dict):
        known = {f"{key}".lower(): value for key, value in attributes.items()} | known
    if isinstance(units, dict) and isinstance(units.get("x"), str):
        known.setdefault("unit", units["x"])
    fps = next((known[key] for key in ("fps", "framerate", "frame_rate") if key in known), None)
    return _rate(path, fps), length_named(f"{known.get('unit', '')}")


def read_hdf5(path: Path, content: bytes, named: Sequence[str] = ()) -> Rows:
    """Read the data set `trajectory` of the Jülich archive.

    Raises
    ------
    RecordingError
        It is damaged, lacks a column, or no library for it is installed.
    """
    h5py = _library(path, "h5py", "HDF5", "h5py")
    try:
        with h5py.File(io.BytesIO(content), "r") as file:
            held = _data_set(path, file, len(content))
            names = list(held.dtype.names or ())
            columns = _columns(path, names, named)
            found = {role: np.asarray(held[names[p]]) for role, p in columns.places.items()}
            fps = held.attrs.get("fps", file.attrs.get("fps"))
    except RecordingError:
        raise
    except Exception as error:  # noqa: BLE001 (the library raises many kinds on damaged files)
        raise RecordingError(path, f"is an HDF5 file that cannot be read: {error}"[:300]) from None
    return _rows(path, "Jülich HDF5", columns, found, _rate(path, fps), "m")


def _check_count(path: Path, count: int, size: int) -> None:
    """Refuse what would fill the memory: places of people take some bytes, however packed."""
    most = min(MOST_SAMPLES, MOST_SAMPLES_A_BYTE * size + _FEW_SAMPLES)
    if count > most:
        raise RecordingError(path, f"has {count} samples in {size} bytes, {most} are possible")


def _data_set(path: Path, file: Any, size: int) -> Any:
    held = file.get("trajectory")
    if held is None or not getattr(held, "shape", None) or held.dtype.names is None:
        raise RecordingError(path, "is an HDF5 file without a table `trajectory`")
    _check_count(path, held.shape[0], size)
    if len(held.shape) != 1 or held.dtype.itemsize > _MOST_ROW_BYTES:
        raise RecordingError(path, "its table `trajectory` is no list of samples")
    return held


def _library(path: Path, module: str, form: str, package: str) -> Any:
    try:
        return import_module(module)
    except ImportError:
        raise RecordingError(
            path,
            f"is a {form} file, which needs {package}: install it, or everything of "
            "`esplanade[recordings]`",
        ) from None


def _columns(path: Path, names: Sequence[str], named: Sequence[str]) -> Columns:
    try:
        columns = find_columns(named_by_hand(names, named) if named else names)
    except ValueError as error:
        raise RecordingError(path, f"--columns: {error}") from None
    if columns.missing:
        raise RecordingError(
            path,
            f"expected the columns t,id,x,y or other names of these; none of "
            f"{', '.join(names)!r:.100} is {' or '.join(columns.missing)}; --columns names them",
        )
    return columns


def _rate(path: Path, value: Any) -> float | None:
    if value is None:
        return None
    try:
        fps = float(value)
    except (TypeError, ValueError):
        fps = 0.0
    if not 0.0 < fps < 1e6:
        raise RecordingError(path, f"fps is {value!r:.40}, expected more than 0")
    return fps


def _rows(
    path: Path,
    form: str,
    columns: Columns,
    found: Mapping[str, Any],
    fps: float | None,
    unit: str | None = None,
) -> Rows:
    numbers = {}
    kinds = [_text(kind) for kind in found.get("kind", ())]
    others = others_among(kinds)
    of_people = np.array([is_person(kind) for kind in kinds] if others else ())
    if others and not of_people.any():
        raise RecordingError(path, f"holds no samples of people: {told_others(others)}")
    found = {
        role: np.asarray(values)[of_people] if others else values
        for role, values in found.items()
        if role != "kind"
    }
    is_moment = np.asarray(found.get("time", 0.0)).dtype.kind in "mM"
    if is_moment:
        found["time"] = _seconds(np.asarray(found["time"]))
    for role, values in found.items():
        if role != "id":
            if np.asarray(values).dtype.kind not in "iuf":
                raise RecordingError(path, f"its column for {role} holds no numbers")
            numbers[role] = np.asarray(values, np.float64)
    marks = np.asarray(found["id"])
    ids, who = (
        numbered_people(marks.astype(np.float64))
        if marks.dtype.kind in "iuf" and np.all(np.abs(marks.astype(np.float64)) < 2.0**53)
        else people([str(mark) for mark in marks.tolist()])
    )
    unit_s = 1.0 if is_moment else time_named(columns.units.get("time", ""))
    in_frames = "time" not in numbers or unit_s == FRAMES
    said = length_named(columns.units["x"]) or unit
    velocities = None
    if "vx" in numbers and "vy" in numbers:
        velocities = np.stack([numbers["vx"], numbers["vy"]], axis=1)
    return Rows(
        format=form,
        lines=1 + (np.flatnonzero(of_people) if others else np.arange(len(who))),
        ids=ids,
        who=who,
        clock=numbers.get("frame", numbers.get("time"))  # type: ignore[arg-type]
        if in_frames
        else numbers["time"] * (1.0 if unit_s is None else unit_s),
        x=numbers["x"],
        y=numbers["y"],
        counts_frames=in_frames,
        velocities=velocities,
        z=numbers.get("z"),
        times_named=is_moment or bool(columns.units.get("time")),
        unknown_units=columns.unknown_units,
        fps=fps,
        unit=said,
        unit_from="as its columns say" if said else "",
        remarks=(told_others(others),) if others else (),
        dropped=sum(others.values()),
    )


def _seconds(moments: Any) -> Any:
    """Dates with times as seconds since 1970, spans as seconds; NaN where there is none."""
    kind = "timedelta64[ns]" if moments.dtype.kind == "m" else "datetime64[ns]"
    seconds = moments.astype(kind).astype(np.int64) * 1e-9
    return np.where(np.isnat(moments), np.nan, seconds)


def _text(value: Any) -> str:
    return value.decode(errors="replace") if isinstance(value, bytes) else str(value)
