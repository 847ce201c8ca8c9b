"""Progress while the bots are there: one line that changes, or lines now and then."""

import time

from rich.console import Console

from esplanade.bots.tally import Tally
from esplanade.commandline.progress import StatusLine


class Progress(StatusLine):
    """Shows tallies as they come in."""

    def __init__(self, console: Console) -> None:
        super().__init__(console)
        self._began_s = self._then_s = time.monotonic()
        self._bytes_then = 0
        self._bytes_per_s = 0.0

    def show_tally(self, tally: Tally) -> None:
        now_s = time.monotonic()
        self._update_rate(tally, now_s)
        self.show(self._line(tally, now_s))

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
        if tally.snapshots_due:
            share = 100.0 * tally.snapshots_received / tally.snapshots_due
            parts.append(f"{share:.1f} % of snapshots")
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
