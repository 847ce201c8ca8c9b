"""The pace of the world, as notices tell it."""

from math import isfinite
from typing import Final, NamedTuple

from esplanade.protocol import NoticeCode
from esplanade.protocol.messages import Notice

_OF_PACE: Final = (NoticeCode.PAUSED, NoticeCode.RESUMED, NoticeCode.PACE)


class WorldPace(NamedTuple):
    """Seconds of the world in a second, and its time at the moment when that began."""

    rate: float
    server_time_s: float


def pace_of(notice: Notice) -> WorldPace | None:
    """The pace that a notice tells of; None if it is about something else."""
    if notice.notice not in _OF_PACE:
        return None
    told = [notice.arguments.get(name) for name in ("rate", "server_time")]
    rate, server_time_s = (each if isinstance(each, int | float) else -1.0 for each in told)
    if not (rate >= 0.0 and isfinite(rate) and isfinite(server_time_s)):
        return None
    return WorldPace(float(rate), float(server_time_s))
