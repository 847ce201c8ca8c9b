"""The figures of a run for programs: models, of which `figures.schema.json` is made.

Units are in the names; null stands where nothing was measured. Later versions add fields; what is
here keeps its name and meaning as long as `schema_version` does.
"""

import json
from pathlib import Path
from typing import Any, Final, Literal

from pydantic import BaseModel, ConfigDict, Field

from esplanade.bots.histogram import Histogram
from esplanade.bots.measures import PERCENTILES
from esplanade.bots.series import Series
from esplanade.bots.tally import Tally
from esplanade.bots.thresholds import Verdict

SCHEMA_VERSION: Final = 1


class _Part(BaseModel):
    model_config = ConfigDict(
        frozen=True,
        populate_by_name=True,
        use_attribute_docstrings=True,
        json_schema_serialization_defaults_required=True,
    )


class SpreadFigures(_Part):
    """Percentiles, at most 1 % too great; mean, max and count are exact."""

    p50: float | None
    p90: float | None
    p95: float | None
    p99: float | None
    p99_9: float | None = Field(alias="p99.9")
    mean: float | None
    max: float | None
    count: int

    @classmethod
    def of(cls, histogram: Histogram, factor: float) -> "SpreadFigures":
        """Of values that are multiplied by the factor."""
        percentiles = (_times(histogram.percentile(percent), factor) for percent in PERCENTILES)
        p50, p90, p95, p99, p99_9 = percentiles
        return cls(
            p50=p50,
            p90=p90,
            p95=p95,
            p99=p99,
            p99_9=p99_9,
            mean=_times(histogram.mean, factor),
            max=_times(histogram.highest, factor),
            count=histogram.count,
        )


class Clients(_Part):
    expected: int
    """Visits that were planned."""
    joined: int
    failed: int
    left: int
    lost: int
    seconds: float


class InOut(_Part):
    in_: int = Field(alias="in")
    out: int


class PerClient(_Part):
    """Of a client in a second."""

    messages_in: float | None
    messages_out: float | None
    bytes_in: float | None
    bytes_out: float | None
    cpu_us: float | None


class Snapshots(_Part):
    """Snapshots against the ticks that were due."""

    due: int
    received: int
    missing: int
    late: int
    received_share: float | None


class Pings(_Part):
    sent: int
    unanswered: int


class StepFigures(_Part):
    """Steps of walkers near by."""

    count: int
    bytes: int
    walker_seconds: float
    bytes_per_walker_and_second: float | None


class ReplayFigures(_Part):
    """Only of a replay."""

    skipped: int
    deviation_m: SpreadFigures
    share_within_0_1_m: float
    commands_capped: int


class ThresholdFigures(_Part):
    """A limit of `--fail-if`; the value is in the unit of the limit."""

    limit: str
    value: float | None
    failed: bool


class Moment(_Part):
    """The figures of a stretch of time that begins at `at_s`."""

    at_s: float
    connected: int
    """Clients at the end of the stretch."""
    joined: int
    failed: int
    left: int
    lost: int
    snapshots_due: int
    snapshots_received: int
    age_p50_ms: float | None
    age_p99_ms: float | None
    bytes_in: int
    bytes_out: int
    errors: int


class SeriesFigures(_Part):
    """The course of the run; `width_s` grows with its length."""

    width_s: float
    moments: list[Moment]


class Figures(_Part):
    """Everything that `esplanade bots` has measured in one run."""

    schema_version: Literal[1] = SCHEMA_VERSION
    settings: dict[str, Any] = Field(default_factory=dict)
    clients: Clients
    messages: InOut
    bytes: InOut
    per_client_and_second: PerClient
    snapshots: Snapshots
    pings: Pings
    steps: StepFigures
    join_ms: SpreadFigures
    round_trip_ms: SpreadFigures
    snapshot_age_ms: SpreadFigures
    snapshot_interval_ms: SpreadFigures
    no_path: int
    errors: dict[str, int]
    scenario_faults: dict[str, int]
    replay: ReplayFigures | None = None
    thresholds: list[ThresholdFigures] = []
    warnings: list[str] = []
    exit_code: int = 0
    series: SeriesFigures

    def plain(self) -> dict[str, Any]:
        """The same as JSON has it; without a replay, nothing about one."""
        dropped = {"replay"} if self.replay is None else set()
        return self.model_dump(mode="json", by_alias=True, exclude=dropped)


def figures(tally: Tally, verdicts: "tuple[Verdict, ...]" = (), **more: Any) -> Figures:
    """The figures of a tally; `more` are fields of the run that a tally does not know."""
    seconds = tally.client_seconds
    return Figures(
        clients=Clients(
            expected=tally.expected,
            joined=tally.joined,
            failed=tally.failed,
            left=tally.left,
            lost=tally.lost,
            seconds=seconds,
        ),
        messages=InOut(in_=tally.messages_in, out=tally.messages_out),
        bytes=InOut(in_=tally.bytes_in, out=tally.bytes_out),
        per_client_and_second=PerClient(
            messages_in=_ratio(tally.messages_in, seconds),
            messages_out=_ratio(tally.messages_out, seconds),
            bytes_in=_ratio(tally.bytes_in, seconds),
            bytes_out=_ratio(tally.bytes_out, seconds),
            cpu_us=_ratio(1e6 * tally.cpu_seconds, seconds),
        ),
        snapshots=Snapshots(
            due=tally.snapshots_due,
            received=tally.snapshots_received,
            missing=tally.snapshots_missing,
            late=tally.snapshots_late,
            received_share=_ratio(tally.snapshots_received, tally.snapshots_due),
        ),
        pings=Pings(sent=tally.pings_sent, unanswered=tally.pings_unanswered),
        steps=StepFigures(
            count=tally.steps,
            bytes=tally.step_bytes,
            walker_seconds=round(tally.walker_seconds, 3),
            bytes_per_walker_and_second=_ratio(tally.step_bytes, tally.walker_seconds),
        ),
        join_ms=SpreadFigures.of(tally.join_s, 1e3),
        round_trip_ms=SpreadFigures.of(tally.round_trip_s, 1e3),
        snapshot_age_ms=SpreadFigures.of(tally.snapshot_age_s, 1e3),
        snapshot_interval_ms=SpreadFigures.of(tally.snapshot_interval_s, 1e3),
        no_path=tally.no_path,
        errors=dict(sorted(tally.errors.items())),
        scenario_faults=dict(sorted(tally.scenario_faults.items())),
        replay=_replay(tally),
        thresholds=[
            ThresholdFigures(limit=each.threshold.text, value=each.value, failed=each.failed)
            for each in verdicts
        ],
        series=_series(tally.series),
        **more,
    )


def _replay(tally: Tally) -> ReplayFigures | None:
    if not tally.deviation_m.count:
        return None
    return ReplayFigures(
        skipped=tally.skipped,
        deviation_m=SpreadFigures.of(tally.deviation_m, 1.0),
        share_within_0_1_m=tally.near / tally.deviation_m.count,
        commands_capped=tally.capped,
    )


def _series(series: Series) -> SeriesFigures:
    moments = [
        Moment(
            at_s=place * series.width_s,
            connected=present,
            joined=bucket.joined,
            failed=bucket.failed,
            left=bucket.left,
            lost=bucket.lost,
            snapshots_due=bucket.due,
            snapshots_received=bucket.received,
            age_p50_ms=_times(bucket.age_s(50), 1e3),
            age_p99_ms=_times(bucket.age_s(99), 1e3),
            bytes_in=bucket.bytes_in,
            bytes_out=bucket.bytes_out,
            errors=bucket.errors,
        )
        for place, (bucket, present) in enumerate(
            zip(series.buckets, series.present(), strict=True)
        )
    ]
    return SeriesFigures(width_s=series.width_s, moments=moments)


def _ratio(amount: float, whole: float) -> float | None:
    return amount / whole if whole else None


def _times(value: float | None, factor: float) -> float | None:
    return None if value is None else round(value * factor, 4)


def schema() -> str:
    """The text of `figures.schema.json`."""
    return json.dumps(Figures.model_json_schema(mode="serialization"), indent=1) + "\n"


if __name__ == "__main__":
    Path(__file__).with_name("figures.schema.json").write_text(schema())
