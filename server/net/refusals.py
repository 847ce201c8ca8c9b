"""Everything that is refused is counted by its reason, and the log names the addresses.

An attack refuses thousands of connections a second: one line stands for all refusals of one
address and reason within some seconds, and lines of all addresses together are bounded too.
"""

import asyncio
from collections import OrderedDict
from typing import Final

import structlog

from esplanade.server.metrics import Metrics
from esplanade.server.net.limits import TokenBucket

SILENT_S: Final = 10.0
"""An address is named again for the same reason no earlier than this."""

LINES_PER_S: Final = 2.0
LINES_BURST: Final = 20.0
MAX_REMEMBERED: Final = 1024

log = structlog.get_logger(__name__)


class Refusals:
    """Metrics and log lines of everything that limits have turned away or cut off."""

    def __init__(self, metrics: Metrics) -> None:
        self._metrics = metrics
        self._clock = asyncio.get_running_loop().time
        self._lines = TokenBucket(LINES_PER_S, LINES_BURST, self._clock())
        self._notes: OrderedDict[tuple[str, str], _Note] = OrderedDict()

    def socket(self, why: str, address: str) -> None:
        """Note a connection that was not let in, or cut off before it could say anything."""
        self._metrics.sockets_refused.labels(why).inc()
        self._tell("connection refused", why, address)

    def answer(self, why: str, address: str) -> None:
        """Note an answer to a request for a page that was refused or broken off."""
        self._metrics.answers_refused.labels(why).inc()
        self._tell("answer refused", why, address)

    def flood(self, what: str, address: str) -> None:
        """Note a connection that is closed because of how it sends, by what it has too much of."""
        self._metrics.floods.labels(what).inc()
        self._tell("client closed, it floods", what, address)

    def line(self, why: str, address: str) -> None:
        """Note a line of chat that nobody hears, whose speaker stays connected."""
        self._metrics.lines_refused.labels(why).inc()
        self._tell("line of chat refused", why, address)

    def slow(self, limit: str, address: str) -> None:
        """Note a client that is dropped because it does not read, by the limit that it broke."""
        self._metrics.dropped_slow.labels(limit).inc()
        self._tell("client dropped, too slow", limit, address)

    def fault(self, why: str, address: str) -> None:
        """Note a connection that is closed because of a message or a frame that came on it.

        Metrics count it by its error and its close code already.
        """
        self._tell("client closed", why, address)

    def _tell(self, event: str, why: str, address: str) -> None:
        now = self._clock()
        note = self._notes.get((why, address))
        if note is None:
            note = self._notes[why, address] = _Note()
            if len(self._notes) > MAX_REMEMBERED:
                self._notes.popitem(last=False)
        note.times += 1
        if now >= note.silent_until and self._lines.take(now):
            log.warning(event, why=why, address=address, times=note.times)
            note.times, note.silent_until = 0, now + SILENT_S


class _Note:
    """The refusals of one address and reason that are not told yet."""

    __slots__ = ("silent_until", "times")

    def __init__(self) -> None:
        self.times = 0
        self.silent_until = float("-inf")
