"""The plots of docs/walking.md: all drawn, named as the page names them, the same each time."""

from pathlib import Path

import pytest

from esplanade.footage.plots import PLOTS

ROOT = Path(__file__).resolve().parents[2]
QUICK = [name for name in PLOTS if name not in {"bends", "stairs", "reaching"}]


@pytest.mark.parametrize("name", QUICK)
def test_plots_are_the_same_each_time(name: str, tmp_path: Path):
    once, again = tmp_path / "once.svg", tmp_path / "again.svg"
    PLOTS[name](once)
    PLOTS[name](again)
    assert once.read_text().startswith("<?xml")
    assert once.read_bytes() == again.read_bytes()


def test_the_page_shows_every_plot():
    page = (ROOT / "docs" / "walking.md").read_text()
    for name in PLOTS:
        assert f"images/walking-{name}.svg" in page
        assert (ROOT / "docs" / "images" / f"walking-{name}.svg").is_file()
