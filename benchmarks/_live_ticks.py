"""A server's ticks between two readings of /metrics: the time of each stage, and percentiles."""

from dataclasses import dataclass
from typing import Final

from chaos.server import Reading, Samples

STAGES: Final = ("drain", "people", "actors", "contacts", "steps", "interest", "encode", "write")
KEPT_TICKS: Final = 1200
"""The server's gauges of percentiles look back over so many ticks."""
_BUCKET: Final = 'esplanade_tick_duration_seconds_bucket{le="'


@dataclass(frozen=True)
class Ticks:
    """The mean tick of a stretch of time, in milliseconds."""

    count: int
    seconds: float
    stages_ms: dict[str, float]
    tick_ms: float
    """From the begin of a tick until its last frame is written, stages and what is between them."""
    p50_ms: float
    p99_ms: float
    late: int
    """Ticks that began late."""
    bytes_out: int
    step_bytes_out: int
    skipped: int
    """Snapshots that were left out because a client was slow."""
    interval_ticks: int
    """The planning interval of actors at the end."""

    @classmethod
    def between(cls, before: Reading, after: Reading) -> "Ticks":
        def grown(name: str) -> float:
            key = f"esplanade_{name}"
            return after.metrics.get(key, 0.0) - before.metrics.get(key, 0.0)

        count = int(grown("ticks_total"))
        stages = {
            name: 1e3 * grown(f'tick_stage_seconds_total{{stage="{name}"}}') / count
            for name in STAGES
        }
        p50_ms, p99_ms = (1e3 * _percentile(before, after, percent, count) for percent in (50, 99))
        return cls(
            count=count,
            seconds=after.at_s - before.at_s,
            stages_ms=stages,
            tick_ms=1e3 * grown("tick_duration_seconds_sum") / count,
            p50_ms=p50_ms,
            p99_ms=p99_ms,
            late=int(grown("ticks_late_total")),
            bytes_out=int(grown("bytes_out_total")),
            step_bytes_out=int(grown("step_bytes_out_total")),
            skipped=int(grown("snapshots_skipped_total")),
            interval_ticks=int(after.metrics["esplanade_planning_interval_ticks"]),
        )


def _percentile(before: Reading, after: Reading, percent: int, count: int) -> float:
    """Seconds; of a stretch that is shorter than the gauge looks back, from the histogram."""
    if count >= KEPT_TICKS:
        return after.metrics[f"esplanade_tick_p{percent}_seconds"]
    return interpolated(_buckets(before.metrics, after.metrics), percent)


def _buckets(before: Samples, after: Samples) -> list[tuple[float, float]]:
    """The upper bounds of the buckets in seconds, and how many ticks were below each."""
    return sorted(
        (float(key.removeprefix(_BUCKET).removesuffix('"}')), after[key] - before.get(key, 0.0))
        for key in after
        if key.startswith(_BUCKET)
    )


def interpolated(buckets: list[tuple[float, float]], percent: float) -> float:
    """A percentile of a histogram of (upper bound, number below it), evenly within a bucket."""
    wanted = buckets[-1][1] * percent / 100.0
    lower, under = 0.0, 0.0
    for upper, below in buckets:
        if below >= wanted:
            if upper == float("inf"):
                return lower
            return lower + (upper - lower) * (wanted - under) / max(below - under, 1e-9)
        lower, under = upper, below
    return lower
