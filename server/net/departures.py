"""People who stand in a portal, and go to another zone."""

from collections.abc import Callable, Mapping, Sequence, Set
from typing import Generic, TypeVar

from esplanade.planning import Portal
from esplanade.planning.scene.portal_areas import NO_PORTAL, portals_at
from esplanade.server.net.session import Session
from esplanade.server.world.state import PERSON
from esplanade.server.world.zone import Zone

Go = Callable[[Session, str], bool]
"""Lets a person go through the portal of that name; whether there is a way now."""

Steering = TypeVar("Steering")
"""The one who steers an avatar: a session, or the client of a gateway."""


class Departures(Generic[Steering]):
    """Those who are on their way out through a portal; what they send to move is void meanwhile.

    Whoever was let out by a portal, or was refused, goes nowhere before they have left its area.
    """

    def __init__(self, world: Zone, sessions: Mapping[int, Steering]) -> None:
        self._world = world
        self._sessions = sessions
        self._portals: Sequence[Portal] = ()
        self._go: Callable[[Steering, str], bool] | None = None
        self._inside: set[int] = set()
        """Those who were in the area of a portal when it was last looked at, or came out of it."""
        self._under_way: set[int] = set()

    def open(self, portals: Sequence[Portal], go: Callable[[Steering, str], bool] | None) -> None:
        """Let people go through these portals; none of them without `go`."""
        self._portals, self._go = portals, go

    def __contains__(self, avatar_id: int | None) -> bool:
        return avatar_id in self._under_way

    def among(self, avatar_ids: Set[int]) -> Set[int]:
        """Those of some people who are on their way out."""
        return self._under_way & avatar_ids

    def arrived(self, avatar_id: int) -> None:
        """Note that somebody has come out of a portal just now."""
        self._inside.add(avatar_id)

    def forget(self, avatar_id: int) -> None:
        """Somebody's connection has ended: whoever comes back to the avatar goes if they stand
        there yet."""
        self._under_way.discard(avatar_id)
        self._inside.discard(avatar_id)

    def go(self, avatar_id: int) -> None:
        """Let somebody go without any portal: the whole zone does."""
        self._under_way.add(avatar_id)

    def stay(self, avatar_id: int) -> None:
        """Let somebody move again, who was not let in."""
        self._under_way.discard(avatar_id)

    def check(self, staying: Callable[[int], bool]) -> list[int]:
        """Let those go who have come into a portal; returns their ids. Call it each tick.

        `staying` says of an avatar that it goes nowhere just now.
        """
        if self._go is None or not self._portals:
            return []
        state = self._world.state
        people = state.of_kind(PERSON)
        found = portals_at(self._portals, state.positions[people], state.heights[people])
        inside = found != NO_PORTAL
        here = {
            avatar_id: self._portals[number].name
            for avatar_id, number in zip(
                state.ids[people[inside]].tolist(), found[inside].tolist(), strict=True
            )
            if avatar_id in self._sessions
        }
        came = [
            one
            for one in here
            if one not in self._inside and one not in self._under_way and not staying(one)
        ]
        self._inside = {one for one in here if one in self._inside} | set(came)
        gone = [one for one in came if self._go(self._sessions[one], here[one])]
        self._under_way.update(gone)
        return gone
