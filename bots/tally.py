"""A tally holds all counts and measurements of a run, in a size that processes can send."""

import time
from collections import Counter
from collections.abc import Iterable
from copy import copy
from dataclasses import dataclass, field

from esplanade.bots.histogram import Histogram
from esplanade.bots.series import Series


@dataclass
class Tally:
    """The counts of some clients. Times are in seconds, bytes without WebSocket heads."""

    expected: int = 0
    """Clients that are to join in all."""
    joined: int = 0
    failed: int = 0
    """Clients that never joined."""
    left: int = 0
    """Clients that stayed to their end and went."""
    lost: int = 0
    """Clients whose connection ended before they were done."""
    skipped: int = 0
    """Recorded pedestrians with a single sample, who have no trajectory."""

    messages_in: int = 0
    messages_out: int = 0
    bytes_in: int = 0
    bytes_out: int = 0
    steps: int = 0
    """Steps of walkers that the clients were sent."""
    step_bytes: int = 0
    """Bytes of the messages that these came in."""
    walker_seconds: float = 0.0
    """The time that clients saw somebody walk step by step, summed over walkers and clients."""
    client_seconds: float = 0.0
    """Time in the world, summed over clients."""
    cpu_seconds: float = 0.0
    """Processor time of the processes that ran the clients."""

    run_seconds: float = 0.0
    """The length of the run, summed over processes."""

    snapshots_due: int = 0
    """Ticks that passed while clients were in the world, each due to each client."""
    snapshots_received: int = 0
    snapshots_missing: int = 0
    """Snapshots that were due and never came."""
    snapshots_late: int = 0
    """Snapshots that came more than two ticks after they were due."""
    pings_sent: int = 0
    pings_unanswered: int = 0
    """Pings that nothing had answered by the end of their client."""

    errors: Counter[str] = field(default_factory=Counter)
    """Complaints of the server, failed connections and lost ones, counted by code."""

    scenario_faults: Counter[str] = field(default_factory=Counter)
    """Errors in the user's own scenario, by file, line and message."""

    no_path: int = 0
    """Points that no route leads to. To a wanderer this is an answer, not a fault."""

    join_s: Histogram = field(default_factory=Histogram)
    """From the first packet of a connection to the welcome, or to the end of patience."""
    round_trip_s: Histogram = field(default_factory=Histogram)
    """Of pings; those that nothing answered count with the time that they had waited."""
    snapshot_age_s: Histogram = field(default_factory=Histogram)
    """Of every snapshot that was due, see `esplanade.bots.due`."""
    snapshot_interval_s: Histogram = field(default_factory=Histogram)
    deviation_m: Histogram = field(default_factory=Histogram)
    """The deviations of replayed pedestrians from their recorded trajectories."""
    near: int = 0
    """The number of those deviations that were within the promised distance."""
    capped: int = 0
    """Commands of a replay that had to be slower than the recording."""

    series: Series = field(default_factory=Series)

    @property
    def present(self) -> int:
        return self.joined - self.left - self.lost

    @property
    def well(self) -> bool:
        """Whether everybody joined and stayed, without any complaint."""
        return not (self.failed or self.lost or self.errors or self.scenario_faults)

    def complain(self, code: str) -> None:
        """Count an error by its code."""
        self.errors[code] += 1
        self.series.at(time.monotonic()).errors += 1

    def so_far(self) -> "Tally":
        """The same without the series, which is long: for reports while a run goes on."""
        found = copy(self)
        found.series = Series()
        return found

    def merge(self, other: "Tally") -> None:
        """Add everything that the other has counted."""
        for name, value in vars(other).items():
            own = getattr(self, name)
            if isinstance(value, Histogram | Series):
                own.merge(value)
            else:
                setattr(self, name, own + value)


def merged(tallies: Iterable[Tally]) -> Tally:
    """The sum of some tallies."""
    total = Tally()
    for tally in tallies:
        total.merge(tally)
    return total
