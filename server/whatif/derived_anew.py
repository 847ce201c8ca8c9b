"""The results that a fork derives from its own ground, where the recording's are others.

In a server that comes from a thread, whenever it is ready. In a fork the tick is fixed by rule:

- What the recording derived takes effect in the tick in which it did there, if the fork wants it,
  and has wanted it for two seconds at most. So a fork without changes is the recorded world.
- All else takes effect a quarter of a second after it is wanted: a door that moves, what a command
  on actors waits for, the potential of a goal; in this order, and one of them a tick.
"""

from bisect import bisect_left
from collections.abc import Collection, Hashable, Iterable, Mapping
from typing import Any, Final

from esplanade.actors.potential_pool import plain_key
from esplanade.server.recording.reader import RecordedTick
from esplanade.server.world.inputs import DoorDerived, Input, PotentialDerived
from esplanade.server.world.zone import Zone

AFTER_S: Final = 0.25
"""Time from when something is wanted, that the recording has not, until it takes effect."""
WAITS_S: Final = 2.0
"""A fork waits so long for what the recording has; servers without much to do are quicker."""
KINDS: Final = frozenset({"door_derived", "potential_derived", "actors_derived"})
"""Inputs of recordings that were derived beside the ticks."""


class DerivedAnew:
    """Decides in each tick what a fork derives, and derives it."""

    def __init__(
        self, zone: Zone, ticks: Iterable[RecordedTick], own_doors: Collection[str] = ()
    ) -> None:
        """`ticks` are all those that the fork runs; its own doors do not move as recorded."""
        self._zone = zone
        self._after = max(1, round(AFTER_S / zone.tick_s))
        self._waits = max(1, round(WAITS_S / zone.tick_s))
        self._own_doors = own_doors
        self._supply: dict[Hashable, list[int]] = {}
        """The ticks in which the recording has something derived."""
        for tick in ticks:
            for plain in tick.inputs:
                if plain["kind"] in KINDS and plain.get("name") not in own_doors:
                    self._supply.setdefault(_what(plain), []).append(tick.tick)
        self._since: dict[Hashable, int] = {}
        """The tick before which each thing was found to be wanted."""

    def takes(self, plain: Mapping[str, Any]) -> bool:
        """Whether something that the recording has derived is wanted in the next tick."""
        return plain.get("name") not in self._own_doors and _what(plain) in self._wanted()

    def inputs(self, tick: int, *, is_free: bool) -> list[Input]:
        """The result derived for a tick, at most one, and none if the tick is not free."""
        wanted = self._wanted()
        self._since = {each: self._since.get(each, tick) for each in wanted}
        if not is_free:
            return []
        for each, goal in wanted.items():
            if tick - self._since[each] >= self._after and not self._comes(each, tick):
                return self._derived(each, goal)
        return []

    def _wanted(self) -> dict[Hashable, Any]:
        """All that waits to be derived, in the order of the rule; goals by what stands for them."""
        zone = self._zone
        found: dict[Hashable, Any] = {}
        if zone.doors.derived_outside:
            found |= {("door", *door): None for door in zone.doors.due()}
        if (number := zone.longest_waiting) is not None:
            found["command", number] = None
        return found | {_potential(plain_key(goal)): goal for goal in zone.outdated_goals()}

    def _comes(self, what: Hashable, tick: int) -> bool:
        """Whether the recording has it in this tick or later, and soon enough."""
        ticks = self._supply.get(what, [])
        next_one = bisect_left(ticks, tick)
        return next_one < len(ticks) and ticks[next_one] <= self._since[what] + self._waits

    def _derived(self, what: Any, goal: Any) -> list[Input]:
        match what:
            case ("door", name, is_open):
                return [DoorDerived(self._zone.doors.prepare(name, is_open))]
            case ("potential", _):
                return [PotentialDerived(self._zone.derived_now(goal))]
        work = self._zone.actor_work()
        return [] if work is None else [work()]


def _what(plain: Mapping[str, Any]) -> Hashable:
    """The thing that an input of a recording has derived."""
    match plain["kind"]:
        case "door_derived":
            return "door", plain["name"], plain["is_open"]
        case "potential_derived":
            return _potential(plain["goal"])
    return "command", plain["command"]


def _potential(goal: Any) -> Hashable:
    return "potential", _as_tuples(goal)


def _as_tuples(value: Any) -> Any:
    return tuple(map(_as_tuples, value)) if isinstance(value, list | tuple) else value
