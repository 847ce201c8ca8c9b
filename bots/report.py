"""The report of a run: tables for people, one object for programs."""

from typing import Any, Final

from rich.console import Console
from rich.table import Table

from esplanade.bots.histogram import Histogram
from esplanade.bots.tally import Tally

PERCENTILES: Final = (50, 90, 99)


def figures(tally: Tally) -> dict[str, Any]:
    """Everything that was counted, for JSON. Units are in the names; None where nothing was."""
    seconds = tally.client_seconds
    found: dict[str, Any] = {
        "clients": {
            "expected": tally.expected,
            "joined": tally.joined,
            "failed": tally.failed,
            "left": tally.left,
            "lost": tally.lost,
            "seconds": seconds,
        },
        "messages": {"in": tally.messages_in, "out": tally.messages_out},
        "bytes": {"in": tally.bytes_in, "out": tally.bytes_out},
        "per_client_and_second": {
            "messages_in": tally.messages_in / seconds if seconds else None,
            "messages_out": tally.messages_out / seconds if seconds else None,
            "bytes_in": tally.bytes_in / seconds if seconds else None,
            "bytes_out": tally.bytes_out / seconds if seconds else None,
            "cpu_us": 1e6 * tally.cpu_seconds / seconds if seconds else None,
        },
        "steps": {
            "count": tally.steps,
            "bytes": tally.step_bytes,
            "walker_seconds": round(tally.walker_seconds, 3),
            "bytes_per_walker_and_second": _per_walker(tally),
        },
        "round_trip_ms": _spread(tally.round_trip_s, 1e3),
        "snapshot_age_ms": _spread(tally.snapshot_age_s, 1e3),
        "snapshot_interval_ms": _spread(tally.snapshot_interval_s, 1e3),
        "no_path": tally.no_path,
        "errors": dict(sorted(tally.errors.items())),
    }
    if tally.deviation_m.count:
        found["replay"] = {
            "skipped": tally.skipped,
            "deviation_m": _spread(tally.deviation_m, 1.0),
            "share_within_0_1_m": tally.near / tally.deviation_m.count,
            "commands_capped": tally.capped,
        }
    return found


def show(console: Console, tally: Tally) -> None:
    """The figures as tables."""
    console.print(_counts(tally))
    console.print(_spreads(tally))
    if tally.errors:
        errors = Table("error", "times", title="Errors", title_justify="left")
        for code, times in tally.errors.most_common():
            errors.add_row(code, f"{times:,}")
        console.print(errors)


def _counts(tally: Tally) -> Table:
    table = Table("", "total", "a client a second", title="Traffic", title_justify="left")
    for column in table.columns[1:]:
        column.justify = "right"
    rate = 1.0 / tally.client_seconds if tally.client_seconds else 0.0
    table.add_row("clients joined", f"{tally.joined:,} of {tally.expected:,}", "")
    table.add_row("clients failed", f"{tally.failed:,}", "")
    table.add_row("clients left at their end", f"{tally.left:,}", "")
    table.add_row("clients lost", f"{tally.lost:,}", "")
    if tally.skipped:
        table.add_row("skipped, a single sample", f"{tally.skipped:,}", "")
    for name, amount in (
        ("messages in", tally.messages_in),
        ("messages out", tally.messages_out),
        ("bytes in", tally.bytes_in),
        ("bytes out", tally.bytes_out),
        ("steps seen", tally.steps),
        ("bytes of steps", tally.step_bytes),
    ):
        table.add_row(name, f"{amount:,}", f"{amount * rate:,.1f}")
    per_walker = _per_walker(tally)
    if per_walker is not None:
        table.add_row("bytes of steps a second, for each who walks", "", f"{per_walker:,.1f}")
    cpu_us = 1e6 * tally.cpu_seconds * rate
    table.add_row("processor time of the bots", f"{tally.cpu_seconds:.1f} s", f"{cpu_us:,.0f} µs")
    return table


def _per_walker(tally: Tally) -> float | None:
    """Bytes of steps a second that a client is sent for each avatar that it sees walk."""
    return tally.step_bytes / tally.walker_seconds if tally.walker_seconds else None


def _spreads(tally: Tally) -> Table:
    heads = [*(f"p{percent}" for percent in PERCENTILES), "max"]
    table = Table("", *heads, "count", title="Spread", title_justify="left")
    for column in table.columns[1:]:
        column.justify = "right"
    for name, histogram, factor, unit in (
        ("round trip", tally.round_trip_s, 1e3, "ms"),
        ("age of snapshots", tally.snapshot_age_s, 1e3, "ms"),
        ("between snapshots", tally.snapshot_interval_s, 1e3, "ms"),
        ("off the recorded way", tally.deviation_m, 1.0, "m"),
    ):
        if histogram.count:
            values = [histogram.percentile(percent) for percent in PERCENTILES]
            digits = 3 if unit == "m" else 1
            cells = [
                f"{(value or 0.0) * factor:.{digits}f} {unit}"
                for value in (*values, histogram.greatest)
            ]
            table.add_row(name, *cells, f"{histogram.count:,}")
    if tally.deviation_m.count:
        share = 100.0 * tally.near / tally.deviation_m.count
        table.add_row("of which within 0.1 m", f"{share:.2f} %", "", "", "", f"{tally.near:,}")
    return table


def _spread(histogram: Histogram, factor: float) -> dict[str, float | None]:
    spread = {
        f"p{percent}": _times(histogram.percentile(percent), factor) for percent in PERCENTILES
    }
    return {
        **spread,
        "mean": _times(histogram.mean, factor),
        "max": _times(histogram.greatest if histogram.count else None, factor),
        "count": histogram.count,
    }


def _times(value: float | None, factor: float) -> float | None:
    return None if value is None else round(value * factor, 4)
