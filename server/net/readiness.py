"""Whether people may come in: the world is open, and it ticks."""

from time import monotonic
from typing import Final

from esplanade.server.metrics import Metrics

STALLED_S: Final = 5.0
"""A world without a tick for this long is not ready."""


class Readiness:
    """Set by the world's thread, asked for by that of the private port."""

    def __init__(self, metrics: Metrics) -> None:
        self._metrics = metrics
        self._opened_at: float | None = None

    def open(self) -> None:
        """People may come in from now on."""
        self._opened_at = monotonic()

    def close(self) -> None:
        """The world is ending."""
        self._opened_at = None

    def hindrance(self) -> str | None:
        """Why nobody should be sent here, None if people may come in."""
        opened_at = self._opened_at
        if opened_at is None:
            return "starting or stopping"
        silent_s = monotonic() - max(opened_at, self._metrics.ticked_at)
        return f"no tick for {silent_s:.1f} s" if silent_s > STALLED_S else None
