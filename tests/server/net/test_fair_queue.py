"""Addresses take turns, and so do the people of one address."""

from hypothesis import given
from hypothesis import strategies as st

from esplanade.server.net.fair_queue import Asker, FairQueue


def order(queue: FairQueue[str]) -> list[str]:
    out = []
    while (turn := queue.pop()) is not None:
        out.append(turn[1])
    return out


def test_many_of_one_address_wait_behind_one_of_another() -> None:
    queue: FairQueue[str] = FairQueue()
    for k in range(30):
        queue.put(Asker("crowd", k), f"crowd {k}")
    queue.put(Asker("one", 99), "one")
    assert order(queue)[:3] == ["crowd 0", "one", "crowd 1"]


def test_the_latest_thing_of_a_person_keeps_the_place_of_the_first() -> None:
    queue: FairQueue[str] = FairQueue()
    for k in (1, 2, 1):
        queue.put(Asker("a", k), f"{k} of {len(queue)}")
    assert order(queue) == ["1 of 2", "2 of 1"]


def test_addresses_that_are_busy_are_passed_over() -> None:
    queue: FairQueue[str] = FairQueue()
    queue.put(Asker("a", 1), "a")
    queue.put(Asker("b", 2), "b")
    assert queue.pop(but_for={"a"}) == (Asker("b", 2), "b")
    assert queue.pop(but_for={"a"}) is None
    assert len(queue) == 1


def test_a_person_who_comes_back_from_elsewhere_waits_once() -> None:
    queue: FairQueue[str] = FairQueue()
    queue.put(Asker("a", 1), "before")
    queue.put(Asker("b", 1), "after")
    assert order(queue) == ["after"]


@given(st.lists(st.tuples(st.sampled_from("abc"), st.integers(0, 4), st.booleans())))
def test_nothing_is_lost_and_nothing_stays(acts: list[tuple[str, int, bool]]) -> None:
    queue: FairQueue[str] = FairQueue()
    waiting: dict[int, str] = {}
    for n, (address, avatar_id, put) in enumerate(acts):
        if put:
            queue.put(Asker(address, avatar_id), str(n))
            waiting[avatar_id] = str(n)
        else:
            queue.discard(avatar_id)
            waiting.pop(avatar_id, None)
        assert len(queue) == len(waiting)
    assert sorted(order(queue)) == sorted(waiting.values())
    assert len(queue) == 0
