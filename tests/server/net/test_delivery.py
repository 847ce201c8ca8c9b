import socket
from contextlib import ExitStack
from itertools import chain
from typing import Any, cast

import numpy as np
import pytest
from websockets.asyncio.server import ServerConnection
from websockets.protocol import State

from esplanade.actors import Explanation, Reason
from esplanade.actors.blockers import Blocker
from esplanade.protocol import Reason as WireReason
from esplanade.protocol import decode_server, encode
from esplanade.protocol.messages import (
    Census,
    Error,
    Plan,
    Point,
    Reshape,
    ServerMessage,
    Snapshot,
    StepBlock,
    Watch,
)
from esplanade.protocol.steps import new_step_records, step_records
from esplanade.server.metrics import Traffic
from esplanade.server.net.delivery import Delivery
from esplanade.server.net.outbox import Outbox, SlowPolicy
from esplanade.server.net.sockets.system import AVAILABLE
from esplanade.server.world.inputs import Input, Say, Steer
from esplanade.server.world.interest import PERIOD_TICKS
from esplanade.server.world.plans import plan
from esplanade.server.world.state import ACTOR
from esplanade.server.world.walking import Feet
from tests.server.client import joined
from tests.server.conftest import Serving
from tests.server.doubles import ScriptedPopulation
from tests.server.net.test_frames import payloads_of
from tests.server.net.test_outbox import StuffedConnection
from tests.server.worlds import FIELD, TICK_S, Trial


def test_an_explanation_becomes_a_plan_to_the_millimetre() -> None:
    explanation = Explanation(
        "guide",
        Reason.GIVING_WAY,
        (1.0, 2.0, 0),
        np.array([[0.12345, 1.0, 0.0, 0.0], [0.5, 1.0, 0.0, 0.4]]),
        [np.array([[3.00049, 4.0, 0.0, 0.7]])],
        2.50049,
        Blocker("door", "gate", 1.25),
    )
    made = plan(9, 4, explanation)
    assert made.reason is WireReason.GIVING_WAY
    assert made.path[0] == (0.123, 1.0, 0.0, 0.0)
    assert made.people[0][0].x == 3.0
    assert made.since_s == 2.5
    assert made.blocker is not None
    held = made.blocker
    assert (held.kind, held.id, held.door, held.away) == ("door", None, "gate", 1.25)
    assert decode_server(encode(made)) == made


async def test_an_actor_in_view_can_be_watched_about_five_times_a_second(serving: Serving) -> None:
    async with serving(actors=2) as server, joined(server.port) as client:
        await client.wait_for(lambda: len(client.positions) == 3)
        actor = next(i for i, e in client.entities.items() if e.kind.value == "actor")
        await client.send(Watch(id=actor))
        first = await client.until(Plan)
        second = await client.until(Plan)
        assert (first.id, second.id) == (actor, actor)
        assert second.tick - first.tick == 4
        assert first.behaviour in {"wander", "patrol"}
        assert len(first.path) >= 1
        assert len(first.people) <= 1
        await client.send(Watch(id=None))
        await client.ticks(2)


async def test_only_actors_in_view_can_be_watched(serving: Serving) -> None:
    async with serving() as server, joined(server.port) as client:
        for nobody in (client.id, 999_999):
            await client.send(Watch(id=nobody))
            error = await client.until(Error)
            assert f"{nobody} is no actor in view" in error.text


async def test_the_census_counts_the_whole_world(serving: Serving) -> None:
    async with (
        serving(actors=2, view_radius_m=1.0) as server,
        joined(server.port, at=(2.0, 2.0, 0)) as client,
        joined(server.port, at=(18.0, 18.0, 0)),
    ):
        first = await client.until(Census)
        while first.people < 2:
            first = await client.until(Census)
        assert (first.people, first.actors) == (2, 2)


class Listener:
    """A session that only listens; `heard` is what it was sent."""

    def __init__(self) -> None:
        self.line = StuffedConnection()
        policy = SlowPolicy(slow_bytes=1000, drop_bytes=4000, drop_seconds=5.0)
        self.outbox = Outbox(cast(ServerConnection, self.line), policy, Traffic())
        self.watching = None

    def heard(self) -> list[ServerMessage]:
        """The messages that came since the last call."""
        frames, self.line.frames = self.line.frames, []
        return [decode_server(payload) for payload in payloads_of(b"".join(frames))]


def lifts_of(messages: list[ServerMessage]) -> list[int]:
    """The lift of every step in these messages, by which the tests know the steps."""
    blocks = [message.block for message in messages if isinstance(message, StepBlock)]
    return [lift for block in blocks for lift in step_records(block)["lift"].tolist()]


@pytest.fixture
def trial(monkeypatch: pytest.MonkeyPatch) -> Trial:
    """One actor and one person, two metres apart, who step only when told."""
    monkeypatch.setattr(Feet, "update", lambda _self, _tick: None)
    script = ScriptedPopulation(TICK_S)
    script.put("oak", (52.0, 50.0))
    return Trial(scene=FIELD, population=script)


@pytest.fixture
def listener() -> Listener:
    return Listener()


@pytest.fixture
def delivery(trial: Trial, listener: Listener) -> Delivery:
    (ann,) = trial.join((50.0, 50.0))
    delivery = Delivery(trial.audience, cast(Any, {ann: listener}), 20, lambda _: None)
    delivery.deliver(trial.tick(writing=False), now=0.0)
    listener.heard()
    return delivery


def begin_step(trial: Trial, lift: int) -> None:
    records = new_step_records(1)
    records["lift"] = lift
    oak = trial.world.state.of_kind(ACTOR)
    trial.world.steps.begin(oak, records, trial.world.tick + 1)


def test_steps_come_once_and_before_the_snapshot_of_their_tick(
    trial: Trial, listener: Listener, delivery: Delivery
) -> None:
    begin_step(trial, lift=7)
    delivery.deliver(trial.tick(writing=False), now=0.05)
    messages = listener.heard()
    assert [type(message) for message in messages] == [StepBlock, Snapshot]
    assert lifts_of(messages) == [7]
    delivery.deliver(trial.tick(writing=False), now=0.1)
    assert [type(message) for message in listener.heard()] == [Snapshot]


def test_after_a_gap_a_slow_client_has_the_latest_step_of_everyone(
    trial: Trial, listener: Listener, delivery: Delivery
) -> None:
    listener.line.unsent = 1001
    for lift in (1, 2, 3):
        begin_step(trial, lift)
        delivery.deliver(trial.tick(writing=False), now=0.05)
    assert listener.heard() == []
    listener.line.unsent = 0
    delivery.deliver(trial.tick(writing=False), now=0.2)
    assert lifts_of(listener.heard()) == [3]
    delivery.deliver(trial.tick(writing=False), now=0.25)
    assert lifts_of(listener.heard()) == []


def test_another_body_is_told_once_to_those_who_see_it(
    trial: Trial, listener: Listener, delivery: Delivery
) -> None:
    (slot,) = trial.world.state.of_kind(ACTOR).tolist()
    stature_m = trial.world.state.statures_m[slot]
    trial.population.table.agents.parameters["radius_m"] = 0.4
    trial.population.table.agents.parameters["height_m"] = 0.9
    delivery.deliver(trial.tick(writing=False), now=0.05)
    (told,) = [message for message in listener.heard() if isinstance(message, Reshape)]
    assert (told.id, told.radius) == (int(trial.world.state.ids[slot]), 0.4)
    assert told.stature_m == pytest.approx(0.5 * stature_m)
    delivery.deliver(trial.tick(writing=False), now=0.1)
    assert not any(isinstance(message, Reshape) for message in listener.heard())


def test_pointing_is_told_to_those_who_see_it(
    trial: Trial, listener: Listener, delivery: Delivery
) -> None:
    oak = int(trial.world.state.ids[trial.world.state.of_kind(ACTOR)][0])
    trial.population.pointed_at["oak"] = (1.0, 2.0, 3.0)
    delivery.deliver(trial.tick(writing=False), now=0.05)
    assert Point(id=oak, target=(1.0, 2.0, 3.0)) in listener.heard()
    trial.population.pointed_at = {}
    trial.population.put("oak", (150.0, 150.0))
    for _ in range(PERIOD_TICKS):
        delivery.deliver(trial.tick(writing=False), now=0.1)
    listener.heard()
    trial.population.pointed_at["oak"] = (1.0, 2.0, 3.0)
    delivery.deliver(trial.tick(writing=False), now=0.15)
    assert [type(message) for message in listener.heard()] == [Snapshot]


class Wire(StuffedConnection):
    """A connection whose transport writes to a socket at once."""

    def __init__(self, sock: socket.socket) -> None:
        super().__init__()
        self._sock = sock

    def write(self, frame: bytes) -> None:
        self._sock.sendall(frame)


class Direct:
    """A session whose snapshots may be sent past its transport."""

    def __init__(self, here: socket.socket, there: socket.socket) -> None:
        policy = SlowPolicy(slow_bytes=1000, drop_bytes=4000, drop_seconds=5.0)
        here.setblocking(False)
        there.setblocking(False)
        self._there = there
        self.line = Wire(here)
        self.outbox = Outbox(cast(ServerConnection, self.line), policy, Traffic(), here.fileno())
        self.watching = None

    def bytes_received(self) -> bytes:
        """The bytes that came at the other end since the last call."""
        try:
            return self._there.recv(1 << 20)
        except BlockingIOError:
            return b""


@pytest.mark.skipif(not AVAILABLE, reason="kernels call the system on Linux only")
def test_bytes_are_the_same_whether_transports_write_them_or_all_are_sent_at_once() -> None:
    people, random = 12, np.random.default_rng(3)
    trials, deliveries, heard, traffic = [], [], [], []
    with ExitStack() as stack:
        pairs = [socket.socketpair() for _ in range(people)]
        for each in chain.from_iterable(pairs):
            stack.enter_context(each)
        sessions: list[list[Any]] = [
            [Listener() for _ in range(people)],
            [Direct(*pair) for pair in pairs],
        ]
        places = random.uniform(10.0, 90.0, (people, 2)).tolist()
        for kind in sessions:
            trial = Trial(scene=FIELD, view_radius_m=25.0)
            ids = trial.join(*((x, y) for x, y in places))
            by_id = dict(zip(ids, kind, strict=True))
            trials.append(trial)
            deliveries.append(Delivery(trial.audience, by_id, 20, lambda _: None))
        direct = 0
        for tick in range(60):
            wishes: list[Input] = [
                Steer(ids[k], tick, float(random.uniform(-3.0, 3.0)), 2.0)
                for k in range(people)
                if random.random() < 0.2
            ]
            if tick == 20:
                wishes.append(Say(ids[0], "hello"))
            for k in random.integers(0, people, 2).tolist():
                for kind in sessions:
                    kind[k].line.unsent = 1001 if tick % 7 < 3 else 0
                    kind[k].outbox.fill()
            for trial, delivery in zip(trials, deliveries, strict=True):
                delivery.deliver(trial.tick(*wishes, writing=False), now=0.05 * tick)
            for usual, quick in zip(*sessions, strict=True):
                frames, usual.line.frames = usual.line.frames, []
                assert quick.bytes_received() == b"".join(frames)
                direct += quick.outbox.clear
            heard.append(sum(map(len, frames)))
        traffic = [
            [
                sum(getattr(each.outbox._traffic, name) for each in kind)
                for name in ("messages_out", "bytes_out", "steps_out", "snapshots_skipped")
            ]
            for kind in sessions
        ]
    assert traffic[0] == traffic[1]
    assert traffic[0][3] > 0
    assert direct > 300


@pytest.mark.skipif(not AVAILABLE, reason="kernels call the system on Linux only")
@pytest.mark.parametrize("how", ["taken over", "closed"])
def test_a_session_that_ends_is_sent_nothing_past_its_transport_and_its_successor_is(
    how: str,
) -> None:
    trial = Trial(scene=FIELD, view_radius_m=25.0)
    ann, ben = trial.join((10.0, 10.0), (12.0, 10.0))
    with ExitStack() as stack:
        pairs = [socket.socketpair() for _ in range(3)]
        for each in chain.from_iterable(pairs):
            stack.enter_context(each)
        first, second, third = (Direct(*pair) for pair in pairs)
        by_id: dict[int, Any] = {ann: first, ben: second}
        delivery = Delivery(trial.audience, by_id, 20, lambda _: None)

        def tick() -> list[bool]:
            """Those of the three who were told something."""
            delivery.deliver(trial.tick(writing=False), now=0.0)
            return [bool(each.bytes_received()) for each in (first, second, third)]

        for _ in range(3):
            assert tick() == [True, True, False]
        assert first.outbox.clear
        assert second.outbox.clear
        if how == "taken over":
            by_id[ann] = third
            for _ in range(3):
                assert tick() == [False, True, True]
            assert third.outbox.clear
        else:
            first.outbox.use_transport()
            first.line.state = State.CLOSING
            for _ in range(3):
                assert tick() == [False, True, False]
            del by_id[ann]
            assert tick() == [False, True, False]
