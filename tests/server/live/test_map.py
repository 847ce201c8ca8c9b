"""The live map, on real sockets: everybody is where the world has them, and who may see it."""

import asyncio
from typing import Any

import pytest
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed, InvalidStatus

from esplanade.server.accounts.identity import MACHINE
from esplanade.server.accounts.rights import Right
from esplanade.server.app import Running
from esplanade.server.console import callers, live_socket
from tests.patience import PATIENCE_S
from tests.server.client import joined
from tests.server.conftest import Serving
from tests.server.console.operators import operator
from tests.server.live.consoles import LiveConsole, live_console


def _agrees(console: LiveConsole, server: Running) -> bool:
    """Whether a console has everybody who is in the world, where they were in its last frame."""
    live = server.world.state.ids[server.world.state.live()].tolist()
    return set(console.entities) == set(console.records) == set(live)


async def test_a_console_sees_everybody_come_move_and_go(serving: Serving) -> None:
    async with serving(actors=3) as server:
        vera = await operator(server, "vera", "viewer")
        async with live_console(server.private_port, vera.token) as console:
            await console.subscribe("map")
            await console.until(lambda: _agrees(console, server) and console.records)
            assert console.told[0]["channel"] == "hello"
            assert console.frames[0][0], "the first frame has everybody"
            assert {each["actor"] for each in console.entities.values()} == {
                f"main/actor-{k}" for k in (1, 2, 3)
            }
            async with joined(server.port, "Eve") as eve:
                who = eve.id
                await console.until(lambda: who in console.records)
                assert console.entities[who]["name"] == "Eve"
                assert console.entities[who]["kind"] == "person"
            await console.until(lambda: who not in console.entities or None)
            ticks = [tick for _, tick, _ in console.frames]
            assert ticks == sorted(set(ticks))


async def test_only_those_who_moved_are_sent_and_everybody_now_and_then(serving: Serving) -> None:
    async with serving(actors=1) as server:
        vera = await operator(server, "vera", "viewer")
        async with (
            joined(server.port, "Eve") as eve,
            live_console(server.private_port, vera.token) as console,
        ):
            await console.subscribe("map", hz=5)
            await console.until(lambda: eve.id in console.records)
            console.frames.clear()
            await console.until(lambda: sum(key for key, _, _ in console.frames) >= 2)
            between = [records for key, _, records in console.frames if not key]
            assert all(eve.id not in records["id"] for records in between)
            assert all(eve.id in records["id"] for key, _, records in console.frames if key)


async def test_the_plan_of_the_scene_has_walls_doors_and_places(serving: Serving) -> None:
    async with serving() as server:
        vera = await operator(server, "vera", "viewer")
        status, plan = await vera.get("/map")
        scene = server.world.scene
        assert status == 200
        assert plan["bounds"] == list(scene.bounds)
        assert len(plan["walls"]) == len(scene.walls)
        assert [each["name"] for each in plan["doors"]] == [each.name for each in scene.doors]
        assert len(plan["storeys"]) == len(plan["outlines"]) == len(plan["floors"])


async def test_names_of_people_are_hidden_from_whoever_does_not_moderate(serving: Serving) -> None:
    async with serving(hide_names=True) as server, joined(server.port, "Eve") as eve:
        vera = await operator(server, "vera", "viewer")
        mo = await operator(server, "mo", "moderator")
        shown = {}
        for who in (vera, mo):
            async with live_console(server.private_port, who.token) as console:
                await console.subscribe("map")
                await console.until(lambda: eve.id in console.entities)
                shown[who.token] = console.entities[eve.id]["name"]
                _, people = await who.get("/people")
                assert people["people"][0]["name"] == shown[who.token]
        assert shown == {vera.token: f"Person {eve.id}", mo.token: "Eve"}


@pytest.mark.parametrize(
    ("sent", "code"),
    [
        ("no json", "invalid"),
        ('{"subscribe": "nothing"}', "invalid"),
        ('{"subscribe": "map", "hz": 11}', "invalid"),
        ("[" * 30_000, "invalid"),
        ('{"subscribe": "map", "more": 1}', "invalid"),
    ],
)
async def test_what_means_nothing_is_refused_and_the_socket_goes_on(
    serving: Serving, sent: str, code: str
) -> None:
    async with serving(actors=1) as server:
        vera = await operator(server, "vera", "viewer")
        async with live_console(server.private_port, vera.token) as console:
            await console.socket.send(sent)
            told: Any = await console.until(
                lambda: next((each for each in console.told if "faults" in each), None)
            )
            assert told["faults"][0]["code"] == code
            await console.subscribe("map")
            await console.until(lambda: console.records)


async def test_no_more_than_sixteen_subscriptions(serving: Serving) -> None:
    async with serving(actors=1) as server:
        vera = await operator(server, "vera", "viewer")
        async with live_console(server.private_port, vera.token) as console:
            for number in range(17):
                await console.subscribe(f"actor:main/a{number}")
            told = await console.until(
                lambda: next(
                    (each for each in console.told if each.get("channel") == "actor:main/a16"), None
                )
            )
            assert told["faults"][0]["code"] == "too_many"


async def test_who_has_no_token_or_comes_from_another_page_gets_no_socket(
    serving: Serving,
) -> None:
    async with serving() as server:
        vera = await operator(server, "vera", "viewer")
        address = f"ws://127.0.0.1:{server.private_port}/api/v1/live"
        await server.kept.directory.add(MACHINE, "blind", "admin", None)
        one = frozenset({Right.AUDIT})
        blind = await server.kept.tokens.add(MACHINE, "blind", "one", rights=one)
        for headers in (
            {},
            {"Authorization": f"Bearer {blind}"},
            {"Cookie": f"esplanade_session={'x' * 43}", "Origin": address.replace("ws", "http")},
            {"Authorization": "Bearer esplanade_wrong"},
            {"Authorization": f"Bearer {vera.token}", "Origin": "https://elsewhere.example"},
        ):
            with pytest.raises(InvalidStatus) as refused:
                async with connect(address, additional_headers=headers):
                    pass
            assert refused.value.response.status_code == 403
        own = {"Origin": f"http://127.0.0.1:{server.private_port}"}
        async with live_console(server.private_port, vera.token, headers=own) as console:
            await console.until(lambda: console.told)


async def test_a_socket_ends_when_its_token_does(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(callers, "RENEWED_S", 0.1)
    async with serving() as server:
        vera = await operator(server, "vera", "viewer")
        async with live_console(server.private_port, vera.token) as console:
            await console.until(lambda: console.told)
            await server.kept.tokens.revoke(MACHINE, "vera", "script")
            with pytest.raises(ConnectionClosed):
                await console.until(lambda: False)
            assert console.socket.close_code == live_socket.IDENTITY_ENDED


async def test_a_console_that_does_not_read_is_closed_and_delays_nobody(serving: Serving) -> None:
    async with serving(actors=5) as server:
        vera = await operator(server, "vera", "viewer")
        async with (
            live_console(server.private_port, vera.token, max_queue=1) as deaf,
            live_console(server.private_port, vera.token) as console,
        ):
            await deaf.subscribe("map")
            await deaf.subscribe("changes")
            await deaf.until(lambda: deaf.records)
            deaf.socket.transport.pause_reading()
            await console.subscribe("map")
            async with asyncio.timeout(PATIENCE_S):
                while not server.live.too_slow:
                    for _ in range(32):
                        server.live.bulletin.change({"note": "x" * 4096})
                    seen = len(console.frames)
                    await console.until(lambda seen=seen: len(console.frames) > seen)
            assert server.live.map_frames_dropped > 0
            before = server.world.tick
            await console.until(lambda: console.frames[-1][1] > before + 5)
            deaf.socket.transport.resume_reading()
            with pytest.raises(ConnectionClosed):
                await deaf.until(lambda: False)
            assert deaf.socket.close_code == live_socket.TOO_SLOW
