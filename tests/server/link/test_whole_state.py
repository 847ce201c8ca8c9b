"""A gateway that has missed frames comes to know the same as one that has missed none."""

from dataclasses import replace

import msgpack
import numpy as np
import pytest

from esplanade.server.link.frame_format import decode_frame, encode_frame
from esplanade.server.link.whole_state import WholeState
from esplanade.server.world.audience import Audience, News
from esplanade.server.world.frame import Entered, Frame, Line, Reshaped
from tests.server.doubles import ScriptedPopulation
from tests.server.link.test_frame_format import full_frame, inputs_of, same
from tests.server.worlds import FIELD, TICK_S, Trial

MISSED = 90
AFTER = 120


def test_a_whole_state_says_all_that_frames_have_said() -> None:
    state = WholeState()
    first = full_frame()
    state.take(first)
    moved = first.records[:1].copy()
    moved["x"] = 555
    gone = Frame(1201, 2, 1, [7], [], [], [], [], {8: 3}, moved[:0], first.steps[:0], first.events)
    state.take(gone)
    whole = state.whole()
    assert [each.id for each in whole.entered] == [8]
    assert (whole.tick, whole.people, whole.acks) == (1201, 2, {8: 3})
    assert whole.records["id"].tolist() == [8]
    assert whole.steps["id"].tolist() == [8]
    assert (whole.events.plans, whole.attached) == ({}, [])
    assert whole.events.chat == [Line(7, "good morning", 2**52)] * 2  # what has a number
    assert whole.events.pointing == {5: (1.0, 2.5, 0.0)}
    again = WholeState()
    again.take(decode_frame(encode_frame(whole)))
    assert same(again.whole(), whole)


def test_a_whole_state_says_who_is_away() -> None:
    host, gateway = WholeState(), WholeState()
    first = full_frame()
    first = replace(first, events=replace(first.events, away={8: True}))
    for state in (host, gateway):
        state.take(first)
    assert host.whole().events.away == {8: True}
    assert gateway.difference(host.whole()).events.away == {}
    back = replace(first, entered=[], events=replace(first.events, away={8: False}))
    host.take(back)
    assert gateway.difference(host.whole()).events.away == {8: False}


@pytest.mark.parametrize("missed_from", [1, 25, 140])
def test_who_missed_frames_comes_to_know_the_same(missed_from: int) -> None:
    population = ScriptedPopulation(TICK_S)
    for number in range(6):
        population.put(f"actor-{number}", (62.0 + number, 71.0))
    trial = Trial(FIELD, population, max_people=40)
    near = trial.audience
    far = Audience(trial.world.rules, trial.world.origin_m, trial.world.times)
    host, gateway = WholeState(), WholeState()
    clients: dict[int, set[int]] = {}
    for tick in range(missed_from + MISSED + AFTER):
        population.pointed_at = {"actor-1": (1.0, tick, 0.0)} if tick % 60 < 30 else {}
        frame = trial.frame(*inputs_of(trial, tick))
        host.take(frame)
        news = near.take(frame)
        near.wrote(news.snapshots, list(range(len(news.snapshots.viewers))))
        if missed_from <= tick < missed_from + MISSED:
            continue
        if tick == missed_from + MISSED:
            frame = gateway.difference(decode_frame(encode_frame(host.whole())))
            frame = replace(frame, attached=_viewers_missing(near, far))
        gateway.take(frame)
        news = far.take(frame)
        far.wrote(news.snapshots, list(range(len(news.snapshots.viewers))))
        _tell(clients, frame, news)
    assert same(host.whole(), gateway.whole())
    viewers = sorted(_viewers(near))
    assert viewers == sorted(_viewers(far))
    assert len(viewers) > 10
    for viewer in viewers:
        assert _seen(near, viewer) == _seen(far, viewer)
        assert clients[viewer] == _seen(far, viewer).keys()


def test_an_avatar_that_is_somebody_else_leaves_and_enters() -> None:
    state = WholeState()
    frame = replace(full_frame(), left=[], reshaped=[])
    ann, ben = Entered(8, 0, "Ann", (b"a", b"b")), Entered(9, 0, "Ben", (b"a", b"b"))
    thick, thicker = (Reshaped(9, width, 0.9, 1.8, (b"c", b"d")) for width in (0.3, 0.4))
    state.take(replace(frame, entered=[ann, ben], reshaped=[thick]))
    eve = replace(ann, name="Eve")
    whole = replace(frame, entered=[eve, ben], reshaped=[thicker])
    found = state.difference(whole)
    assert (found.left, found.entered, found.reshaped) == ([8], [eve], [thicker])
    thin_again = state.difference(replace(whole, reshaped=[]))
    assert (thin_again.left, thin_again.entered) == ([8, 9], [eve, ben])
    same_again = state.difference(replace(frame, entered=[ann, ben], reshaped=[thick]))
    assert (same_again.left, same_again.entered, same_again.reshaped) == ([], [], [])


def test_who_points_no_more_is_told_of() -> None:
    state = WholeState()
    frame = replace(full_frame(), left=[])
    state.take(frame)
    calm = replace(frame, events=replace(frame.events, pointing={}))
    assert state.difference(calm).events.pointing == {5: None}


def _tell(clients: dict[int, set[int]], frame: Frame, news: News) -> None:
    """Let clients know whom they see, as messages of coming and going tell them."""
    for _, viewer in frame.joined + frame.attached:
        clients[viewer] = set()
    for viewer, ids in news.left.items():
        clients[viewer].difference_update(ids)
    for viewer, packed in news.entered.items():
        came = {msgpack.unpackb(each)["id"] for each in packed}
        assert not came & clients[viewer]
        clients[viewer] |= came


def _viewers(audience: Audience) -> list[int]:
    interest = audience._interest
    return [int(one) for one in interest.ids(interest.viewers())]


def _viewers_missing(near: Audience, far: Audience) -> list[tuple[int, int]]:
    return [(0, one) for one in sorted({*_viewers(near)} - {*_viewers(far)})]


def _seen(audience: Audience, viewer: int) -> dict[int, bytes]:
    avatars = audience._avatars
    found = {}
    for one in avatars.ids[avatars.ids > 0].tolist():
        if audience.sees(viewer, one):
            found[one] = np.asarray(avatars.records[avatars.row(one)]).tobytes()
    return found
