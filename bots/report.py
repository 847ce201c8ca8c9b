"""The report of a run for people, as tables."""

from rich.console import Console
from rich.table import Table

from esplanade.bots.measures import PERCENTILES, SPREADS
from esplanade.bots.tally import Tally
from esplanade.bots.thresholds import Verdict, told


def show(console: Console, tally: Tally, verdicts: tuple[Verdict, ...] = ()) -> None:
    """The figures as tables."""
    console.print(_counts(tally))
    console.print(_spreads(tally))
    for title, head, found in (
        ("Errors", "error", tally.errors),
        ("Errors of the scenario", "where", tally.scenario_faults),
    ):
        if found:
            errors = Table(head, "times", title=title, title_justify="left")
            for code, times in found.most_common():
                errors.add_row(code, f"{times:,}")
            console.print(errors)
    if verdicts:
        table = Table("limit", "", "measured", title="Limits", title_justify="left")
        for each in verdicts:
            table.add_row(*verdict_row(each))
        console.print(table)


def verdict_row(verdict: Verdict) -> tuple[str, str, str]:
    """The limit, whether it was kept, and what was measured."""
    value, unit = verdict.value, verdict.threshold.unit
    measured = "nothing" if value is None else f"{told(value)} {unit}".strip()
    return verdict.threshold.text, "crossed" if verdict.failed else "kept", measured


def spread_rows(tally: Tally) -> list[tuple[str, ...]]:
    """Each spread that was measured: its name, the percentiles, the greatest value, the count."""
    rows = []
    for spread in SPREADS.values():
        histogram = spread.histogram(tally)
        if not histogram.count:
            continue
        values = (*(histogram.percentile(each) for each in PERCENTILES), histogram.highest)
        if spread.replay_only:
            name, cells = f"{spread.title}, m", [f"{value or 0.0:.3f}" for value in values]
        else:
            name, cells = f"{spread.title}, ms", [f"{(value or 0) * 1e3:,.1f}" for value in values]
        rows.append((name, *cells, f"{histogram.count:,}"))
    return rows


SPREAD_HEADS = [*(f"p{percent:g}" for percent in PERCENTILES), "max", "count"]


def count_rows(tally: Tally) -> list[tuple[str, str, str]]:
    """Rows of counts: a name, the sum, and the share or the rate that belongs to it."""
    rate = 1.0 / tally.client_seconds if tally.client_seconds else 0.0
    rows = [
        ("clients joined", f"{tally.joined:,} of {tally.expected:,}", ""),
        ("clients failed", f"{tally.failed:,}", ""),
        ("clients left at their end", f"{tally.left:,}", ""),
        ("clients lost", f"{tally.lost:,}", ""),
    ]
    if tally.skipped:
        rows.append(("skipped, a single sample", f"{tally.skipped:,}", ""))
    due = tally.snapshots_due
    rows += [
        ("snapshots due", f"{due:,}", f"{due * rate:,.1f}"),
        *(
            (f"snapshots {name}", f"{amount:,} = {_percent(amount, due)}", f"{amount * rate:,.1f}")
            for name, amount in (
                ("received", tally.snapshots_received),
                ("missing", tally.snapshots_missing),
                ("late", tally.snapshots_late),
            )
        ),
        ("pings unanswered", f"{tally.pings_unanswered:,} of {tally.pings_sent:,}", ""),
        *(
            (name, f"{amount:,}", f"{amount * rate:,.1f}")
            for name, amount in (
                ("messages in", tally.messages_in),
                ("messages out", tally.messages_out),
                ("bytes in", tally.bytes_in),
                ("bytes out", tally.bytes_out),
                ("steps seen", tally.steps),
                ("bytes of steps", tally.step_bytes),
            )
        ),
    ]
    if tally.walker_seconds:
        per_walker = tally.step_bytes / tally.walker_seconds
        rows.append(("bytes of steps a second, for each who walks", "", f"{per_walker:,.1f}"))
    cpu_us = 1e6 * tally.cpu_seconds * rate
    rows.append(("processor time of the bots", f"{tally.cpu_seconds:.1f} s", f"{cpu_us:,.0f} µs"))
    return rows


def _counts(tally: Tally) -> Table:
    table = Table("", "total", "a client a second", title="Traffic", title_justify="left")
    for column in table.columns[1:]:
        column.justify = "right"
    for row in count_rows(tally):
        table.add_row(*row)
    return table


def _percent(part: float, whole: float, digits: int = 1) -> str:
    return f"{100.0 * part / whole:.{digits}f} %" if whole else "–"


def _spreads(tally: Tally) -> Table:
    table = Table("", *SPREAD_HEADS, title="Spread", title_justify="left")
    for column in table.columns[1:]:
        column.justify = "right"
    for row in spread_rows(tally):
        table.add_row(*row)
    if tally.deviation_m.count:
        share = _percent(tally.near, tally.deviation_m.count, 2)
        table.add_row("of which within 0.1 m", share, *[""] * 5, f"{tally.near:,}")
    return table
