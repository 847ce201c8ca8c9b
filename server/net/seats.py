"""Seats tell whose avatar it is: they hold resume tokens, and wait for a lost person."""

import hashlib
import secrets
from collections import Counter, OrderedDict
from dataclasses import dataclass, field
from typing import Generic, TypeVar

from esplanade.server.accounts.identity import Identity

Occupant = TypeVar("Occupant")


@dataclass(eq=False)
class Seat(Generic[Occupant]):
    """One person's avatar, and the session that steers it now, if there is one."""

    avatar_id: int
    name: str
    address: str
    """The address of the client that has or had the seat last."""
    occupant: Occupant | None
    digests: list[bytes] = field(repr=False)
    """Hashes of the tokens that take the seat: the newest is the last, before it at most one."""
    operator: Identity | None = None
    """The operator who has walked in by a pass, and comes back as one."""


class Seats(Generic[Occupant]):
    """All seats by the hashes of their tokens; the tokens themselves are not kept.

    A token is renewed whenever it takes a seat. The one that was used stays valid beside the new
    one until its holder is known to have the new one: a welcome that is lost loses no avatar.
    """

    def __init__(self) -> None:
        self._by_digest: dict[bytes, Seat[Occupant]] = {}
        self._by_avatar: dict[int, Seat[Occupant]] = {}
        self._vacant: OrderedDict[int, float] = OrderedDict()

    def __len__(self) -> int:
        return len(self._by_avatar)

    @property
    def vacant(self) -> int:
        return len(self._vacant)

    def issue(self, avatar_id: int, name: str, address: str, occupant: Occupant) -> str:
        """Make a seat for a new avatar, and return the token that takes it again."""
        seat = Seat(avatar_id, name, address, occupant, [])
        self._by_avatar[avatar_id] = seat
        return self._add_token(seat)

    def walks_in(self, avatar_id: int, operator: Identity | None) -> None:
        """Note that a seat is an operator's, who came by a pass; a key is sent again each time."""
        if operator is not None and operator.via == "pass":
            self._by_avatar[avatar_id].operator = operator

    def put(self, seat: Seat[Occupant]) -> None:
        """Put in a seat of somebody who has come from another zone, and sits there."""
        self._by_avatar[seat.avatar_id] = seat
        for digest in seat.digests:
            self._by_digest[digest] = seat

    def vacant_from(self, avatar_id: int) -> float | None:
        """Since when a seat is vacant; None for one in use."""
        return self._vacant.get(avatar_id)

    def restore(self, seat: Seat[Occupant], vacant_since: float) -> None:
        """Put in a seat from before a restart, whose person is lost since that moment.

        Seats must come in the order of those moments.
        """
        self._by_avatar[seat.avatar_id] = seat
        for digest in seat.digests:
            self._by_digest[digest] = seat
        self._vacant[seat.avatar_id] = vacant_since

    def vacant_s(self, now: float) -> dict[int, float | None]:
        """For how many seconds each seat has been vacant, by its avatar; None for one in use."""
        found: dict[int, float | None] = dict.fromkeys(self._by_avatar)
        found.update((avatar_id, now - since) for avatar_id, since in self._vacant.items())
        return found

    def occupants(self) -> list[Occupant]:
        """Everyone who has a seat and is there."""
        seats = self._by_avatar.values()
        return [seat.occupant for seat in seats if seat.occupant is not None]

    def all(self) -> list[Seat[Occupant]]:
        """All seats, those first that were vacated first, as `restore` wants them."""
        vacant = [self._by_avatar[avatar_id] for avatar_id in self._vacant]
        return [*vacant, *(seat for seat in self._by_avatar.values() if seat.occupant is not None)]

    def find(self, token: str) -> Seat[Occupant] | None:
        return self._by_digest.get(digest_of(token))

    def of(self, avatar_id: int) -> Seat[Occupant] | None:
        return self._by_avatar.get(avatar_id)

    def renew(self, seat: Seat[Occupant], token: str) -> str:
        """Return a new token of a seat; of the old ones only the given one remains valid."""
        used = digest_of(token)
        for digest in seat.digests:
            if digest != used:
                del self._by_digest[digest]
        seat.digests = [used]
        return self._add_token(seat)

    def confirm(self, seat: Seat[Occupant]) -> None:
        """Note that the newest token has arrived: no other one takes the seat any more."""
        *old, newest = seat.digests
        for digest in old:
            del self._by_digest[digest]
        seat.digests = [newest]

    def occupy(self, seat: Seat[Occupant], occupant: Occupant, address: str) -> Occupant | None:
        """Take a seat, and return the occupant until now."""
        before, seat.occupant, seat.address = seat.occupant, occupant, address
        self._vacant.pop(seat.avatar_id, None)
        return before

    def vacate(self, seat: Seat[Occupant], now: float) -> None:
        """Leave a seat: from now on nobody steers its avatar."""
        seat.occupant = None
        self._vacant[seat.avatar_id] = now

    def remove(self, seat: Seat[Occupant]) -> None:
        """Remove the seat of an avatar that is gone, and its tokens with it."""
        for digest in seat.digests:
            del self._by_digest[digest]
        del self._by_avatar[seat.avatar_id]
        self._vacant.pop(seat.avatar_id, None)

    def vacant_since(self, moment: float) -> list[Seat[Occupant]]:
        """Seats that have been vacant since that moment or longer."""
        seats = []
        for avatar_id, since in self._vacant.items():
            if since > moment:
                break
            seats.append(self._by_avatar[avatar_id])
        return seats

    def yielding(self) -> Seat[Occupant] | None:
        """The seat that is given up first: the longest vacant one of the address with most."""
        vacant = [self._by_avatar[avatar_id] for avatar_id in self._vacant]
        crowds = Counter(seat.address for seat in vacant)
        # Of the greatest, `max` returns the first: the one that has been vacant longest.
        return max(vacant, key=lambda seat: crowds[seat.address], default=None)

    def _add_token(self, seat: Seat[Occupant]) -> str:
        token = secrets.token_urlsafe(24)
        digest = digest_of(token)
        seat.digests.append(digest)
        self._by_digest[digest] = seat
        return token


def digest_of(token: str) -> bytes:
    """Return the SHA-256 digest of a resume token."""
    return hashlib.sha256(token.encode("utf-8", "surrogatepass")).digest()
