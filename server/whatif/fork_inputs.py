"""The inputs of a fork: those of the recording, but for what is changed, derived or walked anew."""

from collections.abc import Iterable, Mapping
from typing import Any, Final

import numpy as np

from esplanade.server.recording.reader import RecordedTick
from esplanade.server.whatif.changes import Changes
from esplanade.server.whatif.derived_anew import KINDS, DerivedAnew
from esplanade.server.whatif.errors import WhatIfError
from esplanade.server.whatif.stretch import Stretch
from esplanade.server.world.inputs import (
    AddActors,
    Batch,
    Input,
    Join,
    MoveDoor,
    RemoveActors,
    SetParameters,
    Still,
)
from esplanade.server.world.recorded_inputs import input_of
from esplanade.server.world.zone import Zone

FIRST_COMMAND: Final = 2**48
"""Commands of a fork have numbers from here on; no server gets so far."""
_MOVEMENTS: Final = frozenset({"steer", "steer_many", "follow", "stand"})
"""People are put where they are in each tick."""
_SERVERS: Final = frozenset({"ids_reserved"})
"""People keep the ids that they had."""
_COMMANDS: Final = frozenset(
    {
        "set_parameters",
        "add_actors",
        "remove_actors",
        "change_behaviour",
        "send_actors",
        "place_actor",
        "hold_actors",
        "batch",
    }
)


class ForkInputs:
    """Makes the inputs of each tick of a fork but for where people are."""

    def __init__(
        self, zone: Zone, stretch: Stretch, changes: Changes, ticks: Iterable[RecordedTick]
    ) -> None:
        self._zone = zone
        self._stretch = stretch
        self._changes = changes
        self._derived = DerivedAnew(zone, ticks, changes.doors)

    def of(self, recorded: RecordedTick) -> list[Input]:
        """The inputs of the next tick."""
        found: list[Input] = []
        derived = False
        for plain in recorded.inputs:
            if plain["kind"] in KINDS:
                if self._derived.takes(plain):
                    derived = True
                    found.append(input_of(plain, self._zone))
            else:
                found += self._as_changed(plain, recorded.tick)
        return found + self._derived.inputs(recorded.tick, is_free=not derived)

    def _as_changed(self, plain: Mapping[str, Any], tick: int) -> list[Input]:
        kind = plain["kind"]
        found: list[Input] = []
        if kind == "join":
            found = self._join(plain, tick)
        elif kind in _COMMANDS:
            found = self._command(plain)
        elif kind == "move_door":
            found = list(self._doors([MoveDoor(plain["name"], plain["is_open"])]))
        elif kind not in _MOVEMENTS and kind not in _SERVERS:
            found = [input_of(plain, self._zone)]
        return found

    def _command(self, plain: Mapping[str, Any]) -> list[Input]:
        """The rest of a command on actors; of recorded actors that are not there, doors."""
        item = input_of(plain, self._zone)
        if self._changes.roster is not None:
            return list(self._doors(item.doors)) if isinstance(item, Batch) else []
        match item:
            case SetParameters():
                return self._parameters(item)
            case AddActors():
                return [self._newcomers(item)]
            case Batch():
                return self._batch(item)
        return [item]

    def _doors(self, doors: Iterable[MoveDoor]) -> tuple[MoveDoor, ...]:
        return tuple(door for door in doors if door.name not in self._changes.doors)

    def _join(self, plain: Mapping[str, Any], tick: int) -> list[Input]:
        """Somebody comes in under the same id, at the recorded place, if that was so."""
        who = self._stretch.joined.get((tick, plain["ticket"]))
        if who is None:
            return []
        at = self._stretch.walked[who].at(tick)
        item = input_of({**plain, "id": who, "at": at, "anywhere": True}, self._zone)
        return [item] if isinstance(item, Join) else []

    def _parameters(self, item: SetParameters) -> list[Input]:
        """Values that the fork sets stay as they are."""
        left = {n: v for n, v in item.values.items() if n not in self._changes.values}
        return [SetParameters(item.command, item.actors, left)] if left else []

    def _newcomers(self, item: AddActors) -> AddActors:
        values = self._changes.values
        parameters = tuple(each.model_copy(update=dict(values)) for each in item.parameters)
        return AddActors(item.command, item.specs, parameters)

    def _batch(self, item: Batch) -> list[Input]:
        commands: list[Any] = []
        for one in item.commands:
            match one:
                case SetParameters():
                    commands += self._parameters(one)
                case AddActors():
                    commands.append(self._newcomers(one))
                case _:
                    commands.append(one)
        doors = self._doors(item.doors)
        return [Batch(item.command, tuple(commands), doors)] if commands or doors else []


def begun_anew(zone: Zone, stretch: Stretch, changes: Changes) -> list[Input]:
    """The inputs by which everybody comes into an empty zone, for its first tick.

    Raises
    ------
    WhatIfError
        Somebody was recorded outside of its scene.
    """
    x0, y0, x1, y1 = zone.scene.bounds
    found: list[Input] = []
    for who, walked in stretch.walked.items():
        places = walked.places[~np.isnan(walked.places[:, 0]), :2]
        (least_x, least_y), (most_x, most_y) = places.min(axis=0), places.max(axis=0)
        if not (x0 <= least_x and most_x <= x1 and y0 <= least_y and most_y <= y1):
            raise WhatIfError(
                f"--scene: people were recorded outside of its bounds, {x0:g}, {y0:g} to {x1:g}, "
                f"{y1:g}"
            )
        at = walked.at(stretch.first_tick)
        if at is not None:
            found.append(Join(who, f"Person {who}", at, id=who))
    if changes.roster is None and stretch.cast:
        specs = tuple(spec for spec, _ in stretch.cast)
        parameters = tuple(each.model_copy(update=dict(changes.values)) for _, each in stretch.cast)
        found.append(AddActors(FIRST_COMMAND, specs, parameters))
    return found


def first_inputs(zone: Zone, changes: Changes) -> list[Input]:
    """The inputs by which a fork becomes another world, for its first tick."""
    found: list[Input] = []
    number = FIRST_COMMAND
    there = tuple(str(actor) for actor in zone.actors)
    if changes.roster is not None and (there or changes.roster.actors):
        parameters = tuple(
            each.model_copy(update=dict(changes.values)) for each in changes.roster.parameters()
        )
        commands: list[Any] = [RemoveActors(number, there)] if there else []
        if changes.roster.actors:
            commands.append(AddActors(number, changes.roster.actors, parameters))
        found.append(Batch(number, tuple(commands)))
    elif changes.values and there:
        found.append(SetParameters(number, there, dict(changes.values)))
    return found + [MoveDoor(name, is_open) for name, is_open in changes.doors.items()]


def is_still(inputs: Iterable[Input]) -> bool:
    """Whether nobody moves in the tick with these inputs."""
    return any(isinstance(item, Still) for item in inputs)
