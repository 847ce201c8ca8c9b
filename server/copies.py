"""Copies of a crowded zone: which of them somebody enters, and which of them are to be open."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

FULL: Final = 0.8
"""A copy with this part of the people that may be in it is full enough: newcomers enter another
one, and the rest of its places is for those whom somebody has sent a link to it."""


@dataclass(frozen=True)
class Copies:
    """A zone with its copies, each of which is a zone of its own."""

    names: tuple[str, ...]
    """The names of the copies. The first, the zone itself, is always open."""
    most_people: int
    """The most people in each of them."""

    def entered(self, people: Mapping[str, int], wished: str | None = None) -> str | None:
        """The copy that somebody enters; `people` has the number of people in each open one.

        It is the wished one where that has room, else the fullest of those that are not full
        enough, else the emptiest. None if all are full.
        """
        room = {name: people[name] for name in self.names if name in people}
        room = {name: number for name, number in room.items() if number < self.most_people}
        if wished in room:
            return wished
        below = [name for name, number in room.items() if not self._is_full(number)]
        if below:
            return max(below, key=room.__getitem__)
        return min(room, key=room.__getitem__, default=None)

    def wanted(self, people: Mapping[str, int]) -> frozenset[str]:
        """The copies that are to be open, by the number of people who belong in each.

        They are the first one, those with people, and another one where all these are full enough.
        """
        first, *others = self.names
        wanted = {first, *(name for name in others if people.get(name, 0))}
        if all(self._is_full(people.get(name, 0)) for name in wanted):
            wanted.update([name for name in others if name not in wanted][:1])
        return frozenset(wanted)

    def _is_full(self, number: int) -> bool:
        return number >= FULL * self.most_people
