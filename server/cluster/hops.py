"""A person goes from one zone to another: the rules of the zone left and of the one reached.

The hop is done in the one statement that moves the seat (`seats.hop`). Before it nothing has
happened, after it the person is the destination's, whoever dies. The person is shown by neither
zone while the statement is under way, since nobody knows then whose the person is.
"""

from dataclasses import dataclass
from enum import Enum, auto
from typing import Final

KEPT_S: Final = 5.0
"""The destination keeps a place for so long."""

KEPT: Final = 64
"""It keeps no more places at once."""


class Stage(Enum):
    """How far a hop has come, as the origin knows."""

    ASKED = auto()
    """The destination is asked for a place; the person stands in the portal and is shown."""
    MOVING = auto()
    """The seat is being moved, or nobody knows whether it was; the person is not shown."""
    GONE = auto()
    """The seat is the destination's; the avatar is taken out."""
    STAYED = auto()
    """The person stays, and may walk again."""


class Hop:
    """One person's hop, at the origin. Messages that come late or twice change nothing."""

    def __init__(self, person: int, hops: int, asked_s: float) -> None:
        self.person = person
        self.hops = hops
        """How often the person has hopped before: names this hop."""
        self.stage = Stage.ASKED
        self._asked_s = asked_s

    @property
    def is_shown(self) -> bool:
        """Whether the origin still shows the person."""
        return self.stage in {Stage.ASKED, Stage.STAYED}

    def answered(self, hops: int, *, kept: bool) -> bool:
        """Take in the destination's answer; returns whether the seat is now to be moved."""
        if self.stage is not Stage.ASKED or hops != self.hops:
            return False
        self.stage = Stage.MOVING if kept else Stage.STAYED
        return kept

    def given_up(self, now_s: float) -> bool:
        """Give up where no answer has come in the time for which a place is kept."""
        if self.stage is Stage.ASKED and now_s - self._asked_s >= KEPT_S:
            self.stage = Stage.STAYED
        return self.stage is Stage.STAYED

    def moved(self, *, is_here: bool | None) -> None:
        """Take in what became of the seat: whether it is still here; None: nobody knows yet.

        A statement without an answer may have been carried out. Its outcome is then read from the
        seat, and until then the hop remains where it is.
        """
        if self.stage is Stage.MOVING and is_here is not None:
            self.stage = Stage.STAYED if is_here else Stage.GONE


@dataclass(frozen=True)
class _Place:
    hops: int
    until_s: float


class KeptPlaces:
    """The places that a destination keeps for persons who are on their way."""

    def __init__(self, most: int = KEPT) -> None:
        self._most = most
        self._places: dict[int, _Place] = {}

    def __len__(self) -> int:
        return len(self._places)

    def keep(self, person: int, hops: int, room: int, now_s: float) -> bool:
        """Keep a place for a person, if there is one among so many that are free.

        Asked again with the same hop, the place is kept for longer; an older hop has no place.
        """
        self.lapse(now_s)
        known = self._places.get(person)
        if known is None and len(self._places) >= min(room, self._most):
            return False
        if known is not None and hops < known.hops:
            return False
        self._places[person] = _Place(hops, now_s + KEPT_S)
        return True

    def taken(self, person: int) -> None:
        """Note that a person has come, whether to a kept place or by a seat that was found."""
        self._places.pop(person, None)

    def lapse(self, now_s: float) -> None:
        """Give up the places whose persons have not come in time."""
        for person in [key for key, place in self._places.items() if place.until_s <= now_s]:
            del self._places[person]
