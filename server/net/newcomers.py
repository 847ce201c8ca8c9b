"""People who wait to join: a few of them come in with each tick."""

from collections.abc import Iterator
from typing import Final

from esplanade.protocol.looks import NO_LOOK
from esplanade.protocol.messages import Hello
from esplanade.server.net.session import Session
from esplanade.server.world.inputs import Join
from esplanade.server.world.zone import Zone

MAX_JOINS_PER_TICK: Final = 16
"""Each join costs every neighbour an enter message, so a crowd comes in over some ticks."""


class Newcomers:
    """Those who wait, by tickets; a ticket is given away once."""

    def __init__(self, world: Zone, *, anywhere: bool) -> None:
        """With `anywhere`, all may come in where they wish, and not operators alone."""
        self._world = world
        self._anywhere = anywhere
        self._last_ticket = 0
        self._waiting: dict[int, tuple[Session, Hello]] = {}
        self._asked: set[int] = set()
        """Tickets of those who have been sent to the zone."""

    def __len__(self) -> int:
        return len(self._waiting)

    def __contains__(self, session: Session) -> bool:
        return session.ticket in self._waiting

    def __iter__(self) -> Iterator[Session]:
        return (session for session, _ in self._waiting.values())

    def new_ticket(self) -> int:
        """The next ticket."""
        self._last_ticket += 1
        return self._last_ticket

    def add(self, session: Session, hello: Hello) -> None:
        """Let somebody wait."""
        session.ticket = self.new_ticket()
        self._waiting[session.ticket] = session, hello

    def joins(self) -> list[Join]:
        """Inputs by which a few of those who wait come in."""
        found = []
        at_the_door = [ticket for ticket in self._waiting if ticket not in self._asked]
        for ticket in at_the_door[: min(MAX_JOINS_PER_TICK, self._world.state.ids_left)]:
            session, hello = self._waiting[ticket]
            anywhere = session.is_operator or self._anywhere
            look = hello.look or NO_LOOK
            found.append(Join(ticket, session.name, hello.at, anywhere, look=look))
            self._asked.add(ticket)
        return found

    def let_in(self, ticket: int) -> Session | None:
        """The one whom the zone has let in; None if they have gone meanwhile."""
        self._asked.discard(ticket)
        found = self._waiting.pop(ticket, None)
        return None if found is None else found[0]

    def refused(self) -> list[Session]:
        """Those whom the zone has not let in, though it was asked to: it had no place for them.

        Call it when `let_in` was called for all whom a tick has let in; they wait no more.
        """
        waiting = [ticket for ticket in self._asked if ticket in self._waiting]
        self._asked.clear()
        return [self._waiting.pop(ticket)[0] for ticket in waiting]

    def drop(self, session: Session) -> bool:
        """Let somebody wait no more; whether they did."""
        return self._waiting.pop(session.ticket, None) is not None
