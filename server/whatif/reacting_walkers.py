"""The people of a fork, who evade actors where these are in the way more than when recorded."""

from collections.abc import Hashable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from esplanade.pedestrians import ReactingCrowd
from esplanade.pedestrians.crowd import PERSON_RADIUS_M
from esplanade.planning.routes.storey_heights import reached_from, storeys_of
from esplanade.server.whatif.stretch import Stretch
from esplanade.server.whatif.walked import Walked
from esplanade.server.world.routes import Point
from esplanade.server.world.state import ACTOR
from esplanade.server.world.zone import Zone

Floats = NDArray[np.float64]

CATCH_UP_MPS: Final = 2.5
"""Nobody whom walls have held up walks faster than this to where the model has them."""
_THERE_M: Final = 1e-6


@dataclass
class _Storey:
    """Parts of recorded ways on one storey, each with whose it is, and from when on."""

    whose: list[Hashable] = field(default_factory=list)
    begins: list[int] = field(default_factory=list)
    places: list[Floats] = field(default_factory=list)

    def add(self, who: Hashable, begin: int, places: Floats) -> None:
        self.whose.append(who)
        self.begins.append(begin)
        self.places.append(places)


class _Crowd:
    """The people of one storey on their ways, and the recorded actors as they were there."""

    def __init__(self, people: _Storey, actors: _Storey, tick_s: float, seed: int) -> None:
        self.whose = people.whose
        self._actors = {who: list[tuple[int, int, int]]() for who in actors.whose}
        """The parts of each recorded actor's way: number, begin and end."""
        for number, (who, begin, places) in enumerate(
            zip(actors.whose, actors.begins, actors.places, strict=True), start=len(people.whose)
        ):
            self._actors[who].append((number, begin, begin + len(places)))
        crowd = ReactingCrowd(
            [*people.places, *actors.places], [*people.begins, *actors.begins], tick_s, seed=seed
        )
        absent = range(len(people.whose), len(people.whose) + len(actors.whose))
        self.walk = crowd.begin(0, absent)

    def stand_in(self, actor: Hashable) -> int:
        """The number of the recorded actor whose place an actor takes now; -1 for none."""
        for number, begin, end in self._actors.get(actor, ()):
            if begin <= self.walk.tick < end:
                return number
        return -1


class ReactingWalkers:
    """People who walk as recorded, but for the social force of actors (`pedestrians/`).

    Everyone evades an actor as far as it is in the way more than when it was recorded, so that
    nobody evades actors that walk as recorded. The model knows of no walls: those of the zone, and
    its doors, hold people on the way to where the model has them, as they hold all people. Storeys
    are crowds by themselves.
    """

    def __init__(self, stretch: Stretch, zone: Zone, seed: int | None) -> None:
        moving = [tick.tick for tick in stretch.ticks if not _is_still(tick.inputs)]
        self._clock = {tick: k for k, tick in enumerate([stretch.first_tick, *moving])}
        """The ticks in which something moves, numbered: the crowds' own time."""
        self._walked = stretch.walked
        self._radii = stretch.actors_radii_m
        self._tick_s = zone.tick_s
        starts = [(*spawn.position, spawn.z_m) for spawn in zone.scene.spawns]
        self._storeys = np.array(storeys_of(zone.grid, reached_from(zone.grid, starts)))
        people, actors = self._parts(stretch.walked), self._parts(stretch.actors_walked)
        mixed = stretch.head.built.seed if seed is None else seed
        self._crowds = [
            _Crowd(ours, theirs, zone.tick_s, mixed)
            for ours, theirs in zip(people, actors, strict=True)
        ]
        self._off: set[int] = set()
        """Those who are elsewhere than recorded."""
        self._furthest_m: dict[int, float] = {}
        self._latest_s: dict[int, float] = {}

    @property
    def displacements_m(self) -> list[float]:
        """The greatest distance of each person from the recorded place so far, metres."""
        return list(self._furthest_m.values())

    @property
    def delays_s(self) -> list[float]:
        """The longest delay of each person behind the recording so far, seconds."""
        return list(self._latest_s.values())

    def at(self, tick: int, zone: Zone) -> tuple[tuple[int, ...], tuple[Point, ...]]:
        """The ids of people and their places at the end of a tick that the zone begins next."""
        found: dict[int, Point] = {}
        targets: dict[int, Floats] = {}
        self._step(zone, targets)
        for who, walked in self._walked.items():
            recorded = walked.at(tick)
            if recorded is None:
                continue
            target = targets.get(who)
            if who in zone.state and (target is not None or who in self._off):
                self._off.add(who)
                targets[who] = np.array(recorded[:2]) if target is None else target
            else:
                targets.pop(who, None)
            found[who] = recorded
        self._approach(zone, targets, found)
        return tuple(found), tuple(found.values())

    def _step(self, zone: Zone, targets: dict[int, Floats]) -> None:
        """Let all crowds walk on; writes where those want to be who are not where recorded."""
        state = zone.state
        slots = state.of_kind(ACTOR)
        # The newest that is known of actors is their places a tick ago, and how they went on.
        velocities = (state.positions[slots] - state.before[slots]) / self._tick_s
        levels = self._storey_of(state.heights[slots])
        ids = [str(zone.actor_of(avatar)) for avatar in state.ids[slots].tolist()]
        radii = [
            PERSON_RADIUS_M + radius - self._radii.get(actor, PERSON_RADIUS_M)
            for actor, radius in zip(ids, state.radii[slots].tolist(), strict=True)
        ]
        bodies = np.column_stack([state.before[slots], velocities, np.maximum(radii, 0.0)])
        for level, crowd in enumerate(self._crowds):
            here = np.flatnonzero(levels == level)
            stand_ins = [crowd.stand_in(ids[row]) for row in here.tolist()]
            walk = crowd.walk
            walk.step(bodies[here], np.array(stand_ins, dtype=np.int64))
            for number, place, recorded, late_s in zip(
                walk.present.tolist(), walk.positions, walk.recorded, walk.late_s, strict=True
            ):
                who = int(str(crowd.whose[number]))
                self._latest_s[who] = max(self._latest_s.get(who, 0.0), float(late_s))
                self._furthest_m.setdefault(who, 0.0)
                if (place != recorded).any():
                    targets[who] = place

    def _approach(self, zone: Zone, targets: dict[int, Floats], found: dict[int, Point]) -> None:
        """Move those who are elsewhere than recorded toward their targets, as far as walls let."""
        if not targets:
            return
        state = zone.state
        slots = state.slots_of(targets)
        wanted = np.array(list(targets.values()))
        step = wanted - state.positions[slots]
        length = np.hypot(step[:, 0], step[:, 1])
        step *= np.minimum(1.0, CATCH_UP_MPS * self._tick_s / np.maximum(length, 1e-12))[:, None]
        places, heights = zone.grid.walk(
            state.positions[slots], state.heights[slots], step, zone.rules.person_clearance_m
        )
        for who, (x, y), z in zip(targets, places.tolist(), heights.tolist(), strict=True):
            recorded = found[who]
            away_m = float(np.hypot(x - recorded[0], y - recorded[1]))
            self._furthest_m[who] = max(self._furthest_m.get(who, 0.0), away_m)
            if away_m < _THERE_M:
                self._off.discard(who)
            else:
                found[who] = x, y, z

    def _parts(self, ways: Mapping[Any, Walked]) -> list[_Storey]:
        storeys = [_Storey() for _ in self._storeys]
        for who, walked in ways.items():
            for level, begin, places in self._split(walked):
                storeys[level].add(who, begin, places)
        return storeys

    def _split(self, walked: Walked) -> Iterator[tuple[int, int, Floats]]:
        """The storey, the begin on the crowds' clock, and places (n, 2) of each part of a way."""
        clock = [
            (self._clock[tick], row)
            for row, tick in enumerate(range(walked.first_tick, walked.last_tick + 1))
            if tick in self._clock and not np.isnan(walked.places[row, 0])
        ]
        if not clock:
            return
        times, rows = np.array(clock, dtype=np.int64).T
        places = walked.places[rows]
        levels = self._storey_of(places[:, 2])
        parted = (np.diff(levels) != 0) | (np.diff(times) > 1)
        cuts = [0, *(np.flatnonzero(parted) + 1).tolist(), len(rows)]
        for first, end in pairwise(cuts):
            yield int(levels[first]), int(times[first]), places[first:end, :2]

    def _storey_of(self, heights: Floats) -> NDArray[np.int64]:
        """The numbers of the storeys that are nearest to heights (N,)."""
        return np.asarray(np.abs(heights[:, None] - self._storeys).argmin(axis=1), dtype=np.int64)


def _is_still(inputs: Iterable[dict[str, object]]) -> bool:
    return any(plain["kind"] == "still" for plain in inputs)
