"""People who are on their way into a zone from another one."""

from collections.abc import Callable
from dataclasses import dataclass

from esplanade.protocol.looks import Look
from esplanade.server.net.newcomers import MAX_JOINS_PER_TICK
from esplanade.server.net.person import Person
from esplanade.server.net.session import Session
from esplanade.server.world.inputs import Join
from esplanade.server.world.routes import Point


@dataclass(frozen=True)
class Arrival:
    """Somebody for whom a place is kept until a moment, seconds of the event loop."""

    session: Session | None
    """None for somebody whose connection is lost, and whose avatar waits."""
    id: int
    name: str
    at: Point
    """The place nearest to which they stand, x, y, z, metres."""
    look: Look
    zone: str
    """The name of the zone that they come into."""
    portal: str
    """The name of the portal there that they come out of."""
    until_s: float
    release: Callable[[], Person | None]
    """Lets the person out of the zone where they are; None if they do not come any more."""
    fail: Callable[[str], None]
    """Tells them why they are not let in."""


class Arrivals:
    """Those for whom a place is kept, by the tickets of their inputs."""

    def __init__(self) -> None:
        self._expected: dict[int, Arrival] = {}
        self._joins: list[Join] = []

    def __len__(self) -> int:
        return len(self._expected)

    def expect(self, ticket: int, arrival: Arrival) -> None:
        """Keep a place for somebody, and let them in with one of the next ticks."""
        self._expected[ticket] = arrival
        name, at, look = arrival.name, arrival.at, arrival.look
        self._joins.append(Join(ticket, name, at, anywhere=True, id=arrival.id, look=look))

    def joins(self) -> list[Join]:
        """Inputs by which a few of them come in, each once."""
        waiting = [join for join in self._joins if join.ticket in self._expected]
        self._joins = waiting[MAX_JOINS_PER_TICK:]
        return waiting[:MAX_JOINS_PER_TICK]

    def take(self, ticket: int) -> Arrival | None:
        """The one whom the zone has let in; None if the ticket is of nobody who was expected."""
        return self._expected.pop(ticket, None)

    def end_waiting(self, now_s: float) -> list[Arrival]:
        """Those for whom no place is kept any more, since the zone has not let them in."""
        late = [ticket for ticket, one in self._expected.items() if one.until_s <= now_s]
        return [self._expected.pop(ticket) for ticket in late]
