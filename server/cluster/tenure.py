"""One host's ownership of one zone, as that host knows of it."""

from dataclasses import dataclass
from typing import Final

LEASE_S: Final = 3.0
"""For so long a zone remains its host's after each renewal, by the clock of the database."""

RENEWAL_S: Final = 1.0
"""A host renews its leases after so long."""


@dataclass(frozen=True)
class Claim:
    """A zone as it was claimed. The epoch is the number of this ownership, and only ever grows."""

    zone: str
    host: str
    epoch: int


class Tenure:
    """Tells a host whether it may still act for a zone that it has claimed.

    A host that cannot reach the database goes on: nobody else can take the zone either. One that
    was frozen may act for a moment after it wakes; each effect of that carries its epoch and is
    refused by whoever knows a newer one.
    """

    def __init__(self, claim: Claim) -> None:
        self.claim = claim
        self.holds = True
        """False from the moment at which the host knows that the zone is another's."""

    def renewed(self, kept: bool) -> None:
        """Take in the answer to a renewal: whether the zone was still the host's."""
        self.holds = self.holds and kept

    def heard(self, epoch: int) -> None:
        """Take in an epoch of the zone that somebody has told of."""
        self.holds = self.holds and epoch <= self.claim.epoch

    def release(self) -> None:
        """Give the zone up; the last checkpoint has been written."""
        self.holds = False
