"""A frame over a network says what it says in one process."""

from contextlib import suppress
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import hypothesis.strategies as st
import msgpack
import numpy as np
import pytest
from hypothesis import given

from esplanade.protocol.looks import Look
from esplanade.protocol.snapshot import RECORD
from esplanade.protocol.steps import new_step_records
from esplanade.server.link.frame_format import decode_frame, encode_frame
from esplanade.server.link.frame_parts import FrameError
from esplanade.server.world.audience import Audience, News
from esplanade.server.world.frame import Entered, Events, Frame, Line, Reshaped
from esplanade.server.world.inputs import Attach, Detach, Input, Join, Leave, MoveDoor, Say, Steer
from esplanade.server.world.outcomes import Fault, FaultCode, Outcome
from esplanade.server.world.state import PERSON
from tests.server.doubles import ScriptedPopulation
from tests.server.worlds import FIELD, TICK_S, Trial

GOLDEN = Path(__file__).with_name("golden_frame.hex")
TICKS = 600
PEOPLE = 40


def full_frame() -> Frame:
    """A frame with something in each of its fields."""
    records = np.zeros(2, dtype=RECORD)
    records["id"], records["x"], records["heading"] = [7, 8], [100, 65535], [1, 255]
    steps = new_step_records(1)
    steps["id"], steps["tick"] = 8, 1200
    fault = Fault(FaultCode.VALUES, "too fast", {"faults": [{"name": "speed", "most": 2.5}]})
    return Frame(
        tick=1200,
        people=3,
        actors=1,
        left=[2, 3],
        entered=[Entered(8, 0, "Ann ✓", (b"\x81\x01", b""))],
        joined=[(41, 8)],
        attached=[(42, 7)],
        detached=[6],
        acks={7: 99, 8: 0},
        records=records,
        steps=steps,
        events=Events(
            doors={"gate": True},
            pointing={5: (1.0, 2.5, 0.0), 6: None},
            chat=[Line(7, "good morning", 2**52), Line(2, "bye")],
            plans={5: b"\x92\x44\x80"},
        ),
        reshaped=[Reshaped(5, 0.4, 0.9, 1.8, (b"\x80", b"\x81"))],
        outcomes=[Outcome(3, 1200), Outcome(4, 1199, fault)],
        actors_stood=True,
        rate=0.25,
    )


def same(one: Frame, other: Frame) -> bool:
    return all(
        np.array_equal(mine, theirs) if isinstance(mine, np.ndarray) else mine == theirs
        for mine, theirs in (
            (getattr(one, each.name), getattr(other, each.name)) for each in fields(Frame)
        )
    )


def test_everything_in_a_frame_is_carried() -> None:
    frame = full_frame()
    assert same(decode_frame(encode_frame(frame)), frame)
    bare = replace(frame, records=frame.records[:0], steps=frame.steps[:0], acks={}, entered=[])
    assert same(decode_frame(encode_frame(bare)), bare)
    assert not same(bare, frame)


def test_gestures_and_who_is_away_are_carried() -> None:
    frame = full_frame()
    events = replace(frame.events, gestures={7: 1}, away={8: True, 9: False})
    decoded = decode_frame(encode_frame(replace(frame, events=events)))
    assert decoded.events == events


def test_looks_are_carried_beside_bodies() -> None:
    frame = full_frame()
    (first, *others) = frame.reshaped
    frame = replace(frame, reshaped=[replace(first, look=Look(1, 2, 3, 4, 5, 171)), *others])
    assert same(decode_frame(encode_frame(frame)), frame)


def test_lines_for_a_few_are_carried_with_those_who_hear_them() -> None:
    frame = full_frame()
    (first, *others) = frame.events.chat
    events = replace(frame.events, chat=[first, *others, replace(first, to=frozenset({8, 9}))])
    decoded = decode_frame(encode_frame(replace(frame, events=events)))
    assert decoded.events == events


def test_the_bytes_are_those_of_this_version() -> None:
    """Hosts and gateways of one release read each other: other bytes are another version."""
    body = encode_frame(replace(full_frame(), steps=new_step_records(0)))
    assert body.hex() == "".join(GOLDEN.read_text().split())


@given(st.data())
def test_bad_bytes_are_refused_by_name(data: st.DataObject) -> None:
    body = bytearray(encode_frame(full_frame()))
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(body) - 1))
        body[at] = data.draw(st.integers(0, 255))
    cut = bytes(body[: data.draw(st.integers(0, len(body)))]) if data.draw(st.booleans()) else body
    with suppress(FrameError):
        decoded = decode_frame(bytes(cut))
        assert isinstance(decoded.tick, int)


@pytest.mark.parametrize(
    ("rest", "message"),
    [
        (b"", "not msgpack"),
        (msgpack.packb([1]), "events of the frame"),
        (msgpack.packb([[], [], [], [], [], ["x"], {}, {}, [], {}, []]), "5 / 0: .*integer"),
        (msgpack.packb([[]] * 6 + [{}, {}, [], {}, []]) + b"\x00", "not msgpack"),
    ],
    ids=["nothing", "too short", "a word for a number", "too long"],
)
def test_events_that_are_none_are_refused(rest: bytes, message: str) -> None:
    empty = replace(full_frame(), records=full_frame().records[:0], steps=new_step_records(0))
    head = encode_frame(replace(empty, acks={}))[:32]
    with pytest.raises(FrameError, match=message):
        decode_frame(head + rest)


def test_viewers_are_told_the_same_bytes_over_a_network() -> None:
    population = ScriptedPopulation(TICK_S)
    for number in range(12):
        population.put(f"actor-{number}", (60.0 + number, 70.0))
    trial = Trial(FIELD, population, max_people=PEOPLE)
    near, far = trial.audience, _another_audience(trial)
    told = 0
    for tick in range(TICKS):
        for name, (x, y) in list(population.positions.items()):
            population.put(name, (x + 0.05, y + 0.02 * (tick % 3)))
        frame = trial.frame(*inputs_of(trial, tick))
        here, there = near.take(frame), far.take(decode_frame(encode_frame(frame)))
        assert_same(here, there)
        # Every third viewer is not written to: what is due later is the same as well.
        places = [k for k in range(len(here.snapshots.viewers)) if (k + tick) % 3]
        near.wrote(here.snapshots, places)
        far.wrote(there.snapshots, places)
        told += len(here.snapshots.records)
    assert told > 50 * TICKS


def _another_audience(trial: Trial) -> Audience:
    return Audience(trial.world.rules, trial.world.origin_m, trial.world.times)


def inputs_of(trial: Trial, tick: int, most: int = PEOPLE - 5) -> list[Input]:
    """At most so many people, who come, walk about, talk, go away and come back."""
    rng = np.random.default_rng(tick)
    state = trial.world.state
    people = [one for one in state.ids[state.live()].tolist() if one in _persons(trial)]
    inputs: list[Input] = []
    if len(people) < most:
        inputs.append(Join(tick, f"p{tick}", (60.0 + tick % 20, 70.0 + tick % 7, 0.0)))
    inputs += [
        Steer(one, tick, float(rng.uniform(0.0, 6.28)), 1.4) for one in people if rng.random() < 0.1
    ]
    if people and tick % 5 == 0:
        inputs.append(Say(people[tick % len(people)], f"line {tick}"))
    if people and tick % 11 == 0:
        who = people[(tick // 11) % len(people)]
        inputs += [Detach(who), Attach(who, tick)]
    if people and tick % 40 == 39:
        inputs += [Say(people[0], "bye"), Leave(people[0])]
    return [*inputs, MoveDoor("nowhere", True)] if tick % 50 == 0 else inputs


def _persons(trial: Trial) -> set[int]:
    state = trial.world.state
    return set(state.ids[state.of_kind(PERSON)].tolist())


def assert_same(here: News, there: News) -> None:
    for each in fields(News):
        if each.name != "snapshots":
            assert getattr(here, each.name) == getattr(there, each.name), each.name
    for each in fields(type(here.snapshots)):
        one: Any = getattr(here.snapshots, each.name)
        assert np.array_equal(one, getattr(there.snapshots, each.name)), each.name
