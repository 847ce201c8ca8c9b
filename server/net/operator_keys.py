"""Keys of operators: wrong ones are counted, logged with their address, and slowed down."""

import math
import secrets
from collections import OrderedDict, deque
from typing import Final

import structlog

from esplanade.server.accounts.identity import Identity
from esplanade.server.accounts.rights import Right
from esplanade.server.metrics import Metrics

WRONG_KEYS: Final = 5
"""An address may give this many wrong keys in a minute; further ones are refused unread."""

PERIOD_S: Final = 60.0
MAX_ADDRESSES: Final = 4096
"""Addresses of which wrong keys are remembered; the one that was wrong longest ago goes first."""

SERVICE: Final = Identity(account="key", role="doors", rights=frozenset({Right.DOORS}), via="key")
"""Whoever says the key: a service account that moves doors, until all operators have accounts."""

log = structlog.get_logger(__name__)


def operator_of(account: str, address: str, *, moves_doors: bool) -> Identity | None:
    """The operator that somebody was when they came in; with an account, what it may do is looked
    up with each command."""
    if not account:
        return SERVICE if moves_doors else None
    rights = frozenset({Right.DOORS}) if moves_doors else frozenset()
    return Identity(account=account, role="", rights=rights, via="pass", address=address or None)


class TooManyKeysError(ValueError):
    """The key was not looked at, because too many wrong ones came from its address."""


class OperatorKeys:
    """Compares what clients give with the one key that the server has; no key, no operators."""

    def __init__(self, key: str, metrics: Metrics) -> None:
        self._key = key.encode()
        self._metrics = metrics
        self._wrong: OrderedDict[str, deque[float]] = OrderedDict()
        """The times of the latest wrong keys, by address."""

    def opens(self, key: str | None, address: str, now: float) -> bool:
        """Whether this is the operator key; a client that gives none is no operator.

        Raises
        ------
        TooManyKeysError
            Too many wrong keys came from this address lately.
        """
        if not key:
            return False
        times = self._wrong.get(address)
        if times is not None and len(times) == WRONG_KEYS and now - times[0] < PERIOD_S:
            self._metrics.operator_keys_refused.labels("unread").inc()
            raise TooManyKeysError(
                "the operator key was not read, because too many wrong ones came from your "
                f"address; try again in {math.ceil(times[0] + PERIOD_S - now)} s"
            )
        known = secrets.compare_digest(self._key, key.encode("utf-8", "surrogatepass"))
        if known and self._key:
            return True
        self._count_wrong(address, now)
        return False

    def _count_wrong(self, address: str, now: float) -> None:
        self._wrong.setdefault(address, deque(maxlen=WRONG_KEYS)).append(now)
        self._wrong.move_to_end(address)
        if len(self._wrong) > MAX_ADDRESSES:
            self._wrong.popitem(last=False)
        self._metrics.operator_keys_refused.labels("wrong").inc()
        log.warning("wrong operator key", address=address)
