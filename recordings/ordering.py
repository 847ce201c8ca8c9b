"""Rows in the order of people and times, without exact repeats.

Large tables are gone through in pieces that stay near the processor, and of what has as many
entries as there are samples, little is there twice.
"""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from esplanade.recordings.errors import RecordingError
from esplanade.recordings.rows import Rows, Whole

MIN_STEP_S: Final = 1e-3
"""Two samples of one pedestrian that are closer in time than this count as simultaneous."""

_PIECE: Final = 65_536
_MOST_BY_DIGITS: Final = 2**16


def in_order(path: Path, rows: Rows) -> tuple[Rows, int]:
    """The samples by person and time, without exact repeats, and how many of these there are.

    Raises
    ------
    RecordingError
        Somebody is at two places at once.
    """
    rows = _taken(rows, _order(rows))
    first = _at_once(rows)
    if not len(first):
        return rows, 0
    moved = (rows.x[first] != rows.x[first + 1]) | (rows.y[first] != rows.y[first + 1])
    if moved.any():
        here = int(first[np.argmax(moved)])
        here, there = sorted((here, here + 1), key=lambda i: int(rows.lines[i]))
        raise RecordingError(
            path,
            f"pedestrian {rows.ids[rows.who[here]]!r} is already at t={rows.clock[here]:g} in line "
            f"{rows.lines[here]}, elsewhere; expected one sample",
            int(rows.lines[there]),
        )
    kept = np.ones(len(rows.who), bool)
    kept[first + 1] = False
    return _taken(rows, np.flatnonzero(kept)), len(first)


def _order(rows: Rows) -> Whole | None:
    """The order of samples by person and time; None for files that are in it already."""
    by_person = by_time = True
    for begin, end in _pieces(len(rows.who), 1):
        later = rows.clock[begin + 1 : end] >= rows.clock[begin : end - 1]
        by_time = by_time and bool(later.all())
        if by_person:
            who = rows.who[begin:end]
            by_person = bool(np.all((who[1:] > who[:-1]) | ((who[1:] == who[:-1]) & later)))
        if not (by_person or by_time):
            return np.lexsort((rows.lines, rows.clock, rows.who))
    if by_person:
        return None
    if len(rows.ids) < _MOST_BY_DIGITS and len(rows.who) < 2**31:
        return _order_by_person(rows.who, len(rows.ids))
    return np.argsort(rows.who, kind="stable")


def _order_by_person(who: Whole, people: int) -> Whole:
    """The order by person of samples that are in the order of time; int32 (N,).

    Each piece is sorted by digits, and the samples of each person in it are put behind those of
    the pieces before.
    """
    counts = np.zeros(people, np.int64)
    for begin, end in _pieces(len(who)):
        counts += np.bincount(who[begin:end], minlength=people)
    filled = np.cumsum(counts) - counts
    order = np.empty(len(who), np.int32)
    for begin, end in _pieces(len(who)):
        local = np.argsort(who[begin:end].astype(np.uint16), kind="stable")
        own = who[begin:end][local]
        starts = np.append(0, np.flatnonzero(own[1:] != own[:-1]) + 1)
        lengths = np.diff(starts, append=len(own))
        persons = own[starts]
        places = np.repeat(filled[persons] - starts, lengths) + np.arange(len(own))
        order[places] = local + begin
        filled[persons] += lengths
    return order


def _at_once(rows: Rows) -> Whole:
    """The samples after which the next one is of the same person and time."""
    found = [np.empty(0, np.int64)]
    for begin, end in _pieces(len(rows.who), 1):
        gaps = rows.clock[begin + 1 : end] - rows.clock[begin : end - 1]
        same = rows.who[begin + 1 : end] == rows.who[begin : end - 1]
        found.append(begin + np.flatnonzero(same & (gaps < MIN_STEP_S)))
    return np.concatenate(found)


def _taken(rows: Rows, order: Whole | None) -> Rows:
    """Rows in another order, one column after the other."""
    if order is None:
        return rows
    made: dict[str, Any] = {"velocities": None, "z": None}
    spare = np.empty(len(order))
    for name in ("lines", "who", "clock", "x", "y"):
        column = getattr(rows, name)
        if len(order) == len(column) and column.flags.writeable and column.itemsize <= 8:
            moved = spare.view(column.dtype)[: len(column)]
            for begin, end in _pieces(len(order)):
                moved[begin:end] = column[order[begin:end]]
            column[:] = moved
        else:
            made[name] = column[order]
    return replace(rows, **made)


def _pieces(count: int, beyond: int = 0) -> Iterator[tuple[int, int]]:
    """Where pieces begin and end; each holds so many of the next one as well."""
    for begin in range(0, count, _PIECE):
        yield begin, min(count, begin + _PIECE + beyond)
