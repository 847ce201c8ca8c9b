"""The files of a report, read again by readers of their kinds."""

import csv
import json
import xml.etree.ElementTree as ET
from collections import Counter
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest

from esplanade import bots
from esplanade.bots.charts import Chart, Line, draw, nice_marks
from esplanade.bots.csv_report import write_csv
from esplanade.bots.figures import SCHEMA_VERSION, Figures, figures
from esplanade.bots.histogram import Histogram
from esplanade.bots.html_report import report_page
from esplanade.bots.series import Series
from esplanade.bots.tally import Tally
from esplanade.bots.thresholds import read_thresholds
from tests.bots.scripted import scripted_server
from tests.bots.test_cli import finish, start

SCHEMA = Path(bots.__file__).parent / "figures.schema.json"
EVIL = "<script>alert('&')</script>"


def eventful() -> Tally:
    """Ten seconds, in the middle of which nothing comes."""
    series = Series(0.0)
    for second in range(10):
        bucket = series.at(float(second))
        bucket.joined = 5 if second == 0 else 0
        bucket.bytes_in, bucket.bytes_out = 1000 * second, 10
        stands_still = 4 <= second < 6
        bucket.received = 0 if stands_still else 100
        bucket.add_age(6.0 - second if stands_still else 0.01, 100)
    return Tally(
        expected=5,
        joined=5,
        left=5,
        client_seconds=50.0,
        errors=Counter({EVIL: 1}),
        snapshot_age_s=Histogram([0.01]),
        series=series,
    )


class Page(HTMLParser):
    """Counts elements, keeps texts, and holds that all are closed in order."""

    def __init__(self) -> None:
        super().__init__()
        self.counts: Counter[str] = Counter()
        self.outside: list[str] = []
        self._open: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.counts[tag] += 1
        self.outside += [value or "" for name, value in attrs if name in {"src", "href"}]
        if tag not in {"meta", "path", "rect", "circle"}:
            self._open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        if tag not in {"path", "rect", "circle"} or self._open[-1:] == [tag]:
            assert self._open.pop() == tag

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.counts[tag] += 1

    def close(self) -> None:
        super().close()
        assert self._open == []


def test_the_page_is_whole_and_stands_alone() -> None:
    tally = eventful()
    verdicts = tuple(each.verdict(tally) for each in read_thresholds("errors>0"))
    found = figures(tally, verdicts, settings={"url": "ws://x"}, warnings=[EVIL], exit_code=3)
    text = report_page(tally, verdicts, found)
    reader = Page()
    reader.feed(text)
    reader.close()
    assert reader.counts["svg"] == 6
    assert reader.counts["script"] == 0
    assert reader.outside == []
    assert "url(" not in text
    assert "A limit was crossed" in text
    assert text.count("&lt;script&gt;") == 2


def test_charts_are_svg_with_every_moment() -> None:
    values = [0.5, None, 4000.0, 7.0, None, 3.0, 2.0]
    svg = draw(Chart("Age <of> snapshots", "ms", [Line("p50", values)], 2.0, may_be_log=True))
    root = ET.fromstring(svg)
    kinds = Counter(element.tag for element in root)
    assert kinds["rect"] == len(values)
    assert kinds["circle"] == 1  # a moment between two gaps
    assert len(root.findall("path[@class='line c0']")) == 2
    for text in root.findall("text"):
        assert 0.0 <= float(text.get("x", "")) <= 640.0
        assert 0.0 <= float(text.get("y", "")) <= 240.0


@pytest.mark.parametrize("values", [[], [None], [0.0], [0.0, 0.0], [1e-9], [5.0, 1e9]])
def test_charts_of_odd_values_are_charts(values: list[float | None]) -> None:
    ET.fromstring(draw(Chart("A", "", [Line("a", values)], 1.0, may_be_log=True)))


@pytest.mark.parametrize(
    ("most", "marks"),
    [
        (0.0, [0, 1]),
        (1.0, [0, 0.25, 0.5, 0.75, 1.0]),
        (20.0, [0, 5, 10, 15, 20]),
        (370.0, [0, 100, 200, 300, 400]),
    ],
)
def test_marks_are_round(most: float, marks: list[float]) -> None:
    assert nice_marks(most) == pytest.approx(marks)


def test_csv_has_a_line_for_each_second(tmp_path: Path) -> None:
    path = tmp_path / "load.csv"
    write_csv(path, figures(eventful()).series)
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["at_s"]) for row in rows] == list(range(10))
    assert {row["connected"] for row in rows} == {"5"}
    assert [int(row["snapshots_received"]) for row in rows[3:7]] == [100, 0, 0, 100]
    assert float(rows[4]["age_p99_ms"]) == pytest.approx(2000.0, rel=0.05)


def test_the_schema_that_is_shipped_is_that_of_the_figures() -> None:
    """`python -m esplanade.bots.figures` writes it."""
    assert json.loads(SCHEMA.read_text()) == Figures.model_json_schema(mode="serialization")
    assert json.loads(SCHEMA.read_text())["properties"]["schema_version"]["const"] == SCHEMA_VERSION


def keys(value: Any) -> Any:
    return {name: keys(part) for name, part in value.items()} if isinstance(value, dict) else None


def test_keys_of_before_are_there_still() -> None:
    """Scripts rely on them."""
    found = figures(Tally()).plain()
    spread = {"p50", "p90", "p99", "mean", "max", "count"}
    for name in ("round_trip_ms", "snapshot_age_ms", "snapshot_interval_ms"):
        assert spread <= found[name].keys()
    assert found["clients"].keys() == {"expected", "joined", "failed", "left", "lost", "seconds"}
    assert found["messages"].keys() == found["bytes"].keys() == {"in", "out"}
    assert found["per_client_and_second"].keys() == {
        *("messages_in", "messages_out", "bytes_in", "bytes_out", "cpu_us")
    }
    assert found["steps"].keys() == {
        *("count", "bytes", "walker_seconds", "bytes_per_walker_and_second")
    }
    assert {"no_path", "errors"} <= found.keys()


async def test_the_command_writes_them_all(tmp_path: Path) -> None:
    names = {kind: tmp_path / f"load.{kind}" for kind in ("json", "csv", "html")}
    files = [word for kind, path in names.items() for word in (f"--{kind}", str(path))]
    async with scripted_server() as server:
        process = await start(
            *("--url", server.url, "--count", "4", "--duration", "2", "--processes", "2"),
            *("--fail-if", "snapshot_age.p99>100s", *files),
        )
        code, _, err = await finish(process)
    assert code == 0, err
    found = json.loads(names["json"].read_text())
    read = Figures.model_validate(found)
    assert read.plain() == found
    assert found["schema_version"] == SCHEMA_VERSION
    assert found["settings"]["fail_if"] == ["snapshot_age.p99>100s"]
    assert [limit["failed"] for limit in found["thresholds"]] == [False]
    moments = found["series"]["moments"]
    assert sum(moment["joined"] for moment in moments) == 4
    assert sum(moment["snapshots_received"] for moment in moments) == found["snapshots"]["received"]
    assert sum(moment["snapshots_due"] for moment in moments) == found["snapshots"]["due"]
    assert sum(moment["bytes_in"] for moment in moments) == found["bytes"]["in"]
    assert max(moment["connected"] for moment in moments) == 4
    assert moments[-1]["connected"] == 0
    with names["csv"].open(newline="") as file:
        assert len(list(csv.reader(file))) == len(moments) + 1
    reader = Page()
    reader.feed(names["html"].read_text(encoding="utf-8"))
    reader.close()
    assert reader.counts["svg"] == 6
