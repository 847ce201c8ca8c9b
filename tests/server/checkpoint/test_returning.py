"""Tests which seats are still somebody's after a restart."""

import pytest

from esplanade.server.checkpoint.parts import Parts
from esplanade.server.checkpoint.returning import those_left
from esplanade.server.checkpoint.rows import KeptSeat


def seats(*avatars: int) -> list[KeptSeat]:
    return [KeptSeat(one, f"p{one}", "", (), (0.0, 0.0, 0.0)) for one in avatars]


def test_seats_that_were_given_up_are_gone_though_the_store_has_them() -> None:
    saved = {"given_up": [2], "vacant_s": {3: None, 4: 12.0, 5: 30.0}}
    left = those_left(seats(2, 3, 4, 5, 11), saved, sent_out=set(), resume_s=30.0, most=9)
    assert [(seat.avatar, waited_s) for seat, waited_s in left.waiting] == [
        (4, 12.0), (3, 0.0), (11, 0.0)
    ]  # fmt: skip
    assert left.gone == [2, 5]


def test_those_who_were_sent_out_after_it_are_gone() -> None:
    left = those_left(seats(3, 4), None, sent_out={4}, resume_s=30.0, most=9)
    assert ([seat.avatar for seat, _ in left.waiting], left.gone) == ([3], [4])


def test_of_too_many_those_who_waited_longest_are_gone() -> None:
    saved = {"given_up": [], "vacant_s": {1: 3.0, 2: 9.0, 3: None}}
    left = those_left(seats(1, 2, 3), saved, sent_out=set(), resume_s=30.0, most=2)
    assert ([seat.avatar for seat, _ in left.waiting], left.gone) == ([1, 3], [2])


def test_parts_are_given_back_what_they_saved() -> None:
    given: list[object] = []
    parts = Parts({"a": 1, "c": 3})
    parts.part("a", lambda: 4, given.append)
    parts.part("b", lambda: 5, given.append)
    assert given == [1]
    assert parts.save() == {"a": 4, "b": 5}
    with pytest.raises(ValueError, match="already is a part 'a'"):
        parts.part("a", lambda: 0)
