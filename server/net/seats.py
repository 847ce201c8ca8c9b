"""Seats tell whose avatar it is: they hold resume tokens, and wait for a lost person."""

import hashlib
import secrets
from collections import OrderedDict
from dataclasses import dataclass, field
from typing import Generic, TypeVar

Occupant = TypeVar("Occupant")


@dataclass(eq=False)
class Seat(Generic[Occupant]):
    """One person's avatar, and the session that steers it now, if there is one."""

    avatar_id: int
    name: str
    occupant: Occupant | None
    digest: bytes = field(repr=False)


class Seats(Generic[Occupant]):
    """All seats by the hash of their token; the token itself is not kept."""

    def __init__(self) -> None:
        self._by_digest: dict[bytes, Seat[Occupant]] = {}
        self._by_avatar: dict[int, Seat[Occupant]] = {}
        self._vacant: OrderedDict[int, float] = OrderedDict()

    def __len__(self) -> int:
        return len(self._by_avatar)

    @property
    def vacant(self) -> int:
        return len(self._vacant)

    def issue(self, avatar_id: int, name: str, occupant: Occupant) -> str:
        """Make a seat for a new avatar, and return the token that takes it again."""
        token = secrets.token_urlsafe(24)
        seat = Seat(avatar_id, name, occupant, _digest(token))
        self._by_digest[seat.digest] = self._by_avatar[avatar_id] = seat
        return token

    def find(self, token: str) -> Seat[Occupant] | None:
        return self._by_digest.get(_digest(token))

    def of(self, avatar_id: int) -> Seat[Occupant] | None:
        return self._by_avatar.get(avatar_id)

    def occupy(self, seat: Seat[Occupant], occupant: Occupant) -> Occupant | None:
        """Take a seat, and return the occupant until now."""
        before, seat.occupant = seat.occupant, occupant
        self._vacant.pop(seat.avatar_id, None)
        return before

    def vacate(self, seat: Seat[Occupant], now: float) -> None:
        """Leave a seat: from now on nobody steers its avatar."""
        seat.occupant = None
        self._vacant[seat.avatar_id] = now

    def remove(self, seat: Seat[Occupant]) -> None:
        """Remove the seat of an avatar that is gone, and its token with it."""
        del self._by_digest[seat.digest], self._by_avatar[seat.avatar_id]
        self._vacant.pop(seat.avatar_id, None)

    def vacant_since(self, moment: float) -> list[Seat[Occupant]]:
        """Seats that have been vacant since that moment or longer."""
        seats = []
        for avatar_id, since in self._vacant.items():
            if since > moment:
                break
            seats.append(self._by_avatar[avatar_id])
        return seats


def _digest(token: str) -> bytes:
    return hashlib.sha256(token.encode("utf-8", "surrogatepass")).digest()
