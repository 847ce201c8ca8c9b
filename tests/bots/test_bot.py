"""The library against a scripted server: over a real socket, in real time, on conditions."""

import asyncio
import math
import time

import msgpack
import numpy as np
import pytest
from pydantic import ValidationError

from esplanade import bots
from esplanade.bots.events import SnapshotEvent, StepsEvent
from esplanade.protocol import ByeCode, CloseCode, ErrorCode, encode
from esplanade.protocol.messages import (
    Bye,
    Chat,
    Enter,
    Entity,
    Error,
    FromServer,
    Hello,
    Move,
    Notice,
    Point,
    Snapshot,
    StepBlock,
    Watch,
)
from esplanade.protocol.snapshot import pack_records
from esplanade.protocol.steps import FOOTPRINT_M, landing_footprints, pack_steps
from tests.bots.scripted import OPERATOR, scripted_server, until
from tests.protocol.steps import made_up_steps, mixed_block


async def test_a_bot_stands_where_it_wished_to() -> None:
    async with scripted_server() as server:
        async with bots.connect(server.url, name="Ann", at=(1.5, -2.0, 0)) as bot:
            assert bot.name == "Ann"
            assert bot.position == pytest.approx((1.5, -2.0, 0), abs=0.006)
            assert bot.resume_token == "token-1"
        await until(lambda: not server.people)


async def test_it_walks_as_it_is_told_and_knows_when_it_was_heeded() -> None:
    async with scripted_server() as server, bots.connect(server.url, at=(0, 0, 0)) as bot:
        sequence = await bot.move(math.pi / 2, 2.0)
        await until(lambda: bot.acknowledged >= sequence and bot.position[1] > 0.2)
        assert bot.position[0] == pytest.approx(0.0, abs=0.01)
        assert bot.avatar.speed == pytest.approx(2.0, abs=0.02)
        assert bot.avatar.heading == pytest.approx(math.pi / 2, abs=0.03)
        stopped = await bot.stop()
        await until(lambda: bot.acknowledged >= stopped)
        assert bot.avatar.speed == 0.0
        await bot.walk_to(7.0, 8.0, 3.5)
        await until(lambda: bot.position == pytest.approx((7.0, 8.0, 3.5), abs=0.01))


async def test_an_operator_closes_a_door_and_everyone_learns_of_it() -> None:
    async with (
        scripted_server() as server,
        bots.connect(server.url, name="Ann") as ann,
        bots.connect(server.url, name="Olga", operator=OPERATOR) as olga,
    ):
        assert (ann.welcome.operator, olga.welcome.operator) == (False, True)
        assert ann.doors == {"gate": True}
        await ann.set_door("gate", False)
        async for event in ann.events():
            if isinstance(event, Error):
                assert event.error is ErrorCode.FORBIDDEN
                break
        await olga.set_door("gate", False)
        await until(lambda: ann.doors == olga.doors == {"gate": False})


async def test_it_sees_others_come_walk_and_go() -> None:
    async with scripted_server() as server, bots.connect(server.url, name="Ann") as ann:
        async with bots.connect(server.url, name="Bob", at=(3, 4, 0)) as bob:
            await until(lambda: bob.id in ann.others)
            assert ann.others[bob.id].name == "Bob"
            assert ann.id in bob.others
            assert ann.id not in ann.others
            await bob.walk_to(5.0, 6.0)
            await until(lambda: ann.others[bob.id].x == pytest.approx(5.0, abs=0.01))
        await until(lambda: bob.id not in ann.others)


async def test_events_are_typed_and_in_order() -> None:
    async with scripted_server() as server, bots.connect(server.url, name="Ann") as ann:
        await ann.chat("hello there")
        ticks = []
        async for event in ann.events():
            match event:
                case SnapshotEvent():
                    ticks.append(event.tick)
                    assert event.positions.shape == (len(event.records), 2)
                    assert event.headings.shape == event.speeds.shape == (len(event.records),)
                case Chat():
                    assert (event.name, event.text) == ("Ann", "hello there")
                    if len(ticks) > 3:
                        break
                    await ann.chat("hello there")
                case Enter():
                    pass
                case _:
                    pytest.fail(f"unexpected {event!r}")
        assert ticks == sorted(set(ticks))


async def test_steps_come_as_records_and_in_world_units() -> None:
    records = pack_steps(made_up_steps(3))
    async with scripted_server() as server, bots.connect(server.url, name="Ann") as ann:
        block = StepBlock(tick=9, block=records.tobytes())
        await server.people[ann.id].socket.send(encode(block))
        async for event in ann.events():
            if isinstance(event, StepsEvent):
                break
        assert event.tick == 9
        np.testing.assert_array_equal(event.records, records)
        landing = event.steps.landing.positions_m
        np.testing.assert_allclose(landing, landing_footprints(records)["position"] * FOOTPRINT_M)


async def test_it_knows_the_build_of_those_in_view_and_where_they_point() -> None:
    async with (
        scripted_server() as server,
        bots.connect(server.url, name="Ann") as ann,
        bots.connect(server.url, name="Bob") as bob,
    ):
        await until(lambda: bob.id in ann.others)
        assert (ann.others[bob.id].leg_m, ann.others[bob.id].stature_m) == (0.9, 1.75)
        assert (ann.avatar.leg_m, ann.avatar.stature_m) == (0.9, 1.75)
        assert ann.others[bob.id].points_at is None
        for target in ((1.0, 2.0, 3.0), None):
            for avatar_id in (999, bob.id):  # of one who is out of view it means nothing
                point = Point(id=avatar_id, target=target)
                await server.people[ann.id].socket.send(encode(point))
            await until(lambda target=target: ann.others[bob.id].points_at == target)


async def test_ping_measures_and_sets_the_clock() -> None:
    async with scripted_server() as server, bots.connect(server.url) as bot:
        begin_s = time.monotonic()
        round_trips = await asyncio.gather(*(bot.ping() for _ in range(5)))
        waited_s = time.monotonic() - begin_s
        assert all(0 < round_trip_s <= waited_s for round_trip_s in round_trips)
        assert abs(bot.server_time - server.time_s) <= max(round_trips)


async def test_a_resume_token_and_a_watch_reach_the_server() -> None:
    async with scripted_server() as server:
        async with bots.connect(server.url, resume="token-9") as bot:
            assert bot.welcome.resumed
            await bot.watch(12)
            await until(lambda: Watch(id=12) in server.all_people[0].heard)
        assert server.all_people[0].hello.resume == "token-9"


async def test_a_refusal_is_typed() -> None:
    def refuse(hello: Hello) -> FromServer:
        return Error(error=ErrorCode.SERVER_FULL, text="1000 people are here")

    async with scripted_server() as server:
        server.on_hello = refuse
        with pytest.raises(bots.Refused) as caught:
            async with bots.connect(server.url):
                pytest.fail("was let in")
        assert (caught.value.code, caught.value.text) == ("server_full", "1000 people are here")


async def test_a_server_that_answers_something_else_is_unreachable() -> None:
    async with scripted_server() as server:
        server.on_hello = lambda hello: Notice(text="hm")
        with pytest.raises(bots.Unreachable, match="expected welcome, not notice"):
            async with bots.connect(server.url):
                pytest.fail("was let in")


async def test_nobody_there_is_unreachable(unused_tcp_port: int) -> None:
    with pytest.raises(bots.Unreachable, match=f"ws://127.0.0.1:{unused_tcp_port}/ws: "):
        async with bots.connect(f"127.0.0.1:{unused_tcp_port}"):
            pytest.fail("was let in")


async def test_wrong_arguments_never_reach_the_server() -> None:
    with pytest.raises(ValueError, match="unknown scheme"):
        async with bots.connect("gopher://localhost"):
            pytest.fail("was let in")
    with pytest.raises(ValidationError, match="name"):
        async with bots.connect("localhost:1", name="x" * 33):
            pytest.fail("was let in")


async def test_a_lost_connection_is_told_to_every_caller() -> None:
    async with scripted_server() as server, bots.connect(server.url) as bot:
        server.all_people[0].socket.transport.abort()
        with pytest.raises(bots.Disconnected) as caught:
            async for _ in bot.events():
                pass
        assert caught.value.code == 1006
        with pytest.raises(bots.Disconnected):
            await bot.move(0.0, 1.0)
        with pytest.raises(bots.Disconnected):
            await bot.ping()


async def test_the_servers_close_code_is_handed_on() -> None:
    async with scripted_server() as server, bots.connect(server.url) as bot:
        await server.all_people[0].socket.close(CloseCode.TOO_SLOW, "too slow")
        with pytest.raises(bots.Disconnected, match="4008: too slow"):
            async for _ in bot.events():
                pass


async def test_events_end_after_bye() -> None:
    async with scripted_server() as server, bots.connect(server.url) as bot:
        socket = server.all_people[0].socket
        await socket.send(encode(Bye(reason=ByeCode.SHUTDOWN, text="good night")))
        await socket.close(CloseCode.GOING_AWAY)
        events = [event async for event in bot.events()]
        assert events[-1] == Bye(reason=ByeCode.SHUTDOWN, text="good night")


async def test_a_pending_ping_does_not_outlive_the_connection() -> None:
    async with scripted_server() as server, bots.connect(server.url) as bot:

        async def no_answer(person: object, message: object) -> None:
            server.all_people[0].socket.transport.abort()

        server._hear = no_answer  # type: ignore[method-assign]
        with pytest.raises(bots.Disconnected):
            await bot.ping()


async def test_nonsense_from_the_server_ends_the_bot_not_the_script() -> None:
    async with scripted_server() as server, bots.connect(server.url) as bot:
        await server.all_people[0].socket.send(b"\xc1")
        with pytest.raises(bots.Disconnected, match="nonsense"):
            async for _ in bot.events():
                pass


async def test_events_that_nobody_reads_are_bounded() -> None:
    async with scripted_server() as server, bots.connect(server.url) as bot:
        bot._mailbox._capacity = 3
        await until(lambda: bot.dropped_events > 5)
        assert len(bot._mailbox._events) == 3
        sequence = await bot.move(0.0, 1.0)
        await until(lambda: bot.acknowledged >= sequence)


async def test_move_is_sent_with_rising_numbers() -> None:
    async with scripted_server() as server, bots.connect(server.url) as bot:
        for speed in (0.5, 1.0, 1.5):
            await bot.move(0.0, speed)
        heard = server.all_people[0].heard
        await until(lambda: len(heard) == 3)
        assert [message.seq for message in heard if isinstance(message, Move)] == [1, 2, 3]


async def test_what_a_later_version_adds_is_passed_over() -> None:
    """Unknown codes, fields, kinds, reasons and records of steps end no connection."""
    async with scripted_server() as server, bots.connect(server.url, name="Ann") as ann:
        socket = server.all_people[0].socket
        await socket.send(msgpack.packb([99, "anything", [1, 2]]))
        dog = Entity(
            id=77,
            kind="dog",
            name="Rex",
            layer=0,
            x=1.0,
            y=2.0,
            z=0.0,
            heading=0.0,
            radius=0.25,
            leg_m=0.4,
            stature_m=0.6,
            points_at=None,
        )
        _, fields = msgpack.unpackb(encode(Enter(tick=server.tick, entities=[dog])))
        fields["entities"][0]["collar"] = {"colour": "red"}
        await socket.send(msgpack.packb([65, {**fields, "later": True}]))
        records = pack_steps(made_up_steps(3))
        await socket.send(encode(StepBlock(tick=server.tick, block=mixed_block(records))))
        place = pack_records(
            ids=np.array([77]),
            layers=np.array([0]),
            reasons=np.array([200]),
            positions_m=np.array([[1.0, 2.0]]),
            heights_m=np.zeros(1),
            headings_rad=np.zeros(1),
            speeds_mps=np.zeros(1),
            origin_m=ann.welcome.origin,
        )
        await socket.send(encode(Snapshot(tick=server.tick, ack=0, block=place.tobytes())))
        await socket.send(msgpack.packb([70, {"error": "too_windy", "text": "hold on"}]))
        known = []
        async for event in ann.events():
            known.append(event)
            if isinstance(event, Error):
                break
        assert isinstance(known[-1], Error)
        assert known[-1].error == "too_windy"
        (steps,) = [event for event in known if isinstance(event, StepsEvent)]
        assert steps.records["id"].tolist() == records["id"].tolist()
        assert (ann.others[77].kind, ann.others[77].reason) == ("dog", 200)
        assert await ann.ping() > 0.0
