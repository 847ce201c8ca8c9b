"""The figures of one scenario, as its clients and its server showed them."""

from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np
from benchmarks._live_swarm import Count
from benchmarks._live_ticks import Ticks


@dataclass
class Seen:
    """The figures of one scenario; what does not apply is None or empty."""

    name: str
    people: int
    actors: int = 0
    ticks: Ticks | None = None
    load: tuple[float, float] = (0.0, 0.0)
    """The machine's load average before and after."""
    client_ticks: float = 0.0
    processor_us: float = 0.0
    """Of the server for each client and tick."""
    main_thread_us: float = 0.0
    """The same of the thread with the event loop alone: without planning of actors."""
    bytes_per_s: float = 0.0
    """Of a viewer."""
    bytes_a_client_tick: float = 0.0
    sent_per_s: float = 0.0
    """Messages of a client."""
    snapshots_per_s: list[float] = field(default_factory=list)
    """Of the client that gets fewest, and of the middle one."""
    memory_kb: float | None = None
    """Of the server for each client."""
    join_ms: list[float] = field(default_factory=list)
    """p50 and p99 of the time from TCP to welcome."""
    lost: int = 0
    bots: dict[str, Any] | None = None
    """The figures of `esplanade bots`."""

    def plain(self) -> dict[str, Any]:
        return asdict(self)

    def take(self, count: Count, join_s: list[float]) -> None:
        """Note what came to the walkers, and the times that they took to come in."""
        per_s = np.array(count.snapshots) / count.seconds
        self.client_ticks = float(sum(count.snapshots))
        self.bytes_per_s = count.bytes_in / count.seconds / len(per_s)
        self.bytes_a_client_tick = count.bytes_in / max(sum(count.snapshots), 1)
        self.sent_per_s = count.sent / count.seconds / len(per_s)
        self.snapshots_per_s = [float(per_s.min()), float(np.median(per_s))]
        self.join_ms = (1e3 * np.percentile(join_s, (50, 99))).tolist()
        self.lost = count.lost

    def share(self) -> None:
        """Divide the processor time of the whole stretch by the client-ticks in it."""
        self.processor_us /= max(self.client_ticks, 1.0)
        self.main_thread_us /= max(self.client_ticks, 1.0)
