"""A start warns when the largest crowd that is let in would take longer than a tick."""

from typing import Final

import structlog

from esplanade.server.settings import ServerSettings

PERSON_S: Final = 6e-6
"""To take in the wishes of one person who walks, and to move it and its feet."""
VIEWER_S: Final = 23e-6
"""To find, encode and write the news of one viewer in a dense crowd: most of it is the socket."""

log = structlog.get_logger(__name__)


def crowded_tick_s(people: int) -> float:
    """About how long a tick takes when so many people stand close together and most of them walk.

    Measured with `python -m benchmarks.live sides` on one core of an ordinary machine.
    """
    return people * (PERSON_S + VIEWER_S)


def warn_of_crowding(settings: ServerSettings) -> None:
    """Warn, with the figure, where more people are let in than a tick has time for."""
    took_s = crowded_tick_s(settings.max_clients)
    if took_s <= settings.tick_s:
        return
    log.warning(
        "more people are let in than a tick has time for, should all crowd together: "
        "ticks will be late, and the world slower than the clock",
        max_clients=settings.max_clients,
        tick_ms=round(1e3 * took_s),
        of_ms=round(1e3 * settings.tick_s),
        enough_for=int(settings.tick_s / crowded_tick_s(1)),
    )
