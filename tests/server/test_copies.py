"""Copies of a zone: which one somebody enters, and which ones are to be open."""

import pytest

from esplanade.server.copies import Copies

HALLS = Copies(("hall", "hall-2", "hall-3"), most_people=10)


@pytest.mark.parametrize(
    ("people", "wished", "entered"),
    [
        ({"hall": 0, "hall-2": 0}, None, "hall"),
        ({"hall": 2, "hall-2": 7}, None, "hall-2"),
        ({"hall": 2, "hall-2": 8}, None, "hall"),
        ({"hall": 9, "hall-2": 8}, None, "hall-2"),
        ({"hall": 10, "hall-2": 9}, None, "hall-2"),
        ({"hall": 10, "hall-2": 10}, None, None),
        ({"hall": 8}, None, "hall"),
        ({"hall": 2, "hall-2": 7}, "hall", "hall"),
        ({"hall": 9, "hall-2": 7}, "hall", "hall"),
        ({"hall": 10, "hall-2": 7}, "hall", "hall-2"),
        ({"hall": 2, "hall-2": 7}, "hall-3", "hall-2"),
        ({"hall": 2, "moon": 1}, "moon", "hall"),
    ],
)
def test_a_newcomer_enters_the_fullest_that_is_not_full_enough(
    people: dict[str, int], wished: str | None, entered: str | None
) -> None:
    assert HALLS.entered(people, wished) == entered


@pytest.mark.parametrize(
    ("people", "wanted"),
    [
        ({}, {"hall"}),
        ({"hall": 7}, {"hall"}),
        ({"hall": 8}, {"hall", "hall-2"}),
        ({"hall": 8, "hall-2": 3}, {"hall", "hall-2"}),
        ({"hall": 8, "hall-2": 8}, {"hall", "hall-2", "hall-3"}),
        ({"hall": 10, "hall-2": 10, "hall-3": 10}, {"hall", "hall-2", "hall-3"}),
        ({"hall-3": 1}, {"hall", "hall-3"}),
        ({"hall": 9, "hall-3": 9}, {"hall", "hall-2", "hall-3"}),
    ],
)
def test_one_more_copy_is_open_where_all_others_are_full_enough(
    people: dict[str, int], wanted: set[str]
) -> None:
    assert HALLS.wanted(people) == wanted
