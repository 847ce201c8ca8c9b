"""Each rule of a cluster by itself: ownerships, frames, occupations and hops."""

import hypothesis.strategies as st
import pytest
from hypothesis import given

from esplanade.server.cluster.frame_gate import FrameGate, Verdict
from esplanade.server.cluster.hops import KEPT_S, Hop, KeptPlaces, Stage
from esplanade.server.cluster.occupations import SILENCE_S, Occupations
from esplanade.server.cluster.tenure import Claim, Tenure

frames = st.tuples(st.booleans(), st.integers(1, 3), st.integers(0, 6))
"""Whether it is the whole state, its epoch, and its tick."""


def test_a_host_acts_until_it_knows_better() -> None:
    def tenure() -> Tenure:
        return Tenure(Claim("hall", "ash", 7))

    kept = tenure()
    kept.renewed(True)
    kept.heard(6)
    kept.heard(7)
    assert kept.holds
    refused, outrun, released = tenure(), tenure(), tenure()
    refused.renewed(False)
    refused.renewed(True)  # the answer to an older renewal comes late
    outrun.heard(8)
    outrun.heard(7)
    released.release()
    assert [each.holds for each in (refused, outrun, released)] == [False] * 3


@given(st.lists(frames, max_size=40))
def test_a_gateway_applies_frames_without_a_gap_and_never_goes_back(
    told: list[tuple[bool, int, int]],
) -> None:
    gate, applied = FrameGate(), (0, -1)
    for whole, epoch, tick in told:
        verdict = gate.whole(epoch, tick) if whole else gate.judge(epoch, tick)
        if verdict is Verdict.APPLY:
            assert (epoch, tick) >= applied
            assert whole or (epoch, tick - 1) == applied
            applied = (epoch, tick)
        if verdict is Verdict.DROP:
            assert (epoch, tick) <= applied or epoch < gate.epoch or whole
        assert gate.epoch >= applied[0]


def test_a_gap_costs_the_whole_state() -> None:
    gate = FrameGate()
    assert gate.judge(5, 10) is Verdict.RESYNC
    assert gate.whole(5, 11) is Verdict.APPLY
    assert gate.judge(5, 11) is Verdict.DROP
    assert gate.judge(5, 12) is Verdict.APPLY
    assert gate.judge(5, 14) is Verdict.RESYNC
    assert gate.judge(5, 13) is Verdict.RESYNC
    assert gate.whole(5, 11) is Verdict.DROP
    assert gate.whole(5, 15) is Verdict.APPLY
    gate.lost()
    assert gate.judge(5, 16) is Verdict.RESYNC
    assert gate.judge(6, 1) is Verdict.RESYNC
    assert gate.whole(5, 17) is Verdict.DROP
    assert gate.whole(6, 2) is Verdict.APPLY


def test_only_the_newest_client_steers() -> None:
    held = Occupations()
    held.restore(1, 4, None, 0.0)
    assert not held.attach(1, 3, "east", 0.0)
    assert not held.may_steer(1, 4)
    assert held.attach(1, 5, "west", 0.0)
    assert held.attach(1, 5, "west", 0.0)
    assert not held.attach(1, 5, "east", 0.0)
    assert held.may_steer(1, 5)
    assert not held.may_steer(1, 4)
    assert not held.detach(1, 4)
    assert held.detach(1, 5)
    assert not held.may_steer(1, 5)
    held.restore(1, 5, "west", 0.0)
    assert not held.may_steer(1, 5)


def test_a_silent_gateway_loses_whom_it_serves() -> None:
    held = Occupations()
    held.attach(1, 1, "east", 0.0)
    held.attach(2, 1, "east", 0.0)
    assert held.present("east", {1: 1, 2: 2, 3: 1}, 1.0) == []
    assert held.present("west", {2: 1}, 1.0) == []
    assert held.silent(SILENCE_S) == {}
    assert held.silent(SILENCE_S + 0.1) == {2: 1}
    assert held.silent(SILENCE_S + 0.1) == {}
    assert not held.may_steer(2, 1)
    assert held.may_steer(1, 1)
    assert 3 not in held
    assert held.present("west", {1: 1, 2: 2}, 3.0) == []
    assert held.present("east", {1: 1, 2: 1}, 3.0) == [2]
    assert held.may_steer(2, 1)
    assert held.silent(3.0 + SILENCE_S) == {}


def test_a_hop_is_done_when_the_seat_has_moved() -> None:
    hop = Hop(1, 3, 0.0)
    assert hop.is_shown
    assert not hop.answered(2, kept=True)
    assert hop.answered(3, kept=True)
    assert not hop.answered(3, kept=True)
    assert not hop.is_shown
    hop.moved(is_here=None)
    assert not hop.given_up(2 * KEPT_S)
    assert hop.stage is Stage.MOVING
    hop.moved(is_here=False)
    assert hop.stage is Stage.GONE
    hop.moved(is_here=True)
    assert hop.stage is Stage.GONE


@pytest.mark.parametrize("answered", [True, False], ids=["refused", "unanswered"])
def test_a_person_stays_where_there_is_no_room(answered: bool) -> None:
    hop = Hop(1, 0, 10.0)
    if answered:
        assert not hop.answered(0, kept=False)
    else:
        assert not hop.given_up(10.0 + KEPT_S - 0.1)
        assert hop.given_up(10.0 + KEPT_S)
    assert hop.stage is Stage.STAYED
    assert hop.is_shown
    assert not hop.answered(0, kept=True)
    hop.moved(is_here=False)
    assert hop.stage is Stage.STAYED


def test_places_are_kept_for_a_while_and_within_a_bound() -> None:
    places = KeptPlaces(most=2)
    assert not places.keep(1, 0, room=0, now_s=0.0)
    assert places.keep(1, 5, room=1, now_s=0.0)
    assert not places.keep(2, 0, room=1, now_s=0.0)
    assert places.keep(1, 5, room=1, now_s=1.0)
    assert not places.keep(1, 4, room=9, now_s=1.0)
    assert places.keep(2, 0, room=9, now_s=1.0)
    assert not places.keep(3, 0, room=9, now_s=1.0)
    places.taken(2)
    assert len(places) == 1
    assert places.keep(3, 0, room=9, now_s=1.0)
    assert places.keep(4, 0, room=9, now_s=1.0 + KEPT_S)
    assert len(places) == 1
