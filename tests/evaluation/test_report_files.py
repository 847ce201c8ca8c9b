"""Reports as files: what is in them, for people, for papers and for other programs."""

import csv
import math
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from esplanade.evaluation.interval_plot import draw
from esplanade.evaluation.report_files import write
from esplanade.evaluation.tables import Cell, Table
from esplanade.stats import Interval

TABLES = [
    Table(
        "zara_1 & more",
        ("esplanade", "<mine>"),
        (
            ("episodes", (Cell(20, 0), Cell(20, 0))),
            (
                "  greatest acceleration, m/s²",
                (
                    Cell(2.0, 1, Interval(1.5, 2.5)),
                    Cell(math.nan, 1, Interval(math.nan, math.nan)),
                ),
            ),
        ),
    ),
    Table(
        "Differences",
        ("<mine>",),
        (("contacts, %", (Cell(5.0, 1, Interval(1.0, 9.0), differs=True),)),),
    ),
]


class Tags(HTMLParser):
    """The tags of a page, all of which are closed."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.seen: list[str] = []
        self.open: list[str] = []
        self.words: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.seen.append(tag)
        if tag != "meta":
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.seen.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.words.append(data)


def test_csv_has_a_row_for_each_figure(tmp_path: Path) -> None:
    path = tmp_path / "all.csv"
    write(path, TABLES, "esplanade evaluate zara1.csv")
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 5
    assert rows[2] == {
        "table": "zara_1 & more",
        "figure": "greatest acceleration, m/s²",
        "policy": "esplanade",
        "value": "2.0",
        "low": "1.5",
        "high": "2.5",
        "differs": "",
    }
    assert [rows[3][name] for name in ("value", "low", "high")] == ["", "", ""]
    assert (rows[4]["value"], rows[4]["differs"]) == ("5.0", "true")


def test_latex_has_nothing_that_means_something_else_there(tmp_path: Path) -> None:
    path = tmp_path / "all.tex"
    write(path, TABLES, "esplanade evaluate zara1.csv")
    text = path.read_text()
    assert text.startswith("% esplanade evaluate zara1.csv\n")
    assert r"\caption{zara\_1 \& more}" in text
    assert r"\quad greatest acceleration, m/s\textsuperscript{2} & 2.0 (1.5 to 2.5) & –" in text
    assert r"contacts, \% & +5.0 (+1.0 to +9.0)*" in text
    assert text.count(r"\begin{tabular}") == text.count(r"\end{tabular}") == 2


def test_the_page_has_every_table_and_a_plot_of_what_has_an_interval(tmp_path: Path) -> None:
    path = tmp_path / "all.html"
    write(path, TABLES, "esplanade evaluate 'a<b>.csv'")
    tags = Tags(path.read_text())
    assert tags.open == []
    assert tags.seen.count("table") == 2
    assert tags.seen.count("svg") == 2
    assert "esplanade evaluate 'a<b>.csv'" in tags.words
    assert "mine" not in tags.seen
    assert "2.0 (1.5 to 2.5)" in tags.words


def test_points_lie_within_their_intervals_and_these_in_the_plot() -> None:
    cells = (
        Cell(5.0, 1, Interval(1.0, 9.0), differs=True),
        Cell(-2.0, 1, Interval(-3.0, 1.0), differs=False),
        Cell(math.nan, 1, Interval(math.nan, math.nan), differs=False),
    )
    picture = ET.fromstring(draw(("a", "b", "c"), "contacts, %", cells))
    width = float(picture.attrib["viewBox"].split()[2])
    points = [float(each.attrib["cx"]) for each in picture.iter("circle")]
    lines = [
        [float(part.split()[0]) for part in each.attrib["d"][1:].split("H")]
        for each in picture.iter("path")
        if "H" in each.attrib["d"]
    ]
    assert len(points) == len(lines) == 2
    for point, (low, high) in zip(points, lines, strict=True):
        assert 0 < low < point < high < width
    (zero,) = (each for each in picture.iter("path") if "V" in each.attrib["d"])
    assert lines[1][0] < float(zero.attrib["d"][1:].split()[0]) < lines[0][0] + 1.0


@pytest.mark.parametrize("form", ["csv", "tex", "html"])
def test_equal_values_and_unknown_ones_can_be_written(tmp_path: Path, form: str) -> None:
    same = Cell(0.0, 1, Interval(0.0, 0.0), differs=False)
    path = tmp_path / f"all.{form}"
    write(path, [Table("", ("a", "b"), (("x", (same, same)),))], "")
    assert path.stat().st_size > 0
