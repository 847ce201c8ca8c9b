"""What is to be seen while the bots are there: one line that changes, or lines now and then."""

import time
from types import TracebackType
from typing import Final, Self

from rich.console import Console
from rich.live import Live
from rich.text import Text

from esplanade.bots.tally import Tally

PLAIN_EVERY_S: Final = 5.0


class Progress:
    """Shows tallies as they come in: live on a terminal, else a plain line every few seconds."""

    def __init__(self, console: Console) -> None:
        self._console = console
        self._live = Live(console=console, auto_refresh=False) if console.is_terminal else None
        self._began_s = self._printed_s = self._then_s = time.monotonic()
        self._bytes_then = 0
        self._bytes_per_s = 0.0

    def __enter__(self) -> Self:
        if self._live is not None:
            self._live.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._live is not None:
            self._live.stop()

    def show(self, tally: Tally) -> None:
        now_s = time.monotonic()
        self._update_rate(tally, now_s)
        line = self._line(tally, now_s)
        if self._live is not None:
            self._live.update(Text(line), refresh=True)
        elif now_s - self._printed_s >= PLAIN_EVERY_S:
            self._printed_s = now_s
            self._console.print(line, highlight=False, soft_wrap=True)

    def _update_rate(self, tally: Tally, now_s: float) -> None:
        if now_s - self._then_s >= 1.0:
            self._bytes_per_s = (tally.bytes_in - self._bytes_then) / (now_s - self._then_s)
            self._then_s, self._bytes_then = now_s, tally.bytes_in

    def _line(self, tally: Tally, now_s: float) -> str:
        parts = [
            f"{now_s - self._began_s:5.0f} s",
            f"{tally.present} here",
            f"{tally.joined}/{tally.expected} joined",
            f"{tally.left} left",
        ]
        if tally.failed or tally.lost:
            parts.append(f"{tally.failed} failed, {tally.lost} lost")
        if tally.present:
            parts.append(f"{self._bytes_per_s / tally.present / 1e3:.1f} kB/s each")
        for name, histogram, factor, unit in (
            ("round trip", tally.round_trip_s, 1e3, "ms"),
            ("age", tally.snapshot_age_s, 1e3, "ms"),
            ("off the way", tally.deviation_m, 1e2, "cm"),
        ):
            middle, high = histogram.percentile(50), histogram.percentile(99)
            if middle is not None and high is not None:
                parts.append(f"{name} p50 {middle * factor:.1f} p99 {high * factor:.1f} {unit}")
        if tally.errors:
            parts.append(f"{tally.errors.total()} errors")
        return " · ".join(parts)
