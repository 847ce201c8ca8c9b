"""Rules of chat: words, areas, and the same again from plain data."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import Point, Polygon

from esplanade.server.moderation.areas import Area, same_storey
from esplanade.server.moderation.chat_rules import ChatRules
from esplanade.server.moderation.words import WordFilter

STOREYS = (0.0, 3.5, 7.0)


def test_rules_come_back_from_plain_data() -> None:
    rules = ChatRules()
    values = {
        "slow_mode": 5.0,
        "word_filter": {"words": ["darn"], "action": "refuse"},
        "quiet_zone:hall": {"polygon": [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0]], "storey_m": 3.5},
    }
    for name, value in values.items():
        rules = rules.with_rule(name, json.loads(json.dumps(value)))
        assert rules.rule(name) == value
    assert rules.quiet_at((1.5, 1.0, 3.5), STOREYS) == "hall"
    assert rules.quiet_at((1.5, 1.0, 0.0), STOREYS) is None
    for name in values:
        rules = rules.with_rule(name, None)
        assert rules.rule(name) is None
    assert rules.quiet_at((1.5, 1.0, 3.5), STOREYS) is None


@pytest.mark.parametrize(
    ("z_m", "storey_m", "same"),
    [(0.0, 0.0, True), (3.2, 3.5, True), (2.0, 0.0, True), (2.0, 3.5, False), (-1.0, 0.0, True),
     (9.0, 7.0, True), (6.9, 7.2, True)],
)  # fmt: skip
def test_storeys(z_m: float, storey_m: float, same: bool) -> None:
    assert same_storey(z_m, storey_m, STOREYS) is same


_corners = st.lists(st.tuples(st.floats(-9, 9), st.floats(-9, 9)), min_size=3, max_size=8)


@given(_corners, st.floats(-9, 9), st.floats(-9, 9))
def test_an_area_holds_what_shapely_says(
    corners: list[tuple[float, float]], x: float, y: float
) -> None:
    polygon = Polygon(corners)
    if not polygon.is_valid or polygon.boundary.distance(Point(x, y)) < 1e-6:
        return
    assert Area(tuple(corners), None).holds((x, y, 0.0), STOREYS) is polygon.contains(Point(x, y))


@pytest.mark.parametrize(
    ("text", "seen"),
    [
        ("Darn", "•••"),
        ("oh DARN, dаrn", "oh •••, •••"),  # the last with a Cyrillic letter
        ("darning", "darning"),
        ("", ""),
    ],
)
def test_words(text: str, seen: str) -> None:
    assert WordFilter(["darn"]).masked(text) == seen
