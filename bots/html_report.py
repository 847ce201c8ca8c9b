"""The report of a run as one HTML page that needs nothing else: tables and plots."""

from collections.abc import Callable, Sequence
from html import escape
from typing import Any

from esplanade.bots.charts import Chart, Line, draw
from esplanade.bots.figures import Figures, Moment
from esplanade.bots.report import SPREAD_HEADS, count_rows, spread_rows, verdict_row
from esplanade.bots.tally import Tally
from esplanade.bots.thresholds import Verdict
from esplanade.commandline import exit_codes
from esplanade.commandline.html_page import page, table

_OUTCOMES = {
    exit_codes.OK: ("good", "All went well."),
    exit_codes.FAILED: ("bad", "Some bots failed or were complained of."),
    exit_codes.THRESHOLD: ("bad", "A limit was crossed."),
}


def report_page(tally: Tally, verdicts: Sequence[Verdict], found: Figures) -> str:
    """The whole page."""
    mood, outcome = _OUTCOMES[found.exit_code]
    return page(
        f"Load test of {_url(found)}",
        [
            f'<p class="outcome {mood}">{outcome} Exit code {found.exit_code}.</p>',
            *(f'<p class="warning">{escape(line)}</p>' for line in found.warnings),
            *_limits(verdicts),
            '<div class="charts">',
            *(f"<figure>{draw(chart)}</figure>" for chart in charts(found)),
            "</div>",
            table("Spread", ["", *SPREAD_HEADS], spread_rows(tally)),
            '<div class="tables">',
            table("Traffic", ["", "total", "a client a second"], count_rows(tally)),
            *_named("Errors", found.errors),
            *_named("Errors of the scenario", found.scenario_faults),
            table("Settings", ["", ""], _settings(found.settings)),
            "</div>",
        ],
    )


def charts(found: Figures) -> list[Chart]:
    """The plots of the course of the run; rates are those of a second."""
    moments, width_s = found.series.moments, found.series.width_s

    def line(name: str, value: Callable[[Moment], float | None]) -> Line:
        return Line(name, [value(moment) for moment in moments])

    def rate(name: str, value: Callable[[Moment], float]) -> Line:
        return Line(name, [value(moment) / width_s for moment in moments])

    return [
        Chart("Clients in the world", "", [line("connected", lambda m: m.connected)], width_s),
        Chart(
            "Snapshots",
            "/s",
            [
                rate("due", lambda m: m.snapshots_due),
                rate("received", lambda m: m.snapshots_received),
            ],
            width_s,
        ),
        Chart(
            "Age of snapshots, by the time when they were due",
            "ms",
            [line("p50", lambda m: m.age_p50_ms), line("p99", lambda m: m.age_p99_ms)],
            width_s,
            may_be_log=True,
        ),
        Chart(
            "Joins",
            "/s",
            [rate("joined", lambda m: m.joined), rate("failed", lambda m: m.failed)],
            width_s,
        ),
        Chart(
            "Traffic of all clients",
            "kB/s",
            [
                rate("in", lambda m: m.bytes_in / 1e3),
                rate("out", lambda m: m.bytes_out / 1e3),
            ],
            width_s,
        ),
        Chart("Errors", "/s", [rate("errors", lambda m: m.errors)], width_s),
    ]


def _limits(verdicts: Sequence[Verdict]) -> list[str]:
    if not verdicts:
        return []
    return [table("Limits", ["limit", "", "measured"], [verdict_row(each) for each in verdicts])]


def _named(title: str, counts: dict[str, int]) -> list[str]:
    if not counts:
        return []
    rows = sorted(counts.items(), key=lambda item: -item[1])
    return [table(title, ["", "times"], [(name, f"{times:,}") for name, times in rows])]


def _settings(settings: dict[str, Any]) -> list[tuple[str, str]]:
    rows = []
    for name, value in settings.items():
        if value not in (None, [], ()):
            told = ", ".join(map(str, value)) if isinstance(value, list) else str(value)
            rows.append((name, told))
    return rows


def _url(found: Figures) -> str:
    return str(found.settings.get("url", "a world"))
