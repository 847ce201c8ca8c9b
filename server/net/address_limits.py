"""Limits for each address, so that whoever sits at one of them takes no more than its share."""

from collections import OrderedDict
from dataclasses import dataclass
from typing import Final

from esplanade.server.net.addresses import LOCAL_KEYS
from esplanade.server.net.limits import TokenBucket
from esplanade.server.settings import ServerSettings

WINDOW_S: Final = 10.0
"""Connections and joins of one address are bounded within this time."""

FRAMES_BURST_S: Final = 0.25
"""An address may send at once what it may send in this time: all of it is parsed within a tick."""

PREPAID: Final = 0.5
"""Frames are paid for in advance while this part of a burst is left; else each has to wait."""

MAX_REMEMBERED: Final = 4096
"""Addresses without a connection whose rates are remembered, the latest ones."""


@dataclass(frozen=True)
class AddressBounds:
    """The most that one address may have."""

    sockets: int
    """Open connections of any kind."""
    connects: int
    """New connections within `WINDOW_S`."""
    joins: int
    """People who come in within `WINDOW_S`."""
    frames: int
    """WebSocket frames a second, of all its connections together."""

    @classmethod
    def of(cls, settings: ServerSettings) -> "AddressBounds":
        return cls(
            settings.address_sockets,
            settings.address_connects,
            settings.address_joins,
            settings.address_frames,
        )


class _Account:
    """The open connections of one address, and the credit that it has in this moment."""

    __slots__ = ("connects", "frames", "joins", "sockets")

    def __init__(self, bounds: AddressBounds, now: float) -> None:
        self.sockets = 0
        self.connects = TokenBucket(bounds.connects / WINDOW_S, bounds.connects, now)
        self.joins = TokenBucket(bounds.joins / WINDOW_S, bounds.joins, now)
        self.frames = TokenBucket(bounds.frames, FRAMES_BURST_S * bounds.frames, now)


class AddressLimits:
    """Accounts by the key of an address (`addresses.address_key`); `LOCAL_KEYS` have none.

    Accounts of addresses with open connections are as many as there are connections. Those
    without any are kept for their rates, `MAX_REMEMBERED` of them at most.
    """

    def __init__(self, bounds: AddressBounds) -> None:
        self._bounds = bounds
        self._busy: dict[str, _Account] = {}
        self._idle: OrderedDict[str, _Account] = OrderedDict()

    def __len__(self) -> int:
        """Addresses that have connections open."""
        return len(self._busy)

    def connect(self, key: str, now: float) -> str | None:
        """Count a new connection; the name of the limit if it is one too many."""
        if key in LOCAL_KEYS:
            return None
        account = self._account(key, now)
        if account.sockets >= self._bounds.sockets:
            return "address_sockets"
        if not account.connects.take(now):
            return "address_connects"
        account.sockets += 1
        if account.sockets == 1:
            self._busy[key] = self._idle.pop(key)
        return None

    def disconnect(self, key: str) -> None:
        """Take back a connection that `connect` has counted."""
        if key in LOCAL_KEYS:
            return
        account = self._busy[key]
        account.sockets -= 1
        if not account.sockets:
            self._idle[key] = self._busy.pop(key)
            self._forget()

    def join(self, key: str, now: float) -> str | None:
        """Count a person who wants to come in; the name of the limit if it is one too many."""
        if key in LOCAL_KEYS or self._account(key, now).joins.take(now):
            return None
        return "address_joins"

    def delay(self, key: str, frames: int, now: float) -> float:
        """Seconds to wait with frames of an address; they are counted where the result is 0."""
        if key in LOCAL_KEYS:
            return 0.0
        return self._account(key, now).frames.borrow(now, frames)

    def prepay(self, key: str, frames: int, now: float) -> bool:
        """Count frames of an address that are to come; only while it has sent few of late."""
        if key in LOCAL_KEYS:
            return True
        return self._account(key, now).frames.spare(now, frames, PREPAID)

    def pay_back(self, key: str, frames: int, now: float) -> None:
        """Take back frames that have not come."""
        if key not in LOCAL_KEYS:
            self._account(key, now).frames.give(now, frames)

    def _account(self, key: str, now: float) -> _Account:
        account = self._busy.get(key)
        if account is None:
            account = self._idle.get(key)
            if account is None:
                account = self._idle[key] = _Account(self._bounds, now)
                self._forget()
            else:
                self._idle.move_to_end(key)
        return account

    def _forget(self) -> None:
        if len(self._idle) > MAX_REMEMBERED:
            self._idle.popitem(last=False)
