"""The map of all avatars: one table, and blocks of it that subscribers with the same past share."""

import json
import struct
from collections import deque
from collections.abc import Callable, Hashable, Iterable, Mapping
from dataclasses import replace
from typing import Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from esplanade.actors import ActorSpec
from esplanade.protocol.snapshot import POSITION_M, RECORD, Records
from esplanade.server.live.names import stand_in
from esplanade.server.live.tap import Avatar, Tick

MAP_FRAME: Final = 1
"""The first byte of a binary frame of the map."""
_HEAD: Final = struct.Struct("<BBHII")
REMEMBERED: Final = 4096
"""Comings, goings and other changes of avatars that are kept; whoever needs more begins anew."""
KEY_S: Final = 5.0
"""Everybody is told of after this time, so that a fault of a page does not last."""


class _Columns(NamedTuple):
    """Rows of all actors and of all people, ascending, and the radius of everybody by row."""

    actors: npt.NDArray[np.int64]
    people: npt.NDArray[np.int64]
    radii_m: npt.NDArray[np.float64]


class MapFeed:
    """Where everybody is, with the tick in which each was last another."""

    def __init__(
        self,
        origin_m: tuple[float, float],
        tick_s: float,
        groups: Callable[[ActorSpec], Iterable[str]] = lambda spec: spec.tags,
    ) -> None:
        """`groups` tells the groups of an actor, in any thread."""
        self._groups = groups
        self.tick = 0
        self.avatars: dict[int, Avatar] = {}
        """Everybody in the world, by id."""
        self._avatar_of: dict[str, int] = {}
        self.specs: Mapping[Hashable, ActorSpec] = {}
        self.records: Records = np.zeros(0, dtype=RECORD)
        """RECORD (N,), in ascending order of ids; another array after somebody came or went."""
        self.turned: list[tuple[int, int]] = []
        """(id, reason) of everybody whose reason is another since the tick before."""
        self._made: _Columns | None = None
        self._changed: npt.NDArray[np.int64] = np.zeros(0, dtype=np.int64)
        self._origin_m = origin_m
        self._key_ticks = max(1, round(KEY_S / tick_s))
        self._news: deque[tuple[int, int, bool]] = deque()
        """(tick, id, whether it is there): who came, went or is another."""
        self._known_since = 0
        """The news since this tick are complete."""
        self._cache: dict[tuple[Any, ...], Any] = {}

    @property
    def ids(self) -> npt.NDArray[np.uint32]:
        """Ids of everybody, ascending, uint32 (N,)."""
        ids: npt.NDArray[np.uint32] = self.records["id"]
        return ids

    def take(self, tick: Tick) -> None:
        """Take in the next tick."""
        frame, self._cache = tick.frame, {}
        if frame.left or frame.reshaped or tick.entered or tick.everyone is not None:
            self._made = None
        self.tick = frame.tick
        if tick.specs is not None:
            self._take_specs(tick.specs)
        if tick.everyone is not None:
            self.avatars = {each.id: each for each in tick.everyone.avatars}
            self._avatar_of = {
                each.actor: each.id for each in tick.everyone.avatars if each.actor is not None
            }
            self.records = tick.everyone.records.copy()
            self._changed = np.full(len(self.records), self.tick)
            self._news.clear()
            self._known_since = self.tick
            self.turned = list(zip(self.ids.tolist(), self.records["reason"].tolist(), strict=True))
            return
        if frame.left or tick.entered:
            self._come_and_go(frame.left, tick.entered)
        for shape in frame.reshaped:
            known = self.avatars.get(shape.id)
            if known is not None:
                self.avatars[shape.id] = replace(known, radius_m=round(shape.radius_m, 3))
                self._tell(shape.id, there=True)
        rows = self.rows_of(frame.records["id"])
        turned = frame.records[self.records["reason"][rows] != frame.records["reason"]]
        self.turned = list(zip(turned["id"].tolist(), turned["reason"].tolist(), strict=True))
        self.records[rows] = frame.records
        self._changed[rows] = self.tick

    def rows_of(self, ids: npt.NDArray[Any]) -> npt.NDArray[np.int64]:
        """Rows of avatars that are in the world, int64 (K,)."""
        rows: npt.NDArray[np.int64] = np.searchsorted(self.ids, ids)
        return rows

    def tell_again(self, actors: Iterable[str]) -> None:
        """Tell of some actors again with the next tick: their groups are others now."""
        for actor in actors:
            avatar_id = self._avatar_of.get(actor)
            if avatar_id is not None:
                self._tell(avatar_id, there=True, tick=self.tick + 1)

    def place(self, avatar_id: int) -> tuple[float, float, float] | None:
        """The place of an avatar, metres; None if it is not in the world."""
        row = int(np.searchsorted(self.ids, avatar_id))
        if row == len(self.records) or self.ids[row] != avatar_id:
            return None
        x, y, z = (int(self.records[row][name]) * POSITION_M for name in "xyz")
        return round(self._origin_m[0] + x, 2), round(self._origin_m[1] + y, 2), round(z, 2)

    def rows_by_kind(self) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
        """Rows of all actors, and of all people, ascending, int64."""
        made = self._columns()
        return made.actors, made.people

    @property
    def radii_m(self) -> npt.NDArray[np.float64]:
        """Radii of everybody by row, float64 (N,), metres."""
        return self._columns().radii_m

    def _columns(self) -> _Columns:
        """The facts that hardly ever change, by row; made anew after somebody came or went."""
        if self._made is None:
            everybody = [self.avatars[who] for who in self.ids.tolist()]
            is_actor = np.array([each.actor is not None for each in everybody], dtype=np.bool_)
            radii_m = np.array([each.radius_m for each in everybody], dtype=np.float64)
            self._made = _Columns(np.flatnonzero(is_actor), np.flatnonzero(~is_actor), radii_m)
        return self._made

    def is_person(self, avatar_id: int) -> bool:
        """Whether that is a person in the world."""
        avatar = self.avatars.get(avatar_id)
        return avatar is not None and avatar.actor is None

    def avatar_of(self, actor: str) -> int | None:
        """The id of an actor's avatar; None if it is not in the world."""
        return self._avatar_of.get(actor)

    def since(self, tick: int, *, names: bool) -> tuple[str | None, bytes | None]:
        """Return the news for somebody who knows the map of a tick: a text, and then a block.

        Whoever knows nothing gives 0. Each is None if it would say nothing.
        """
        if tick == self.tick:
            return None, None
        reset = tick < self._known_since or tick == 0
        key = reset or tick // self._key_ticks != self.tick // self._key_ticks
        found = self._cached(("block", tick, key), lambda: self._block(tick, key))
        text = self._cached(("text", tick, reset, names), lambda: self._text(tick, reset, names))
        return text, found

    def name_of(self, avatar_id: int, *, names: bool) -> str:
        """The name of an avatar as somebody is told it who may see names, or may not."""
        avatar = self.avatars.get(avatar_id)
        if avatar is None or (avatar.actor is None and not names):
            return stand_in(avatar_id)
        return avatar.name

    def told(self, avatar_id: int, *, names: bool) -> dict[str, Any]:
        """An avatar as it is told."""
        avatar = self.avatars[avatar_id]
        found: dict[str, Any] = {
            "id": avatar_id,
            "kind": avatar.kind,
            "name": self.name_of(avatar_id, names=names),
            "radius_m": avatar.radius_m,
        }
        if avatar.actor is not None:
            found["actor"] = avatar.actor
            spec = self.specs.get(avatar.actor)
            if spec is not None:
                found["groups"], found["behaviour"] = list(self._groups(spec)), spec.behaviour.kind
        return found

    def _cached(self, key: tuple[Any, ...], make: Any) -> Any:
        if key not in self._cache:
            self._cache[key] = make()
        return self._cache[key]

    def _block(self, tick: int, key: bool) -> bytes | None:
        records = self.records if key else self.records[self._changed > tick]
        if not key and not len(records):
            return None
        head = _HEAD.pack(MAP_FRAME, key, 0, self.tick, len(records))
        return head + records.tobytes()

    def _text(self, tick: int, reset: bool, names: bool) -> str | None:
        if reset:
            entered, left = list(self.avatars), []
        else:
            news = {who: there for at, who, there in self._news if at > tick}
            if not news:
                return None
            entered = [who for who, there in news.items() if there and who in self.avatars]
            left = [who for who, there in news.items() if not there]
        return json.dumps(
            {
                "channel": "map",
                "reset": reset,
                "tick": self.tick,
                "entered": [self.told(who, names=names) for who in entered],
                "left": left,
                "origin_m": self._origin_m,
            }
        )

    def _come_and_go(self, left: list[int], entered: list[Avatar]) -> None:
        keep = ~np.isin(self.ids, left)
        new = np.zeros(len(entered), dtype=RECORD)
        new["id"] = [each.id for each in entered]
        records = np.concatenate([self.records[keep], new])
        changed = np.concatenate([self._changed[keep], np.full(len(new), self.tick)])
        order = np.argsort(records["id"], kind="stable")
        self.records, self._changed = records[order], changed[order]
        for gone in left:
            avatar = self.avatars.pop(gone, None)
            if avatar is not None and avatar.actor is not None:
                self._avatar_of.pop(avatar.actor, None)
            self._tell(gone, there=False)
        for each in entered:
            self.avatars[each.id] = each
            if each.actor is not None:
                self._avatar_of[each.actor] = each.id
            self._tell(each.id, there=True)

    def _take_specs(self, specs: Mapping[Hashable, ActorSpec]) -> None:
        """Tell of those actors again whose groups or behaviour are others now."""
        before, self.specs = self.specs, specs
        if not before:
            return
        others = {
            actor
            for actor, spec in specs.items()
            if (known := before.get(actor)) is not None
            and known is not spec
            and (known.tags != spec.tags or known.behaviour.kind != spec.behaviour.kind)
        }
        if others:
            for each in self.avatars.values():
                if each.actor in others:
                    self._tell(each.id, there=True)

    def _tell(self, avatar_id: int, *, there: bool, tick: int | None = None) -> None:
        if len(self._news) >= REMEMBERED:
            self._known_since = max(self._known_since, self._news.popleft()[0] + 1)
        self._news.append((self.tick if tick is None else tick, avatar_id, there))
