"""How many seconds of searching for routes a person and an address may cause."""

from typing import Final, NamedTuple

from esplanade.server.net.addresses import LOCAL_KEYS
from esplanade.server.net.fair_queue import Asker


class Share(NamedTuple):
    """Processor time for searches."""

    per_s: float
    """Seconds that are to be had in each second, for long."""
    burst_s: float
    """Seconds that are to be had at once; a debt grows no greater than this either."""


PERSON: Final = Share(0.1, 1.5)
ADDRESS: Final = Share(0.25, 2.0)
"""For all people of one address together: half of what all addresses have together."""

REQUEST_S: Final = 0.001
"""A request costs at least this, however short the search."""

_KEPT: Final = 1024


class Account:
    """Seconds that are left of a share, refilled with time; `now` is of any one clock."""

    __slots__ = ("_left_s", "_share", "_then")

    def __init__(self, share: Share, now: float) -> None:
        self._share = share
        self._left_s = share.burst_s
        self._then = now

    def _refill(self, now: float) -> None:
        share = self._share
        self._left_s = min(share.burst_s, self._left_s + (now - self._then) * share.per_s)
        self._then = now

    def spend(self, seconds: float, now: float) -> None:
        """Take seconds, be it more than are left."""
        self._refill(now)
        self._left_s = max(-self._share.burst_s, self._left_s - seconds)

    def wait_s(self, now: float) -> float:
        """Seconds until the debt is paid; 0 without one."""
        self._refill(now)
        return max(0.0, -self._left_s / self._share.per_s)

    def is_full(self, now: float) -> bool:
        """Whether there is no need to remember it."""
        self._refill(now)
        return self._left_s >= self._share.burst_s


class SearchBudget:
    """Accounts of people and addresses; those that are full again are forgotten.

    People who share one of `LOCAL_KEYS` have their own accounts only.
    """

    def __init__(self, person: Share = PERSON, address: Share = ADDRESS) -> None:
        self._person = person
        self._address = address
        self._people: dict[int, Account] = {}
        self._addresses: dict[str, Account] = {}
        self._swept_at = _KEPT

    def wait_s(self, asker: Asker, now: float) -> float:
        """Seconds until this person may ask again; 0 if they may now."""
        return max((account.wait_s(now) for account in self._known(asker)), default=0.0)

    def spend(self, asker: Asker, seconds: float, now: float) -> None:
        """Charge a person and their address with some work, be it more than is left."""
        self._sweep(now)
        if asker.avatar_id not in self._people:
            self._people[asker.avatar_id] = Account(self._person, now)
        if asker.address not in LOCAL_KEYS and asker.address not in self._addresses:
            self._addresses[asker.address] = Account(self._address, now)
        for account in self._known(asker):
            account.spend(seconds, now)

    def _known(self, asker: Asker) -> list[Account]:
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
