"""A folder as one recording: a file for each person, each frame or each hour of it."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from esplanade.recordings.errors import RecordingError
from esplanade.recordings.rows import Rows, Whole

MOST_FILES: Final = 20_000
MOST_BYTES: Final = 2**30
_OTHERS: Final = frozenset(
    (".md", ".png", ".jpg", ".jpeg", ".gif", ".pdf", ".avi", ".mp4", ".yaml", ".yml", ".py", ".svg")
)
"""Files that lie beside recordings and are none."""


def read_folder(path: Path, read: Callable[[Path], Rows]) -> Rows:
    """Read all files of a folder as one recording, in the order of their names.

    Files of other suffixes than the most common one are passed over. Where an id stands in several
    files, and these are not of one frame each, it is of several people, named by file and id.

    Raises
    ------
    RecordingError
        A file cannot be read, they are of different forms, or there are too many.
    """
    files, other = _files(path)
    parts: list[Rows] = []
    kept: list[Path] = []
    empty = 0
    for file in files:
        rows = read(file)
        if not len(rows.clock):
            empty += 1
            continue
        parts.append(rows)
        kept.append(file)
    if not parts:
        raise RecordingError(path, "is a folder without samples of people")
    first = parts[0]
    for rows, file in zip(parts, kept, strict=True):
        if _form(rows) != _form(first):
            raise RecordingError(
                path,
                f"is a folder of different files: {kept[0].name} is {first.format}, {file.name} is "
                f"{rows.format} of other rate or unit",
            )
    names, who = _people(parts, kept)
    remarks = [f"{len(parts)} files of the folder are read as one recording, by one clock"]
    if empty:
        remarks.append(f"{empty} files without people are passed over")
    if other:
        remarks.append(f"{other} files of other suffixes are passed over")
    joined = np.concatenate
    whole = all(rows.velocities is not None for rows in parts)
    return replace(
        first,
        lines=joined([rows.lines_listed for rows in parts]),
        ids=names,
        who=who,
        clock=joined([rows.clock for rows in parts]),
        x=joined([rows.x for rows in parts]),
        y=joined([rows.y for rows in parts]),
        velocities=joined([r.velocities for r in parts if r.velocities is not None])
        if whole
        else None,
        z=joined([r.z for r in parts if r.z is not None])
        if all(rows.z is not None for rows in parts)
        else None,
        remarks=(*remarks, *dict.fromkeys(text for rows in parts for text in rows.remarks))[:12],
        dropped=sum(rows.dropped for rows in parts),
    )


def _files(path: Path) -> tuple[list[Path], int]:
    """The files of the most frequent suffix, and the number of others that may be recordings."""
    try:
        found = sorted(file for file in path.iterdir() if file.is_file() and file.name[0] != ".")
    except OSError as error:
        raise RecordingError(path, f"cannot be read: {error.strerror}") from None
    found = [file for file in found if file.suffix.lower() not in _OTHERS]
    if not found:
        raise RecordingError(path, "cannot be read: a folder without files of recordings")
    if len(found) > MOST_FILES:
        raise RecordingError(path, f"is a folder of {len(found)} files, {MOST_FILES} are possible")
    suffix = Counter(file.suffix.lower() for file in found).most_common(1)[0][0]
    alike = [file for file in found if file.suffix.lower() == suffix]
    if sum(file.stat().st_size for file in alike) > MOST_BYTES:
        raise RecordingError(path, f"is a folder of more than {MOST_BYTES // 2**20} MiB")
    return alike, len(found) - len(alike)


def _form(rows: Rows) -> tuple[object, ...]:
    return rows.format, rows.counts_frames, rows.fps, rows.samples_per_s, rows.usual_fps, rows.unit


def _people(parts: Sequence[Rows], files: Sequence[Path]) -> tuple[list[str], Whole]:
    """Names of all people, and whose each sample is."""
    one_frame = all(rows.clock.min() == rows.clock.max() for rows in parts) and len(parts) > 1
    times = Counter(name for rows in parts for name in rows.ids)
    shared = {name for name, count in times.items() if count > 1 and not one_frame}
    index: dict[str, int] = {}
    who = []
    for rows, file in zip(parts, files, strict=True):
        alone = len(rows.ids) == 1 and (file.stem not in times or file.stem in shared)
        own = [
            (file.stem if alone else f"{file.stem}/{name}") if name in shared else name
            for name in rows.ids
        ]
        places = np.array([index.setdefault(name, len(index)) for name in own], np.int64)
        who.append(places[rows.who])
    return list(index), np.concatenate(who)
