"""The measures of a run, by the names that thresholds and reports use.

`--help` lists them (`esplanade.bots.options`), and a test holds the two together.
"""

from collections.abc import Callable, Mapping
from typing import Final, NamedTuple

from esplanade.bots.histogram import Histogram
from esplanade.bots.tally import Tally

PERCENTILES: Final = (50.0, 90.0, 95.0, 99.0, 99.9)

TIMES: Final = {"us": 1e-6, "µs": 1e-6, "ms": 1e-3, "s": 1.0}
LENGTHS: Final = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}
RATES: Final = {"B/s": 1.0, "kB/s": 1e3, "MB/s": 1e6}


class Spread(NamedTuple):
    """Many values, of which percentiles are told; `units` has the size of each."""

    title: str
    histogram: Callable[[Tally], Histogram]
    units: Mapping[str, float]
    replay_only: bool = False


class Amount(NamedTuple):
    """One number; with `whole`, it can also be told as a share of that."""

    value: Callable[[Tally], float]
    whole: Callable[[Tally], float] | None = None
    units: Mapping[str, float] | None = None


SPREADS: Final = {
    "join": Spread("join", lambda tally: tally.join_s, TIMES),
    "round_trip": Spread("round trip", lambda tally: tally.round_trip_s, TIMES),
    "snapshot_age": Spread("age of snapshots", lambda tally: tally.snapshot_age_s, TIMES),
    "snapshot_interval": Spread(
        "between snapshots", lambda tally: tally.snapshot_interval_s, TIMES
    ),
    "deviation": Spread(
        "off the recorded way", lambda tally: tally.deviation_m, LENGTHS, replay_only=True
    ),
}

AMOUNTS: Final = {
    "clients.joined": Amount(lambda tally: tally.joined, lambda tally: tally.expected),
    "clients.failed": Amount(lambda tally: tally.failed, lambda tally: tally.expected),
    "clients.lost": Amount(lambda tally: tally.lost, lambda tally: tally.joined),
    "snapshots.received": Amount(
        lambda tally: tally.snapshots_received, lambda tally: tally.snapshots_due
    ),
    "snapshots.missing": Amount(
        lambda tally: tally.snapshots_missing, lambda tally: tally.snapshots_due
    ),
    "snapshots.late": Amount(lambda tally: tally.snapshots_late, lambda tally: tally.snapshots_due),
    "pings.unanswered": Amount(
        lambda tally: tally.pings_unanswered, lambda tally: tally.pings_sent
    ),
    "errors": Amount(lambda tally: tally.errors.total()),
    "bytes.in": Amount(lambda tally: _a_second(tally.bytes_in, tally), None, RATES),
    "bytes.out": Amount(lambda tally: _a_second(tally.bytes_out, tally), None, RATES),
}


def _a_second(amount: float, tally: Tally) -> float:
    return amount / tally.client_seconds if tally.client_seconds else 0.0
