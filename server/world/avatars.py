"""The avatars of a zone as an audience knows them: from frames, and from nothing else."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from esplanade.protocol.entities import pack_entity
from esplanade.protocol.snapshot import RECORD, Records, headings_rad, heights_m, positions_m
from esplanade.protocol.steps import STEP
from esplanade.server.world.compiled._snapshot_kernels import Changes
from esplanade.server.world.frame import Entered, Frame, Reshaped
from esplanade.server.world.routes import Point
from esplanade.server.world.state import ACTOR

STOREY_WEIGHT: Final = 3
"""A metre up or down counts this many metres: avatars on other floors come into view later."""
NOBODY: Final = 0
"""The row that no avatar ever has."""
FIRST_ROWS: Final = 64

Rows = npt.NDArray[np.int64]


class Avatars:
    """A table with a row for each avatar; it grows as they come.

    Arrays are by row: `ids` 0 for a free row; `records` and `steps` bytes as on the wire;
    `changes` the ticks of what is newest of each;
    `places` int64 (R, 3), cm, x and y and the weighted height.
    """

    def __init__(self, origin_m: tuple[float, float]) -> None:
        self._origin_m = origin_m
        self._rows: dict[int, int] = {}
        self._known: dict[int, Entered] = {}
        self._points_at: dict[int, Point] = {}
        self._away: set[int] = set()
        self.ids = np.zeros(FIRST_ROWS, dtype=np.int64)
        self.changes = Changes(*(np.zeros(FIRST_ROWS, dtype=np.int32) for _ in Changes._fields))
        self.places = np.zeros((FIRST_ROWS, 3), dtype=np.int64)
        self.records = np.zeros((FIRST_ROWS, RECORD.itemsize), dtype=np.uint8)
        self.steps = np.zeros((FIRST_ROWS, STEP.itemsize), dtype=np.uint8)
        self._free = list(range(FIRST_ROWS - 1, NOBODY, -1))
        self._list()

    def __contains__(self, avatar_id: int) -> bool:
        return avatar_id in self._rows

    def row(self, avatar_id: int) -> int:
        """The row of an avatar, `NOBODY` if it is not there."""
        return self._rows.get(avatar_id, NOBODY)

    def is_actor(self, avatar_id: int) -> bool:
        known = self._known.get(avatar_id)
        return known is not None and known.kind == ACTOR

    def name(self, avatar_id: int) -> str:
        """The name of an avatar that is there."""
        return self._known[avatar_id].name

    def away(self, rows: Sequence[int]) -> list[int]:
        """Ids of those in these rows whose people are away."""
        if not self._away:
            return []
        return [one for one in self.ids[list(rows)].tolist() if one in self._away]

    def remove(self, ids: list[int]) -> None:
        """Take avatars out; their rows are used again."""
        for avatar_id in ids:
            row = self._rows.pop(avatar_id, NOBODY)
            if row == NOBODY:
                continue
            del self._known[avatar_id]
            self._points_at.pop(avatar_id, None)
            self._away.discard(avatar_id)
            self.ids[row] = 0
            for ticks in self.changes:
                ticks[row] = 0
            self._free.append(row)
        if ids:
            self._list()

    def add(self, entered: list[Entered]) -> None:
        """Take avatars in; their records come next."""
        for each in entered:
            if not self._free:
                self._grow()
            row = self._free.pop()
            self.ids[row] = each.id
            self._rows[each.id] = row
            self._known[each.id] = each
        if entered:
            self._list()

    def reshape(self, reshaped: list[Reshaped]) -> None:
        """Let avatars have other bodies."""
        for each in reshaped:
            known = self._known[each.id]
            self._known[each.id] = replace(known, constants=each.constants)

    def update(self, frame: Frame) -> None:
        """Take in the records, the steps, the pointing of a frame, and who is away."""
        rows = self._rows_of(frame.records["id"])
        changes = self.changes
        urgent = _urgent(self.records[rows].view(RECORD)[:, 0], frame.records)
        changes.urgent[rows[urgent]] = frame.tick
        changes.changed[rows] = frame.tick
        self.records[rows] = frame.records.view(np.uint8).reshape(-1, RECORD.itemsize)
        self.places[rows, 0] = frame.records["x"]
        self.places[rows, 1] = frame.records["y"]
        self.places[rows, 2] = STOREY_WEIGHT * frame.records["z"].astype(np.int64)
        rows = self._rows_of(frame.steps["id"])
        self.steps[rows] = frame.steps.view(np.uint8).reshape(-1, STEP.itemsize)
        changes.begun[rows] = frame.tick
        changes.over[rows] = frame.steps["tick"] + frame.steps["ticks"]
        for avatar_id, target in frame.events.pointing.items():
            if target is None:
                self._points_at.pop(avatar_id, None)
            else:
                self._points_at[avatar_id] = target
        for avatar_id, is_away in frame.events.away.items():
            (self._away.add if is_away else self._away.discard)(avatar_id)

    def pack(self, rows: Rows) -> list[bytes]:
        """Avatars, int64 (N,), as they stand in enter messages."""
        records = self.records[rows].view(RECORD)[:, 0]
        places = np.column_stack([positions_m(records, self._origin_m), heights_m(records)])
        fields = zip(
            self.ids[rows].tolist(),
            records["layer"].tolist(),
            places.tolist(),
            headings_rad(records).tolist(),
            strict=True,
        )
        known, points_at = self._known, self._points_at
        return [
            pack_entity(known[one].constants, layer, place, heading, points_at.get(one))
            for one, layer, place, heading in fields
        ]

    def _grow(self) -> None:
        """Make room for twice as many."""
        before = len(self.ids)
        for name in ("ids", "places", "records", "steps"):
            setattr(self, name, _doubled(getattr(self, name)))
        self.changes = Changes(*map(_doubled, self.changes))
        self._free.extend(range(2 * before - 1, before - 1, -1))

    def _list(self) -> None:
        """List everyone anew, the oldest first."""
        ids = np.fromiter(self._rows, dtype=np.int64, count=len(self._rows))
        rows = np.fromiter(self._rows.values(), dtype=np.int64, count=len(self._rows))
        order = np.argsort(ids)
        self._ids_in_order = ids[order]
        self.in_order: Rows = rows[order]
        """The rows of everyone, the oldest first."""

    def _rows_of(self, ids: npt.NDArray[np.integer]) -> Rows:
        places = np.searchsorted(self._ids_in_order, ids)
        return self.in_order[places]


def _urgent(before: Records, now: Records) -> npt.NDArray[np.bool_]:
    """Mark the records, RECORD (N,), that tell more than the progress of a walk."""
    storey, reason = before["layer"] != now["layer"], before["reason"] != now["reason"]
    starts_or_halts = (before["speed"] == 0) != (now["speed"] == 0)
    urgent: npt.NDArray[np.bool_] = storey | reason | starts_or_halts
    return urgent


def _doubled(table: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """The table with as many rows of zeros more."""
    return np.concatenate([table, np.zeros_like(table)])
