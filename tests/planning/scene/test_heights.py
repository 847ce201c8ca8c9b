"""One table of heights, here and in the browser's client."""

import re
from pathlib import Path

import pytest

from esplanade.planning.scene import heights

TYPESCRIPT = Path(__file__).resolve().parents[3] / "client_web" / "src" / "world" / "heights.ts"
SHARED = ("BODIES_OVERLAP_M", "SAME_FLOOR_M", "STOREYS_APART_M")


def typescript_heights() -> dict[str, float]:
    """Every `export const NAME = 1.8;`, where a name may stand for one further up."""
    known: dict[str, float] = {}
    for name, value in re.findall(r"export const (\w+) = ([\w.]+);", TYPESCRIPT.read_text()):
        known[name] = known[value] if value in known else float(value)
    return known


def test_the_browser_has_the_heights_that_it_shares_and_no_others() -> None:
    assert set(typescript_heights()) == set(SHARED)


@pytest.mark.parametrize("name", SHARED)
def test_the_browser_has_the_same_height(name: str) -> None:
    assert typescript_heights()[name] == getattr(heights, name)
