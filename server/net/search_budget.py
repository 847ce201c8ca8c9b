"""A budget bounds the seconds of searching that a person and an address may cause."""

from typing import Final, NamedTuple

from esplanade.server.net.addresses import LOCAL_KEYS
from esplanade.server.net.fair_queue import Asker
from esplanade.server.net.limits import TokenBucket


class Share(NamedTuple):
    """Processor time for searches."""

    per_s: float
    """Seconds that are to be had in each second, for long."""
    burst_s: float
    """Seconds that are to be had at once; a debt grows no greater than this either."""

    def bucket(self, now: float) -> TokenBucket:
        """The account of somebody who has caused nothing yet; its tokens are seconds."""
        return TokenBucket(self.per_s, self.burst_s, now)


PERSON: Final = Share(0.1, 1.5)
ADDRESS: Final = Share(0.25, 2.0)
"""For all people of one address together: half of what all addresses have together."""

REQUEST_S: Final = 0.001
"""A request costs at least this, however short the search."""

_KEPT: Final = 1024


class SearchBudget:
    """Accounts of people and addresses; those that are full again are forgotten.

    People who share one of `LOCAL_KEYS` have their own accounts only.
    """

    def __init__(self, person: Share = PERSON, address: Share = ADDRESS) -> None:
        self._person = person
        self._address = address
        self._people: dict[int, TokenBucket] = {}
        self._addresses: dict[str, TokenBucket] = {}
        self._swept_at = _KEPT

    def wait_s(self, asker: Asker, now: float) -> float:
        """Seconds until this person may ask again; 0 if they may now."""
        return max((account.debt_s(now) for account in self._known(asker)), default=0.0)

    def spend(self, asker: Asker, seconds: float, now: float) -> None:
        """Charge a person and their address with some work, be it more than is left."""
        self._sweep(now)
        if asker.avatar_id not in self._people:
            self._people[asker.avatar_id] = self._person.bucket(now)
        if asker.address not in LOCAL_KEYS and asker.address not in self._addresses:
            self._addresses[asker.address] = self._address.bucket(now)
        for account in self._known(asker):
            account.spend(now, seconds)

    def _known(self, asker: Asker) -> list[TokenBucket]:
        accounts = self._people.get(asker.avatar_id), self._addresses.get(asker.address)
        return [account for account in accounts if account is not None]

    def _sweep(self, now: float) -> None:
        if len(self) < self._swept_at:
            return
        self._people = {k: a for k, a in self._people.items() if not a.is_full(now)}
        self._addresses = {k: a for k, a in self._addresses.items() if not a.is_full(now)}
        self._swept_at = max(_KEPT, 2 * len(self))

    def __len__(self) -> int:
        """Number of accounts that are kept."""
        return len(self._people) + len(self._addresses)
