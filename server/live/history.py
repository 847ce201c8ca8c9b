"""Speed and reason of each actor over the last half hour, second by second."""

from collections import deque
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from esplanade.actors.state import Reason
from esplanade.protocol.snapshot import SPEED_MPS
from esplanade.server.live.map_feed import MapFeed
from esplanade.server.live.measures import STANDING

KEPT_S: Final = 1800


class _Second(NamedTuple):
    second: int
    ids: npt.NDArray[np.uint32]
    speeds: npt.NDArray[np.uint8]
    reasons: npt.NDArray[np.uint8]


class History:
    """The recent past of all actors, so that one can be looked up once it turns out to matter."""

    def __init__(self, feed: MapFeed) -> None:
        self._feed = feed
        self._seconds: deque[_Second] = deque(maxlen=KEPT_S)

    def add(self, second: int) -> None:
        """Take in how actors are at a second since 1970."""
        records = self._feed.records[self._feed.rows_by_kind()[0]]
        self._seconds.append(
            _Second(second, records["id"].copy(), records["speed"].copy(), records["reason"].copy())
        )

    def told(
        self, avatar_id: int, from_us: int, to_us: int
    ) -> tuple[list[int], dict[str, list[float | str | None]]]:
        """Times, and speed, reason and whether it was held; None where it was not in the world."""
        times: list[int] = []
        found: dict[str, list[float | str | None]] = {"speed": [], "reason": [], "wait": []}
        for each in self._seconds:
            at_us = each.second * 1_000_000
            if not from_us <= at_us <= to_us:
                continue
            times.append(at_us)
            row = int(np.searchsorted(each.ids, avatar_id))
            if row == len(each.ids) or each.ids[row] != avatar_id:
                for values in found.values():
                    values.append(None)
                continue
            reason = Reason(int(each.reasons[row]))
            found["speed"].append(round(int(each.speeds[row]) * SPEED_MPS, 2))
            found["reason"].append(reason.name.lower())
            found["wait"].append(float(reason in STANDING))
        return times, found
