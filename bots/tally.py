"""Everything that a run counts and measures, small enough to be sent between processes."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field

from esplanade.bots.histogram import Histogram


@dataclass
class Tally:
    """What happened to some clients. Times in seconds, bytes of payload without WebSocket heads."""

    expected: int = 0
    """Clients that are to join in all."""
    joined: int = 0
    failed: int = 0
    """Clients that never came in."""
    left: int = 0
    """Clients that stayed to their end and went."""
    lost: int = 0
    """Clients whose connection ended before they were done."""
    skipped: int = 0
    """Recorded pedestrians without a way: a single sample."""

    messages_in: int = 0
    messages_out: int = 0
    bytes_in: int = 0
    bytes_out: int = 0
    steps: int = 0
    """Steps of walkers that the clients were sent."""
    step_bytes: int = 0
    """Bytes of the messages that these came in."""
    walker_seconds: float = 0.0
    """Time for which clients saw somebody walk step by step, summed over walkers and clients."""
    client_seconds: float = 0.0
    """Time in the world, summed over clients."""
    cpu_seconds: float = 0.0
    """Processor time of the processes that ran the clients."""

    errors: Counter[str] = field(default_factory=Counter)
    """By code: what the server complained of, how connections failed or ended."""

    no_path: int = 0
    """Points that no way leads to: an answer to a wanderer, not a fault."""

    round_trip_s: Histogram = field(default_factory=Histogram)
    snapshot_age_s: Histogram = field(default_factory=Histogram)
    snapshot_interval_s: Histogram = field(default_factory=Histogram)
    deviation_m: Histogram = field(default_factory=Histogram)
    """Of replayed pedestrians from their recorded way."""
    near: int = 0
    """Of those deviations, how many were within the promised distance."""
    capped: int = 0
    """Commands of a replay that had to be slower than the recording."""

    @property
    def present(self) -> int:
        return self.joined - self.left - self.lost

    @property
    def well(self) -> bool:
        """Whether everybody came in, stayed, and nothing was complained of."""
        return not (self.failed or self.lost or self.errors)

    def merge(self, other: "Tally") -> None:
        """Take in everything that the other has counted."""
        for name, value in vars(other).items():
            own = getattr(self, name)
            if isinstance(value, Histogram):
                own.merge(value)
            else:
                setattr(self, name, own + value)


def merged(tallies: Iterable[Tally]) -> Tally:
    """The sum of some tallies."""
    total = Tally()
    for tally in tallies:
        total.merge(tally)
    return total
