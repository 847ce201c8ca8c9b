"""The brake on guessing: too many wrong passwords lock an address or a name for a time."""

import math
from collections import OrderedDict, deque
from dataclasses import dataclass, field
from typing import Final

WRONG: Final = 5
"""This number of wrong passwords within a period locks an address or a name."""
PERIOD_S: Final = 60.0
FIRST_LOCK_S: Final = 60.0
LONGEST_LOCK_S: Final = 3600.0
"""Each lock lasts twice as long as the one before, up to this."""
QUIET_S: Final = 24 * 3600.0
"""After this time without a wrong password the next lock is a first one again."""
REMEMBERED: Final = 4096
"""Addresses, and as many names, of which wrong passwords are remembered; the one that was wrong
longest ago is forgotten first."""


class LockedOutError(Exception):
    """The password was not looked at, since too many were wrong."""

    def __init__(self, seconds: float) -> None:
        self.seconds = math.ceil(seconds)
        super().__init__(
            f"too many wrong passwords; this one was not looked at: try again in {self.seconds} s"
        )


@dataclass(slots=True)
class _Tries:
    wrong: "deque[float]" = field(default_factory=lambda: deque(maxlen=WRONG))
    locks: int = 0
    locked_until_s: float = -math.inf
    """Wrong passwords from before this have had their lock, and do not count again."""
    unlocked_s: float = -math.inf
    """The value of `locked_until_s` before the latest lock."""
    latest_s: float = -math.inf


class Lockout:
    """Counts wrong passwords by address and by name. It is to be called from one thread.

    A password counts as wrong from the moment it is taken for comparing, so that many at once are
    no way around the count; `forgive` takes that back. Networks that belong to one party, such as
    64 bits of IPv6, are to be given as one address.
    """

    def __init__(self) -> None:
        self._addresses: OrderedDict[str, _Tries] = OrderedDict()
        self._names: OrderedDict[str, _Tries] = OrderedDict()
        self.wrong = 0
        """Passwords that were wrong."""
        self.unread = 0
        """Passwords that were not looked at."""
        self.locks = 0
        """Times that an address or a name was locked."""

    def take(self, name: str, address: str, now_s: float) -> None:
        """Count a password that is about to be compared.

        Raises
        ------
        LockedOutError
            It is not to be compared: the address or the name is locked.
        """
        both = (
            self._tries(self._addresses, address, now_s),
            self._tries(self._names, name, now_s),
        )
        left_s = max(tries.locked_until_s for tries in both) - now_s
        if left_s > 0:
            self.unread += 1
            raise LockedOutError(left_s)
        self.wrong += 1
        for tries in both:
            tries.wrong.append(now_s)
            tries.latest_s = now_s
            counted = len(tries.wrong) == WRONG and tries.wrong[0] >= tries.locked_until_s
            if counted and now_s - tries.wrong[0] < PERIOD_S:
                lasting_s = min(FIRST_LOCK_S * 2**tries.locks, LONGEST_LOCK_S)
                tries.unlocked_s, tries.locked_until_s = tries.locked_until_s, now_s + lasting_s
                tries.locks += 1
                self.locks += 1

    def forgive(self, name: str, address: str, now_s: float) -> None:
        """Take back the count of a password that was right, and all that its name had.

        Of the address only this one is taken back: who knows one password may guess at others.
        """
        self.wrong -= 1
        self._names.pop(name, None)
        tries = self._addresses.get(address)
        if tries is None or not tries.wrong:
            return
        tries.wrong.pop()
        if tries.locked_until_s > now_s:  # without this one there are too few for a lock
            tries.locked_until_s = tries.unlocked_s
            tries.locks -= 1
            self.locks -= 1

    def _tries(self, kept: "OrderedDict[str, _Tries]", key: str, now_s: float) -> _Tries:
        tries = kept.setdefault(key, _Tries())
        kept.move_to_end(key)
        if now_s - tries.latest_s > QUIET_S:
            tries.locks = 0
        if len(kept) > REMEMBERED:
            kept.popitem(last=False)
        return tries
