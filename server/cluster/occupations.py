"""A host's knowledge of whose client may steer each person: the newest occupation of the seat."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final

SILENCE_S: Final = 2.0
"""A gateway that has not said for so long whom it serves has lost them."""


@dataclass
class Occupation:
    """One client's hold of a seat: each time somebody takes the seat it gets the next number."""

    generation: int
    gateway: str | None
    """The gateway of the client; None while nobody steers."""
    heard_s: float


class Occupations:
    """The newest occupation of each person in one zone.

    Generations never fall, so that of two clients with one token only the later one steers, at
    whichever gateways they are and in whatever order their messages come.
    """

    def __init__(self) -> None:
        self._by_person: dict[int, Occupation] = {}

    def __contains__(self, person: int) -> bool:
        return person in self._by_person

    def __iter__(self) -> Iterator[int]:
        return iter(self._by_person)

    def of(self, person: int) -> Occupation | None:
        """The newest occupation of a person's seat that is known."""
        return self._by_person.get(person)

    def attach(self, person: int, generation: int, gateway: str, now_s: float) -> bool:
        """Let a gateway's client steer; returns False if a newer one does, or this one has left.

        The same message may come again: it changes nothing then.
        """
        known = self._by_person.get(person)
        if known is not None and generation <= known.generation:
            return generation == known.generation and known.gateway == gateway
        self._by_person[person] = Occupation(generation, gateway, now_s)
        return True

    def restore(self, person: int, generation: int, gateway: str | None, now_s: float) -> None:
        """Take in what the seat of a person says: its generation, and the gateway of its client.

        A host reads the seats when it claims a zone, since a late message of an older client would
        be the first there and so the newest, and once in a while: a gateway may die after it has
        written a seat and before it has told of it. It is silent then, and loses the person.
        """
        known = self._by_person.get(person)
        if known is None or known.generation < generation:
            self._by_person[person] = Occupation(generation, gateway, now_s)

    def may_steer(self, person: int, generation: int) -> bool:
        """Whether an input that names this occupation has an effect."""
        known = self._by_person.get(person)
        return known is not None and known.generation == generation and known.gateway is not None

    def detach(self, person: int, generation: int) -> bool:
        """Note that a client has gone; returns whether it was the newest one."""
        known = self._by_person.get(person)
        if known is None or known.generation != generation or known.gateway is None:
            return False
        known.gateway = None
        return True

    def present(self, gateway: str, held: Mapping[int, int], now_s: float) -> list[int]:
        """Take in whom a gateway says that it serves: persons, and the generation of each.

        Returns those who were thought lost and are there after all, since either side was silent
        for a while: their seats are to be occupied again.
        """
        found = []
        for person, generation in held.items():
            known = self._by_person.get(person)
            if known is None or known.generation != generation:
                continue
            if known.gateway is None:
                known.gateway = gateway
                found.append(person)
            if known.gateway == gateway:
                known.heard_s = now_s
        return found

    def silent(self, now_s: float) -> dict[int, int]:
        """Detach the persons of whom no gateway has said anything for too long.

        Returns them with their generations: their seats are vacant unless somebody newer has them.
        """
        lost = {}
        for person, known in self._by_person.items():
            if known.gateway is not None and now_s - known.heard_s > SILENCE_S:
                known.gateway = None
                lost[person] = known.generation
        return lost

    def forget(self, person: int) -> None:
        """Take out a person who is gone from the zone."""
        self._by_person.pop(person, None)
