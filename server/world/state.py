"""The avatars of a zone: one dense table, a slot each."""

from collections.abc import Iterable, Mapping
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from esplanade.actors.locomotion.footsteps.course import AHEAD
from esplanade.protocol import Kind
from esplanade.protocol.looks import NO_LOOK, Look

Floats = npt.NDArray[np.float64]
Slots = npt.NDArray[np.int64]

PERSON: Final = 0
ACTOR: Final = 1
KINDS: Final = (Kind.PERSON, Kind.ACTOR)
ANY_ID: Final = (1, 2**32)
"""Ids have 32 bits on the wire."""


_COLUMNS: Final = (
    "ids",
    "arrivals",
    "kinds",
    "layers",
    "positions",
    "heights",
    "before",
    "ahead",
    "headings",
    "speeds",
    "reasons",
    "radii",
    "away",
    "looks",
    "scales",
    "strides",
    "legs_m",
    "statures_m",
)
"""The columns of which an avatar has a row each, but for its name."""


class WorldFullError(RuntimeError):
    """Every slot is taken."""


class NoIdError(RuntimeError):
    """Every id that was reserved is given away; more are on their way."""


class State:
    """Every avatar of the zone.

    Arrays are indexed by slot and have a fixed capacity. A slot is used again once its avatar
    is gone; an id never is, except by an avatar that went to another zone and comes back. So
    `arrivals` tells the avatars of a slot apart: they are numbered as they come, from 1 on.
    `before` holds the positions of the tick before; `heights` are those of the feet above the
    scene's ground, metres; `ahead` is where each is going, as in
    `esplanade.actors.locomotion.Course`; legs and statures are those drawn for an avatar, `scales`
    times as long, and `strides` the lengths of its steps against those of a free walk. `away` marks
    those who wait for their people; `looks` holds the numbers of `esplanade.protocol.looks.Look`.
    """

    def __init__(self, capacity: int) -> None:
        self.capacity = capacity
        self.alive = np.zeros(capacity, dtype=np.bool_)
        self._found: dict[int | None, Slots] = {}
        """All that `live` (None) and `of_kind` found since somebody came or left last."""
        self.ids = np.zeros(capacity, dtype=np.int64)
        self.arrivals = np.zeros(capacity, dtype=np.int64)
        self.kinds = np.zeros(capacity, dtype=np.uint8)
        self.layers = np.zeros(capacity, dtype=np.int64)
        self.positions = np.zeros((capacity, 2))
        self.heights = np.zeros(capacity)
        self.before = np.zeros((capacity, 2))
        self.ahead = np.zeros((capacity, AHEAD, 3))
        self.headings = np.zeros(capacity)
        self.speeds = np.zeros(capacity)
        self.reasons = np.zeros(capacity, dtype=np.uint8)
        self.radii = np.zeros(capacity)
        self.scales = np.ones(capacity)
        self.strides = np.ones(capacity)
        self.legs_m = np.zeros(capacity)
        self.statures_m = np.zeros(capacity)
        self.away = np.zeros(capacity, dtype=np.bool_)
        self.looks = np.zeros((capacity, len(NO_LOOK)), dtype=np.uint8)
        self.names = [""] * capacity
        self._slots: dict[int, int] = {}
        self._arrived = 0
        self._free = list(range(capacity - 1, -1, -1))
        self._next_id, self._ids_end = ANY_ID
        self._more_ids: list[tuple[int, int]] = []

    @property
    def next_id(self) -> int:
        """The id that the next avatar gets, unless none is left."""
        return self._next_id

    @property
    def ids_left(self) -> int:
        """Number of ids that new avatars can get."""
        return self._ids_end - self._next_id + sum(end - first for first, end in self._more_ids)

    def begin_ids(self, first: int, end: int) -> None:
        """Let new avatars get these ids and no others, from `first` up to and without `end`."""
        self._next_id, self._ids_end, self._more_ids = first, end, []

    def add_ids(self, first: int, end: int) -> None:
        """Let new avatars get further ids, from `first` up to and without `end`."""
        self._more_ids.append((first, end))

    def __contains__(self, avatar_id: int) -> bool:
        return avatar_id in self._slots

    def slot(self, avatar_id: int) -> int:
        return self._slots[avatar_id]

    def slots_of(self, avatar_ids: Iterable[int]) -> Slots:
        """The slots of avatars, int (N,); -1 of those who are not here."""
        slots = self._slots
        return np.array([slots.get(avatar_id, -1) for avatar_id in avatar_ids], dtype=np.int64)

    def look(self, avatar_id: int) -> Look:
        """The look of an avatar that is here."""
        return Look(*self.looks[self._slots[avatar_id]].tolist())

    def live(self) -> Slots:
        """Slots of everyone, ascending, int (N,); they are to be read only, as those of a kind."""
        if None not in self._found:
            self._found[None] = np.flatnonzero(self.alive)
        return self._found[None]

    def of_kind(self, kind: int) -> Slots:
        """Slots of all people or of all actors, ascending, int (N,)."""
        if kind not in self._found:
            self._found[kind] = np.flatnonzero(self.alive & (self.kinds == kind))
        return self._found[kind]

    def add(
        self,
        kind: int,
        name: str,
        place: tuple[float, float, float],
        layer: int,
        radius_m: float,
        avatar_id: int | None = None,
    ) -> int:
        """The slot of a new avatar, or of one that was here before and keeps its id.

        Raises
        ------
        ValueError
            There is an avatar with that id.
        WorldFullError
            Every slot is taken.
        NoIdError
            No id is left.
        """
        if avatar_id in self._slots:
            raise ValueError(f"the avatar {avatar_id} is here already")
        if not self._free:
            raise WorldFullError(f"the world holds {self.capacity} avatars, all slots are taken")
        if avatar_id is None:
            avatar_id = self._take_id()
        slot = self._free.pop()
        self._found.clear()
        self.alive[slot] = True
        self.ids[slot] = avatar_id
        self._arrived += 1
        self.arrivals[slot] = self._arrived
        self.kinds[slot] = kind
        self.layers[slot] = layer
        self.positions[slot] = self.before[slot] = place[:2]
        self.heights[slot] = place[2]
        self.ahead[slot] = place
        self.headings[slot] = self.speeds[slot] = 0.0
        self.reasons[slot] = 0
        self.radii[slot] = radius_m
        self.scales[slot] = self.strides[slot] = 1.0
        self.away[slot] = False
        self.looks[slot] = NO_LOOK
        self.names[slot] = name
        self._slots[avatar_id] = slot
        return slot

    def _take_id(self) -> int:
        if self._next_id >= self._ids_end:
            if not self._more_ids:
                raise NoIdError("every id that was reserved is given away")
            self._next_id, self._ids_end = self._more_ids.pop(0)
        self._next_id += 1
        return self._next_id - 1

    def save(self) -> dict[str, Any]:
        """Every avatar but its name, and the slots and ids that are left: plain data, and copies.

        Rows of the arrays are in the order of `live`.
        """
        live = self.live()
        return {
            "slots": live,
            **{name: getattr(self, name).take(live, axis=0) for name in _COLUMNS},
            "free": list(self._free),
            "arrived": self._arrived,
            "id_blocks": [[self._next_id, self._ids_end], *map(list, self._more_ids)],
        }

    def load(self, saved: Mapping[str, Any], names: Mapping[int, str]) -> None:
        """Hold the avatars that were saved, and no others, with names by their ids.

        Raises
        ------
        ValueError, KeyError, TypeError
            It is not what `save` of a state of this capacity gives.
        """
        slots = np.asarray(saved["slots"], dtype=np.int64)
        free = np.asarray(saved["free"], dtype=np.int64).tolist()
        if sorted([*slots.tolist(), *free]) != list(range(self.capacity)):
            raise ValueError(f"these are not the {self.capacity} slots of a state")
        self._found.clear()
        self.alive[:] = False
        self.alive[slots] = True
        for name in _COLUMNS:
            column, rows = getattr(self, name), np.asarray(saved[name])
            if rows.shape != (len(slots), *column.shape[1:]) or rows.dtype != column.dtype:
                raise ValueError(f"{name} of {len(slots)} avatars cannot be of that shape and type")
            if not np.isfinite(rows).all():
                raise ValueError(f"{name} of an avatar is not finite")
            column[slots] = rows
        ids = self.ids[slots].tolist()
        if len(set(ids)) < len(ids):
            raise ValueError("two avatars have one id")
        self.names = [""] * self.capacity
        for slot, avatar in zip(slots.tolist(), ids, strict=True):
            self.names[slot] = names.get(avatar, "")
        self._slots = dict(zip(ids, slots.tolist(), strict=True))
        self._free, self._arrived = free, int(saved["arrived"])
        blocks = [(int(first), int(end)) for first, end in saved["id_blocks"]]
        (self._next_id, self._ids_end), *self._more_ids = blocks

    def remove(self, avatar_id: int) -> int:
        """Take an avatar out; returns the slot that is free now."""
        slot = self._slots.pop(avatar_id)
        self._found.clear()
        self.alive[slot] = False
        self.names[slot] = ""
        self._free.append(slot)
        return slot
