"""People in a running server: coming in, moving, talking, coming back, going."""

import asyncio
import itertools
import math
import threading
from contextlib import AsyncExitStack
from pathlib import Path

import pytest

from esplanade.actors import Population
from esplanade.planning import Door, Polygon, Wall
from esplanade.protocol import VERSION, ByeCode, CloseCode, ErrorCode
from esplanade.protocol.codes import NoticeCode
from esplanade.protocol.messages import (
    Bye,
    Chat,
    ChatLine,
    Doors,
    Error,
    Hello,
    Notice,
    SetDoor,
    Snapshot,
    WalkTo,
    Welcome,
)
from tests.patience import PATIENCE_S
from tests.server.client import Client, connected, joined
from tests.server.conftest import Serving
from tests.server.worlds import ROOM


async def test_a_newcomer_is_told_who_and_where_they_are(serving: Serving) -> None:
    async with serving() as server, joined(server.port, "Ann") as client:
        welcome = client.welcome
        assert welcome is not None
        assert (welcome.name, welcome.resumed, welcome.version) == ("Ann", False, VERSION)
        assert welcome.scene["name"] == "room"
        assert (welcome.tick_rate, welcome.radius, welcome.max_speed) == (20, 0.25, 3.0)
        assert client.entities[client.id].name == "Ann"
        assert math.dist(client.position, (3.0, 3.0)) <= 1.1


async def test_a_wished_place_is_given_or_the_nearest_free_one(serving: Serving) -> None:
    async with serving() as server:
        async with joined(server.port, at=(5.0, 6.0, 0)) as client:
            assert client.position == pytest.approx((5.0, 6.0), abs=0.01)
        async with joined(server.port, at=(-9.0, 1e4, 0)) as client:
            assert client.position == pytest.approx((0.1, 19.9), abs=0.3)


async def test_moving_is_acknowledged_and_seen_by_others(serving: Serving) -> None:
    async with (
        serving() as server,
        joined(server.port, at=(2.0, 2.0, 0)) as ann,
        joined(server.port, "Ben", at=(2.0, 3.0, 0)) as ben,
    ):
        await ann.move(0.0, 2.0)
        await ann.wait_for(lambda: ann.ack == 1)
        await ann.wait_for(lambda: ann.position[0] > 2.5)
        await ben.wait_for(lambda: ben.positions[ann.id][0] > 2.5)


async def test_walls_and_the_speed_limit_hold_for_everyone(serving: Serving) -> None:
    async with serving() as server, joined(server.port, at=(8.0, 5.0, 0)) as client:
        await client.move(0.0, 99.0)
        await client.wait_for(lambda: client.ack == 1)
        x, tick = client.position[0], client.tick
        await client.ticks(5)
        assert client.position[0] - x <= 3.0 * (client.tick - tick) / 20.0 + 0.02
        await client.ticks(25)
        assert client.position[0] == pytest.approx(9.75, abs=0.03)


async def test_walk_to_goes_straight_and_around(serving: Serving) -> None:
    async with (
        serving(person_max_speed_mps=50.0, person_walk_speed_mps=40.0) as server,
        joined(server.port, at=(8.0, 5.0, 0)) as client,
    ):
        await client.send(WalkTo(seq=1, x=5.0, y=5.0))
        await client.wait_for(lambda: math.dist(client.position, (5.0, 5.0)) < 0.02)
        await client.send(WalkTo(seq=2, x=12.0, y=5.0))
        await client.wait_for(lambda: math.dist(client.position, (12.0, 5.0)) < 0.02)
        assert client.ack == 2


async def test_a_person_is_told_where_a_walk_into_a_solid_leads(
    serving: Serving, tmp_path: Path
) -> None:
    solid = Polygon(points=((10, 4), (13, 4), (13, 7), (10, 7)), height_m=3.0, kind="wall")
    scene = tmp_path / "solid.json"
    scene.write_text(ROOM.model_copy(update={"polygons": (solid,)}).model_dump_json())
    async with (
        serving(scene=scene, person_max_speed_mps=50.0, person_walk_speed_mps=40.0) as server,
        joined(server.port, at=(5.0, 5.0, 0)) as client,
    ):
        await client.send(WalkTo(seq=1, x=11.2, y=5.5, strict=True))
        error = await client.until(Error)
        assert error.error is ErrorCode.GOAL_MOVED
        assert error.arguments["why"] == "inside_wall"
        await client.send(WalkTo(seq=2, x=11.2, y=5.5))
        notice = await client.until(Notice)
        assert notice.notice is NoticeCode.GOAL_MOVED
        x, y = float(notice.arguments["x"]), float(notice.arguments["y"])
        moved = float(notice.arguments["moved"])
        assert moved == pytest.approx(math.dist((x, y), (11.2, 5.5)), abs=0.01)
        assert moved > 1.2
        assert f"{moved:.1f} m" in notice.text
        await client.wait_for(lambda: math.dist(client.position, (x, y)) < 0.05)


async def test_where_no_way_leads_a_person_is_told_and_stays(
    serving: Serving, tmp_path: Path
) -> None:
    shut = ROOM.model_copy(update={"walls": (Wall(start=(10.0, 0.0), end=(10.0, 20.0)),)})
    scene = tmp_path / "shut.json"
    scene.write_text(shut.model_dump_json())
    async with serving(scene=scene) as server, joined(server.port) as client:
        await client.send(WalkTo(seq=1, x=15.0, y=5.0, z=0.5))
        error = await client.until(Error)
        assert error.error is ErrorCode.NO_PATH
        assert "(15.00, 5.00, 0.50)" in error.text
        await client.ticks(2)


async def test_a_way_is_found_for_one_address_while_another_asks_all_the_time(
    serving: Serving,
) -> None:
    async with serving() as server, AsyncExitStack() as stack:
        crowd = [
            await stack.enter_async_context(joined(server.port, f"P{k}", source="127.0.0.2"))
            for k in range(8)
        ]
        ann = await stack.enter_async_context(joined(server.port, at=(8.0, 5.0, 0)))

        async def ask_on(client: Client, number: int) -> None:
            for seq in itertools.count(1):
                goal = 11.0 + 0.01 * (seq % 800), 1.0 + 0.3 * number
                await client.send(WalkTo(seq=seq, x=goal[0], y=goal[1]))
                await asyncio.sleep(0.04)

        asking = [asyncio.create_task(ask_on(client, k)) for k, client in enumerate(crowd)]
        await asyncio.sleep(0.5)
        for seq in range(1, 6):
            asked_at = ann.tick
            await ann.send(WalkTo(seq=seq, x=12.0, y=2.0 + seq))
            await ann.wait_for(lambda: ann.ack == seq)  # noqa: B023 - called in this round only
            assert ann.tick - asked_at <= 60
        for task in asking:
            task.cancel()


async def test_who_causes_too_much_searching_is_told_and_stays(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("esplanade.server.net.route_requests.REQUEST_S", 1.0)
    async with serving() as server, joined(server.port) as client:
        for seq in range(1, 4):
            await client.send(WalkTo(seq=seq, x=5.0, y=5.0))
        error = await client.until(Error)
        assert error.error is ErrorCode.FLOODING
        assert "ask again in" in error.text
        await client.move(0.0, 1.0)
        await client.ticks(2)
        assert b"esplanade_routes_refused_total 1.0" in server.metrics.exposition()


async def test_only_operators_move_doors(serving: Serving) -> None:
    async with serving() as server, joined(server.port) as client:
        assert client.welcome is not None
        assert not client.welcome.operator
        await client.send(SetDoor(name="gate", open=False))
        assert (await client.until(Error)).error is ErrorCode.FORBIDDEN
        await client.ticks(2)


async def test_an_operator_moves_doors_and_everyone_is_told(
    serving: Serving, tmp_path: Path
) -> None:
    gate = Door(name="gate", start=(10.0, 15.0), end=(10.0, 20.0))
    scene = tmp_path / "gated.json"
    scene.write_text(ROOM.model_copy(update={"doors": (gate,)}).model_dump_json())
    async with (
        serving(scene=scene, operator_key="sesame") as server,
        joined(server.port, "Ann") as ann,
        connected(server.port) as client,
    ):
        hello = Hello(name="Olga", version=VERSION, operator="sesame")
        await client.send(hello)
        welcome = await client.until(Welcome)
        assert welcome.operator
        assert welcome.doors == {"gate": True}
        await client.send(SetDoor(name="gate", open=False))
        assert (await client.until(Doors)).doors == {"gate": False}
        assert (await ann.until(Doors)).doors == {"gate": False}
        figures = server.metrics.exposition
        await client.wait_for(lambda: b"esplanade_doors_waiting 0.0" in figures())
        await client.wait_for(lambda: b"esplanade_potentials_outdated 0.0" in figures())
        await client.send(SetDoor(name="window", open=False))
        error = await client.until(Error)
        assert (error.error, "window" in error.text) == (ErrorCode.INVALID, True)


@pytest.mark.parametrize("known", ["", "sesame"])
@pytest.mark.parametrize("said", [None, "", "sesam", "Sesame"])
async def test_without_the_right_key_nobody_is_an_operator(
    serving: Serving, known: str, said: str | None
) -> None:
    async with serving(operator_key=known) as server, connected(server.port) as client:
        await client.send(Hello(name="Ann", version=VERSION, operator=said))
        assert not (await client.until(Welcome)).operator


async def test_chat_is_heard_by_those_who_see_the_speaker(serving: Serving) -> None:
    async with (
        serving(view_radius_m=5.0) as server,
        joined(server.port, "Ann", at=(2.0, 2.0, 0)) as ann,
        joined(server.port, "Ben", at=(4.0, 2.0, 0)) as ben,
        joined(server.port, "Far", at=(18.0, 18.0, 0)) as far,
    ):
        await ben.wait_for(lambda: ann.id in ben.positions)
        await ann.send(ChatLine(text=" hello "))
        heard = await ben.until(Chat)
        assert (heard.id, heard.name, heard.text) == (ann.id, "Ann", "hello")
        assert (await ann.until(Chat)).text == "hello"
        await far.send(ChatLine(text="anybody?"))
        heard = await far.until(Chat)
        assert (heard.name, heard.text) == ("Far", "anybody?")


async def test_what_is_said_with_the_hello_is_heard_by_everyone_near(serving: Serving) -> None:
    async with serving() as server, joined(server.port, "Eve", at=(6.0, 6.0, 0)) as eve:
        for k in range(6):
            async with connected(server.port) as client:
                await client.send(Hello(name=f"p{k}", version=VERSION, at=(5.0, 6.0, 0)))
                await client.send(ChatLine(text="hello"))
                own, heard = await client.until(Chat), await eve.until(Chat)
                assert (own.id, own.name, own.text) == (client.id, f"p{k}", "hello")
                assert heard == own
                assert client.id in eve.entities


async def test_what_is_said_on_going_is_heard(serving: Serving) -> None:
    async with serving() as server, joined(server.port, "Eve", at=(6.0, 6.0, 0)) as eve:
        async with joined(server.port, "Ann", at=(5.0, 6.0, 0)) as ann:
            await eve.wait_for(lambda: ann.id in eve.positions)
            await ann.send(ChatLine(text="goodbye"))
        heard = await eve.until(Chat)
        assert (heard.name, heard.text) == ("Ann", "goodbye")


async def test_where_too_many_talk_at_once_a_speaker_is_told(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("esplanade.server.net.waiting_lines.MAX_LINES", 0)
    async with serving() as server, joined(server.port) as client:
        await client.send(ChatLine(text="hello"))
        error = await client.until(Error)
        assert error.error is ErrorCode.FLOODING
        assert "nobody heard" in error.text


async def test_a_lost_connection_comes_back_as_the_same_avatar(serving: Serving) -> None:
    async with serving() as server, joined(server.port, "Eve", at=(6.0, 6.0, 0)) as eve:
        async with joined(server.port, "Ann", at=(2.0, 2.0, 0)) as ann:
            await ann.move(0.0, 1.0)
            await ann.wait_for(lambda: ann.position[0] > 2.3)
            ann.connection.transport.abort()
        assert ann.welcome is not None
        await eve.wait_for(lambda: b"esplanade_clients 1.0" in server.metrics.exposition())
        await eve.until_tick(server.world.tick + 3)
        stood = eve.positions[ann.id]
        await eve.ticks(3)
        assert eve.positions[ann.id] == stood
        async with joined(server.port, "Other name", resume=ann.welcome.resume) as again:
            assert again.welcome is not None
            assert again.id == ann.id
            assert again.welcome.resumed
            assert again.welcome.name == "Ann"
            assert again.position == pytest.approx(stood)
            assert again.ack == 0
            assert again.welcome.resume != ann.welcome.resume
            assert server.world.count()[0] == 2


async def test_an_avatar_waits_only_so_long(serving: Serving) -> None:
    async with serving(resume_seconds=0.2) as server, joined(server.port, "Eve") as eve:
        async with joined(server.port, "Ann") as ann:
            await eve.wait_for(lambda: ann.id in eve.positions)
            ann.connection.transport.abort()
        await eve.wait_for(lambda: ann.id not in eve.positions)
        assert ann.welcome is not None
        async with joined(server.port, "Ann", resume=ann.welcome.resume) as again:
            assert again.welcome is not None
            assert again.id != ann.id
            assert not again.welcome.resumed


async def test_who_says_goodbye_is_gone_at_once(serving: Serving) -> None:
    async with serving() as server, joined(server.port, "Eve") as eve:
        async with joined(server.port, "Ann") as ann:
            await eve.wait_for(lambda: ann.id in eve.positions)
        await eve.wait_for(lambda: ann.id not in eve.positions)
        assert server.world.count()[0] == 1


async def test_a_token_in_use_replaces_the_first_connection(serving: Serving) -> None:
    async with serving() as server, joined(server.port, "Ann") as first:
        assert first.welcome is not None
        async with joined(server.port, "Ann", resume=first.welcome.resume) as second:
            assert second.id == first.id
            messages, code = await first.last_words()
            assert code == CloseCode.REPLACED
            assert [m.reason for m in messages if isinstance(m, Bye)] == [ByeCode.REPLACED]
            await second.move(0.0, 1.0)
            await second.wait_for(lambda: second.ack == 1)
            assert server.world.count()[0] == 1


async def test_who_was_replaced_moves_the_avatar_no_more(serving: Serving) -> None:
    async with serving() as server, joined(server.port, "Ann", at=(2.0, 2.0, 0)) as first:
        assert first.welcome is not None
        # Its answer to the closing handshake is held back, as a faulty client would.
        first.connection.transport.pause_reading()
        async with joined(server.port, "Ann", resume=first.welcome.resume) as second:
            stood = second.position
            await first.move(0.0, 3.0)
            await second.ticks(5)
            assert second.position == stood
            assert second.ack == 0
        first.connection.transport.abort()


async def test_of_two_who_come_back_at_once_the_later_is_welcomed_once(serving: Serving) -> None:
    async with serving(tick_rate=5) as server, joined(server.port, "Ann") as first:
        assert first.welcome is not None
        hello = Hello(name="Ann", version=VERSION, resume=first.welcome.resume)
        async with connected(server.port) as second, connected(server.port) as third:
            await asyncio.gather(second.send(hello), third.send(hello))
            ends = [asyncio.create_task(c.connection.wait_closed()) for c in (second, third)]
            await asyncio.wait(ends, return_when=asyncio.FIRST_COMPLETED)
            winner = third if second.connection.close_code else second
            await winner.until(Welcome)
            assert not [m for m in [await winner.next() for _ in range(5)] if type(m) is Welcome]


async def test_an_unknown_token_is_a_new_person(serving: Serving) -> None:
    async with serving() as server, joined(server.port, resume="no such token") as client:
        assert client.welcome is not None
        assert not client.welcome.resumed


async def test_a_full_world_turns_people_away_but_lets_its_own_back_in(serving: Serving) -> None:
    async with serving(max_clients=1) as server:
        async with joined(server.port, "Ann") as ann:
            async with connected(server.port) as late:
                await late.send(Hello(name="Late", version=VERSION))
                assert await late.refusal() == ("server_full", CloseCode.SERVER_FULL)
            ann.connection.transport.abort()
        assert ann.welcome is not None
        async with joined(server.port, "Ann", resume=ann.welcome.resume) as again:
            assert again.id == ann.id


async def test_who_goes_while_the_zone_makes_the_avatar_leaves_nobody_behind(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    made, go_on = threading.Event(), threading.Event()
    async with serving(actors=1) as server, joined(server.port) as client:

        def think(*_: object) -> None:
            if server.world.people_seen == 2:
                made.set()
                assert go_on.wait(PATIENCE_S)

        monkeypatch.setattr(Population, "advance", think)
        async with connected(server.port) as shy:
            await shy.send(Hello(name="Shy", version=VERSION))
            assert await asyncio.to_thread(made.wait, PATIENCE_S)
        async with asyncio.timeout(PATIENCE_S):
            # No tick ends meanwhile, so that no client hears anything.
            while b"esplanade_joining 0.0" not in server.metrics.exposition():  # noqa: ASYNC110
                await asyncio.sleep(0.01)
        go_on.set()
        await client.wait_for(lambda: server.world.count()[0] == 1)
        await client.ticks(2)
        assert server.world.people_seen == 2


async def test_who_leaves_at_the_door_leaves_nobody_behind(serving: Serving) -> None:
    async with serving() as server, joined(server.port) as client:
        for _ in range(30):
            async with connected(server.port) as shy:
                await shy.send(Hello(name="Shy", version=VERSION))
        await client.wait_for(lambda: server.world.count()[0] == 1)
        await client.until(Snapshot)
        assert server.world.count()[0] == 1
