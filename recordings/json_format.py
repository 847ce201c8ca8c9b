"""JSON: samples as objects in lines or a list, as columns, by person, and WildTrack's frames."""

import json
import math
import re
from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import compress
from pathlib import Path
from typing import Any, Final

import numpy as np

from esplanade.recordings.columns import find_columns, named_by_hand
from esplanade.recordings.errors import RecordingError
from esplanade.recordings.kinds import is_person, others_among, told_others
from esplanade.recordings.ndjson_format import read_ndjson
from esplanade.recordings.rows import Floats, Rows, people
from esplanade.recordings.units import FRAMES, length_named, time_named

MOST_VALUES: Final = 4_000_000
"""Most values of a file that is read as a whole: each takes some hundred bytes."""
_RATES: Final = ("fps", "framerate")
_SPANS: Final = ("dt", "frameinterval", "sampleinterval", "samplinginterval", "sampletime")
_LONGEST_SPAN_S: Final = 10.0
_UNITS: Final = ("unit", "units", "lengthunit", "unitoflength")
_PLACES: Final = ("position", "pos", "coordinates", "location", "xy", "point")
_WILDTRACK: Final = {"personID", "positionID"}
_WILDTRACK_FPS: Final = 10.0
_GRID: Final = 480
_CELL_M: Final = 0.025
_DEPTH: Final = 6

_Record = dict[str, Any]


def read_json(path: Path, text: str, named: Sequence[str] = ()) -> Rows:
    """Read samples from JSON of any of these forms.

    Raises
    ------
    RecordingError
        It is no JSON, or nothing in it is a sample.
    """
    first = text.lstrip()[:400]
    if '"scene"' in first or '"track"' in first:
        return read_ndjson(path, text)
    numbers, content = _content(path, text)
    if isinstance(content, list) and content and _is_wildtrack(content[0]):
        return _wildtrack(path, content)
    samples = _Samples(named)
    try:
        records = list(samples.below(content, {}))
    except (RecursionError, TypeError, ValueError, OverflowError) as error:
        raise RecordingError(path, f"its JSON holds no samples: {error}"[:200]) from None
    if not records:
        raise RecordingError(
            path, "its JSON holds no samples, expected objects with t, id, x, y", 1
        )
    lines = numbers if len(numbers) == len(records) else [*range(1, len(records) + 1)]
    return _rows(path, records, lines, samples, named)


def _content(path: Path, text: str) -> tuple[list[int], Any]:
    """The content, and the lines of its samples where there is one in each."""
    if sum(text.count(mark) for mark in ",[{") > MOST_VALUES:
        raise RecordingError(
            path, f"its JSON has more than {MOST_VALUES} values, the most that is read: use CSV"
        )
    lines = [(n, line) for n, line in enumerate(text.split("\n"), 1) if line.strip()]
    if len(lines) > 1 and lines[0][1].rstrip().endswith("}") and lines[1][1].startswith("{"):
        found = []
        for number, line in lines:
            try:
                found.append(json.loads(line))
            except (ValueError, RecursionError):
                raise RecordingError(path, f"{line!r:.40} is not JSON", number) from None
        return [number for number, _ in lines], found
    try:
        return [], json.loads(text)
    except json.JSONDecodeError as error:
        number = min(error.lineno, lines[-1][0]) if lines else 1
        line = text.split("\n")[number - 1]
        fault = f"{line!r:.40} is not JSON: {error.msg}"
        raise RecordingError(path, fault, number) from None
    except (ValueError, RecursionError) as error:
        raise RecordingError(path, f"it is no JSON that can be read: {error}"[:200], 1) from None


class _Samples:
    """Gathers samples from objects and lists within each other, whatever their order."""

    def __init__(self, named: Sequence[str]) -> None:
        self.fps: float | None = None
        self.samples_per_s: float | None = None
        self.unit: str | None = None
        self._named = named
        self._whole: dict[tuple[str, ...], bool] = {}

    def below(self, content: Any, known: _Record, left: int = _DEPTH) -> Iterator[_Record]:
        """All samples below a value, each with what is known from above it."""
        if left == 0:
            return
        if isinstance(content, list):
            for part in content:
                yield from self.below(part, known, left - 1)
        elif isinstance(content, dict):
            people_below = _by_person(content)
            yield from self._object(content, known, left) if people_below is None else people_below

    def _object(self, content: _Record, known: _Record, left: int) -> Iterator[_Record]:
        own = dict(known)
        lists: dict[str, list[Any]] = {}
        inner: list[Any] = []
        for key, value in content.items():
            if self._says(key, value):
                continue
            if key.lower() in _PLACES and (point := _point(value)):
                own.update(point)
            elif isinstance(value, dict) or _has_parts(key, value):
                inner.append(value)
            elif isinstance(value, list):
                lists[key] = value
            else:
                own[key] = value
        if self._is_sample(own):
            yield own
            return
        if lists:
            yield from _zipped(own, lists)
        for value in inner:
            yield from self.below(value, own, left - 1)

    def _says(self, key: str, value: Any) -> bool:
        """Whether a value is a rate or a unit of all samples, which are kept."""
        name = _plain(key)
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        if name in _RATES and is_number:
            self.fps = float(value)
        elif name in _SPANS and is_number and 0.0 < value <= _LONGEST_SPAN_S:
            self.samples_per_s = 1.0 / value
        elif name in _UNITS and (unit := _length_in(value)) is not None:
            self.unit = unit
        else:
            return False
        return True

    def _is_sample(self, record: _Record) -> bool:
        keys = tuple(record)
        if keys not in self._whole:
            try:
                header = named_by_hand(keys, self._named) if self._named else keys
                self._whole[keys] = not find_columns(header).missing
            except ValueError:
                self._whole[keys] = False
        return self._whole[keys]


@lru_cache(maxsize=256)
def _plain(key: str) -> str:
    return re.sub(r"[^a-z]", "", key[:100].lower())


def _length_in(value: Any) -> str | None:
    """The unit of length that a text names, or an object of texts does for places."""
    if isinstance(value, str):
        return length_named(value)
    if isinstance(value, dict):
        named = {key.lower(): unit for key, unit in value.items() if isinstance(unit, str)}
        found = (length_named(named[key]) for key in ("x", "length", *_PLACES) if key in named)
        return next(filter(None, found), None)
    return None


def _has_parts(key: str, value: Any) -> bool:
    is_parts = isinstance(value, list) and bool(value) and isinstance(value[0], dict | list)
    return is_parts and key.lower() not in _PLACES


def _point(value: Any) -> _Record | None:
    if isinstance(value, dict):
        return value
    return dict(zip("xyz", value, strict=False)) if _is_point(value) else None


def _zipped(own: _Record, lists: dict[str, list[Any]]) -> Iterator[_Record]:
    """A sample for each place in lists of the same length."""
    counts = {len(values) for values in lists.values()}
    if len(counts) > 1:
        raise ValueError(f"lists of {', '.join(list(lists)[:6])} differ in length")
    for values in zip(*lists.values(), strict=True):
        record = dict(own)
        for key, value in zip(lists, values, strict=True):
            if key.lower() in _PLACES and _is_point(value):
                record.update(zip("xyz", value, strict=False))
            else:
                record[key] = value
        yield record


def _is_point(value: Any) -> bool:
    return isinstance(value, list) and len(value) in (2, 3) and not isinstance(value[0], list)


def _by_person(content: _Record) -> Iterator[_Record] | None:
    """The samples of Pathfinder: by person, then by time; None for other objects."""
    inner = [value for value in content.values() if isinstance(value, dict)]
    if len(inner) != len(content) or not inner or not all(map(_is_clock, inner[0])):
        return None
    if not all(isinstance(value, dict) for value in inner[0].values()) or not inner[0]:
        return None
    return (
        _pathfinder_sample(person, time, at)
        for person, times in content.items()
        for time, at in times.items()
    )


def _pathfinder_sample(person: str, time: str, at: Any) -> _Record:
    place = at.get("position", at) if isinstance(at, dict) else None
    if not isinstance(place, dict) or not _is_clock(time):
        raise ValueError(f"{person!r:.40} at {time!r:.40} is no sample")
    return {**place, "id": person, "t": float(time)}


def _is_clock(key: str) -> bool:
    try:
        return math.isfinite(float(key))
    except ValueError:
        return False


def _rows(
    path: Path,
    records: list[_Record],
    lines: list[int],
    said: _Samples,
    named: Sequence[str],
) -> Rows:
    keys = list(records[0])
    try:
        columns = find_columns(named_by_hand(keys, named) if named else keys)
    except ValueError as error:
        raise RecordingError(path, f"--columns: {error}") from None
    if columns.missing:
        raise RecordingError(
            path,
            f"its JSON has samples of {', '.join(keys)!r:.100}; none of these is "
            f"{' or '.join(columns.missing)}; --columns names them",
        )
    keyed = {role: keys[place] for role, place in columns.places.items()}
    kind = keyed.pop("kind", None)
    count = len(records)
    others = {} if kind is None else others_among(str(each.get(kind, "")) for each in records)
    if kind is not None and others:
        of_people = [is_person(str(each.get(kind, ""))) for each in records]
        records, lines = [*compress(records, of_people)], [*compress(lines, of_people)]
        if not records:
            raise RecordingError(path, f"holds no samples of people: {told_others(others)}")
    numbers: dict[str, Floats] = {
        role: np.array(
            [_number(path, n, r, key) for n, r in zip(lines, records, strict=True)], np.float64
        )
        for role, key in keyed.items()
        if role != "id"
    }
    ids, who = people([_name(path, n, r, keyed["id"]) for n, r in zip(lines, records, strict=True)])
    unit_s = time_named(columns.units.get("time", ""))
    in_frames = "time" not in numbers or unit_s == FRAMES
    clock: Floats = numbers["frame"] if "time" not in numbers else numbers["time"]
    unit, fps = length_named(columns.units["x"]), said.fps
    unit_from = "as its keys say" if unit else "as it says"
    unit = unit or said.unit
    if fps is not None and not 0.0 < fps < 1e6:
        raise RecordingError(path, f"fps is {fps:g}, expected more than 0")
    return Rows(
        format="JSON of samples",
        lines=np.array(lines, np.int64),
        ids=ids,
        who=who,
        clock=clock if in_frames or unit_s is None else clock * unit_s,
        x=numbers["x"],
        y=numbers["y"],
        z=numbers.get("z"),
        counts_frames=in_frames,
        velocities=np.stack([numbers["vx"], numbers["vy"]], axis=1)
        if {"vx", "vy"} <= numbers.keys()
        else None,
        fps=fps,
        samples_per_s=said.samples_per_s,
        usual_from="as it says",
        unit=unit,
        unit_from=unit_from if unit else "",
        unknown_units=columns.unknown_units,
        times_named=bool(columns.units.get("time")),
        remarks=(told_others(others),) if others else (),
        dropped=count - len(records),
    )


def _number(path: Path, line: int, record: _Record, key: str) -> float:
    value = record.get(key)
    try:
        if value is None:
            return math.nan
        if not isinstance(value, bool | list | dict):
            return float(value)
    except (ValueError, OverflowError):
        pass
    raise RecordingError(path, f"{key} is {value!r:.40}, expected a number", line)


def _name(path: Path, line: int, record: _Record, key: str) -> str:
    value = record.get(key)
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    if not isinstance(value, str | int) or isinstance(value, bool) or not f"{value!s:.400}":
        raise RecordingError(path, f"{key} is {value!r:.40}, expected a pedestrian's id", line)
    return f"{value!s:.400}"


def _is_wildtrack(first: Any) -> bool:
    return isinstance(first, dict) and first.keys() >= _WILDTRACK


def _wildtrack(path: Path, content: list[Any]) -> Rows:
    """One frame of WildTrack, whose number is the name of the file: cells of a grid of 2.5 cm."""
    if not path.stem.isdecimal() or len(path.stem) > 12:
        raise RecordingError(path, "a file of WildTrack is named after its frame")
    try:
        names = [str(int(person["personID"])) for person in content]
        cells = np.array([int(person["positionID"]) for person in content], np.int64)
    except (KeyError, TypeError, ValueError, OverflowError):
        raise RecordingError(path, "expected whole numbers personID and positionID") from None
    ids, who = people(names)
    return Rows(
        format="WildTrack",
        lines=np.arange(1, len(names) + 1),
        ids=ids,
        who=who,
        clock=np.full(len(names), float(path.stem)),
        x=np.asarray(-3.0 + _CELL_M * (cells % _GRID), np.float64),
        y=np.asarray(-9.0 + _CELL_M * (cells // _GRID), np.float64),
        counts_frames=True,
        usual_fps=_WILDTRACK_FPS,
        usual_from="as WildTrack counts them",
        unit="m",
        unit_from="as its grid has it",
    )
