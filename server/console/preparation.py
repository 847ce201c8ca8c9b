"""Estimates how long the preparation of commands takes, from how long it has taken before."""

from collections.abc import Sequence
from typing import Final

from esplanade.actors.parameter_records import MEASURES
from esplanade.protocol.commands import Price
from esplanade.server.world.inputs import ActorCommand, AddActors, SetParameters, parts_of
from esplanade.server.world.zone import Zone

_FIRST_S: Final = 0.15
"""Seconds for one body with its goal, before any was measured."""
_WEIGHT: Final = 0.3
"""Weight of the latest measurement."""


class Preparation:
    """Prices of inputs, and the seconds that what they need takes."""

    def __init__(self, zone: Zone) -> None:
        self._zone = zone
        self._each_s = _FIRST_S

    def price(self, inputs: Sequence[ActorCommand]) -> Price:
        """Whether inputs are done in a tick, or something is prepared before."""
        return "prepared" if any(map(_is_prepared, inputs)) else "tick"

    def bodies(self, inputs: Sequence[ActorCommand]) -> int:
        """Number of bodies with their goals that inputs need; call it between two ticks."""
        count = 0
        for one in (part for command in inputs for part in parts_of(command)):
            if isinstance(one, AddActors):
                count += len(one.specs)
            elif isinstance(one, SetParameters) and _is_prepared(one):
                count += self._zone.new_bodies(one)
        return count

    def seconds(self, bodies: int) -> float:
        """About how long it takes to prepare so many, after what waits already."""
        return round((bodies + self._zone.commands_waiting) * self._each_s, 3)

    def took(self, bodies: int, seconds: float) -> None:
        """Learn from a preparation that has ended."""
        if bodies > 0:
            self._each_s += _WEIGHT * (seconds / bodies - self._each_s)


def _is_prepared(command: ActorCommand) -> bool:
    return any(
        isinstance(one, AddActors)
        or (isinstance(one, SetParameters) and not one.values.keys().isdisjoint(MEASURES))
        for one in parts_of(command)
    )
