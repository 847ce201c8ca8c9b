"""People who are here, their places, and those who have left lately."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol

from esplanade.server.moderation.areas import Area, Place, same_storey
from esplanade.server.net.guests import Guest
from esplanade.server.net.known_people import AddressHashes, Gone, KnownPerson
from esplanade.server.net.walk_outs import WalkOuts
from esplanade.server.world.zone import Zone


class SeatTokens(Protocol):
    """A seat, as far as its person can be known again by it."""

    @property
    def digests(self) -> Sequence[bytes]:
        """SHA-256 of the tokens that take it."""


class SeatsHere(Protocol):
    """The seats of a zone by their avatars' ids."""

    def of(self, avatar_id: int) -> SeatTokens | None:
        """The seat of an avatar; None if it has none."""


class PeopleHere:
    """The people of a hub, by their avatars' ids, as those who look after them know them."""

    def __init__(
        self,
        world: Zone,
        storeys: Sequence[float],
        sessions: Mapping[int, Guest],
        seats: SeatsHere,
        now_s: Callable[[], float],
    ) -> None:
        self.walk_outs: WalkOuts | None = None
        """Those who are being walked out."""
        self._world = world
        self._storeys = storeys
        self._sessions = sessions
        self._seats = seats
        self._now_s = now_s
        self._gone = Gone()
        self._hashes = AddressHashes()

    def name_of(self, person: int) -> str | None:
        """Return the name of a connected person."""
        session = self._sessions.get(person)
        return None if session is None else session.name

    def reportable(self, avatar_id: int) -> str | None:
        """The name of a person or an actor who is here, or of a person who has just left."""
        if avatar_id in self._world.state:
            return self._world.state.names[self._world.state.slot(avatar_id)]
        known = self.known(avatar_id)
        return None if known is None else known.name

    def known(self, person: int) -> KnownPerson | None:
        """A person who is connected, or has left within the last minutes."""
        session = self._sessions.get(person)
        return self._gone.get(person, self._now_s()) if session is None else self._of(session)

    def remember(self, session: Guest) -> None:
        """Remember somebody whose connection ends."""
        if session.avatar_id is not None:
            self._gone.add(self._of(session), self._now_s())

    def where(self, avatar_id: int) -> Place | None:
        """The place of an avatar; None if it is not in the world."""
        state = self._world.state
        if avatar_id not in state:
            return None
        slot = state.slot(avatar_id)
        x, y = state.positions[slot].tolist()
        return round(x, 3), round(y, 3), round(float(state.heights[slot]), 3)

    def within(
        self,
        *,
        storey_m: float | None,
        polygon: Sequence[tuple[float, float]] | None,
        centre: Place | None,
        radius_m: float,
    ) -> list[int]:
        """Connected people on a storey, in a polygon, or around a centre; all of them without."""
        area = None if polygon is None else Area(tuple(polygon), storey_m)
        found = []
        for avatar_id in self._sessions:
            place = self.where(avatar_id)
            if place is None:
                continue
            if area is not None:
                wanted = area.holds(place, self._storeys)
            elif storey_m is not None:
                wanted = same_storey(place[2], storey_m, self._storeys)
            else:
                wanted = centre is None or _near(place, centre, radius_m)
            if wanted:
                found.append(avatar_id)
        return found

    def details(self, person: int) -> dict[str, Any]:
        """The facts of a connected person that operators are shown beside place and name."""
        session = self._sessions[person]
        return {
            "since_us": session.since_us,
            "address_hash": self._hashes.of(session.address),
            "delay_ms": None,
            "queue_bytes": session.outbox.unsent(),
            "operator": session.is_operator,
            "walked_out": self.walk_outs is not None and person in self.walk_outs,
        }

    def _of(self, session: Guest) -> KnownPerson:
        avatar_id = session.avatar_id or 0
        seat = self._seats.of(avatar_id)
        digests = () if seat is None else tuple(each.hex() for each in seat.digests)
        return KnownPerson(avatar_id, session.name, session.wished, session.address, digests)


def _near(place: Place, centre: Place, radius_m: float) -> bool:
    return math.dist(place, centre) <= radius_m
