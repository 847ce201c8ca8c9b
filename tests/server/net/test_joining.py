"""People come in: their names, places, keys and seats."""

import asyncio
import math
from contextlib import AsyncExitStack
from pathlib import Path

import pytest
import structlog

from esplanade.protocol import VERSION, CloseCode, ErrorCode, encode
from esplanade.protocol.messages import Error, Hello, Ping, Pong, Snapshot, Welcome
from esplanade.server.net.operator_keys import WRONG_KEYS
from esplanade.server.world.spawning import NoRoomError
from tests.server.client import PLACING_KEY, Client, connected, joined
from tests.server.conftest import Serving


async def welcomed(client: Client, hello: Hello) -> Welcome:
    await client.send(hello)
    return await client.until(Welcome)


# --- vacant seats ---------------------------------------------------------------------------------


async def test_vacant_seats_yield_to_newcomers_when_the_world_is_full(serving: Serving) -> None:
    async with serving(max_clients=3) as server, joined(server.port, "Eve") as eve:
        for name in ("Ann", "Ben"):
            async with joined(server.port, name) as ghost:
                ghost.connection.transport.abort()
        async with AsyncExitStack() as stack:
            for name in ("Cleo", "Dan"):
                await stack.enter_async_context(joined(server.port, name))
            await eve.wait_for(lambda: server.world.count()[0] == 3)
            assert b"esplanade_seats_yielded_total 2.0" in server.metrics.exposition()
            async with connected(server.port) as late:
                await late.send(Hello(name="Late", version=VERSION))
                assert await late.refusal() == ("server_full", CloseCode.SERVER_FULL)


async def test_whoever_finds_no_place_to_stand_is_told_so(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with serving() as server, joined(server.port, "Ann") as ann:

        def nowhere(*_: object) -> None:
            raise NoRoomError("no place is left")

        with monkeypatch.context() as patch:
            patch.setattr(server.world._spawning, "place", nowhere)
            async with connected(server.port) as ben:
                await ben.send(Hello(name="Ben", version=VERSION))
                assert await ben.refusal() == ("server_full", CloseCode.SERVER_FULL)
        # The name is free again, and those who are in notice nothing.
        async with joined(server.port, "Ben") as again:
            assert again.welcome is not None
            assert again.welcome.name == "Ben"
            await ann.wait_for(lambda: again.id in ann.entities)


async def test_a_seat_that_was_given_up_is_a_new_avatar(serving: Serving) -> None:
    async with serving(max_clients=1) as server:
        async with joined(server.port, "Ann") as ann:
            ann.connection.transport.abort()
        async with joined(server.port, "Ben") as ben:
            assert ben.entities.keys() == {ben.id}
        assert ann.welcome is not None
        async with joined(server.port, "Ann", resume=ann.welcome.resume) as again:
            assert again.welcome is not None
            assert not again.welcome.resumed


# --- resume tokens --------------------------------------------------------------------------------


async def test_a_lost_welcome_loses_no_avatar(serving: Serving) -> None:
    async with serving() as server:
        async with joined(server.port, "Ann") as ann:
            ann.connection.transport.abort()
        assert ann.welcome is not None
        token = ann.welcome.resume
        for _ in range(3):
            async with connected(server.port) as lost:
                welcome = await welcomed(lost, Hello(name="Ann", version=VERSION, resume=token))
                assert (welcome.id, welcome.resumed) == (ann.id, True)
                assert welcome.resume != token
                lost.connection.transport.abort()
        async with joined(server.port, "Ann", resume=token) as again:
            assert again.id == ann.id
            assert server.world.count()[0] == 1


async def test_the_old_token_is_void_once_the_new_one_was_used(serving: Serving) -> None:
    async with serving() as server:
        async with joined(server.port, "Ann") as ann:
            ann.connection.transport.abort()
        assert ann.welcome is not None
        tokens = [ann.welcome.resume]
        for _ in range(2):
            async with connected(server.port) as again:
                hello = Hello(name="Ann", version=VERSION, resume=tokens[-1])
                tokens.append((await welcomed(again, hello)).resume)
                again.connection.transport.abort()
        async with joined(server.port, "Ann", resume=tokens[0]) as stranger:
            assert stranger.id != ann.id
        async with joined(server.port, "Ann", resume=tokens[-1]) as owner:
            assert owner.id == ann.id


async def test_the_old_token_is_void_once_the_client_has_shown_that_it_is_there(
    serving: Serving,
) -> None:
    async with serving() as server:
        async with joined(server.port, "Ann") as ann:
            ann.connection.transport.abort()
        assert ann.welcome is not None
        old = ann.welcome.resume
        async with joined(server.port, "Ann", resume=old) as again:
            await again.send(Ping(nonce=1))
            await again.until(Pong)
            async with joined(server.port, "Ann", resume=old) as stranger:
                assert stranger.id != again.id
            await again.ticks(2)


# --- places ---------------------------------------------------------------------------------------


async def test_a_wish_for_a_place_is_no_teleport(serving: Serving) -> None:
    async with serving() as server:
        for _ in range(3):
            async with connected(server.port) as client:
                hello = Hello(name="Ann", version=VERSION, at=(18.0, 5.0, 0.0))
                await welcomed(client, hello)
                await client.until(Snapshot)
                assert math.dist(client.position, (3.0, 3.0)) <= 1.1


async def test_an_operator_comes_in_where_they_wish(serving: Serving) -> None:
    async with serving() as server, connected(server.port) as client:
        hello = Hello(name="Ann", version=VERSION, at=(18.0, 5.0, 0.0), operator=PLACING_KEY)
        await welcomed(client, hello)
        await client.until(Snapshot)
        assert client.position == pytest.approx((18.0, 5.0), abs=0.01)


async def test_in_the_world_of_a_recorded_crowd_everyone_comes_in_where_they_wish(
    serving: Serving, tmp_path: Path
) -> None:
    crowd = tmp_path / "crowd.csv"
    rows = [
        f"{0.4 * k},{person},{0.5 * k + person},{2 * person}" for person in (1, 2) for k in range(9)
    ]
    crowd.write_text("t,id,x,y\n" + "\n".join(rows) + "\n")
    async with serving(scene=None, crowd=crowd) as server, connected(server.port) as client:
        await welcomed(client, Hello(name="Ann", version=VERSION, at=(4.0, 3.0, 0.0)))
        await client.until(Snapshot)
        assert client.position == pytest.approx((4.0, 3.0), abs=0.01)


# --- operator keys --------------------------------------------------------------------------------


async def test_wrong_keys_are_counted_logged_and_slowed_but_nobody_is_kept_out(
    serving: Serving,
) -> None:
    guesses = [f"guess-{k}" for k in range(WRONG_KEYS)]
    with structlog.testing.capture_logs() as logs:
        async with serving() as server:
            for guess in guesses:
                async with connected(server.port) as client:
                    hello = Hello(name="Ann", version=VERSION, operator=guess)
                    assert not (await welcomed(client, hello)).operator
            async with connected(server.port) as client:
                hello = Hello(name="Ann", version=VERSION, operator=PLACING_KEY)
                assert not (await welcomed(client, hello)).operator
                error = await client.until(Error)
                assert (error.error, "try again in" in error.text) == (ErrorCode.KEY_UNREAD, True)
                await client.until(Snapshot)
            text = server.metrics.exposition()
    assert b'esplanade_operator_keys_refused_total{why="wrong"} 5.0' in text
    assert b'esplanade_operator_keys_refused_total{why="unread"} 1.0' in text
    wrong = [entry for entry in logs if entry["event"] == "wrong operator key"]
    assert [entry["address"] for entry in wrong] == ["127.0.0.1"] * WRONG_KEYS
    assert not any(key in str(logs) for key in [*guesses, PLACING_KEY])


# --- names ----------------------------------------------------------------------------------------


async def test_people_of_one_name_are_told_apart(serving: Serving) -> None:
    async with (
        serving() as server,
        joined(server.port, "Ann") as ann,
        joined(server.port, "Аnn") as cyrillic,
        joined(server.port, "ANN") as loud,
    ):
        names = [client.welcome.name for client in (ann, cyrillic, loud) if client.welcome]
        assert names == ["Ann", "Аnn 2", "ANN 3"]
        assert {entity.name for entity in loud.entities.values()} == set(names)


async def test_a_name_is_free_again_when_its_avatar_is_gone(serving: Serving) -> None:
    async with serving(resume_seconds=0.2) as server, joined(server.port, "Eve") as eve:
        async with joined(server.port, "Ann"):
            pass
        async with joined(server.port, "Ann") as ann:
            assert ann.welcome is not None
            assert ann.welcome.name == "Ann"
            ann.connection.transport.abort()
        await eve.wait_for(lambda: server.world.count()[0] == 1)
        async with connected(server.port) as shy:
            await shy.send(Hello(name="Ann", version=VERSION))
        await eve.ticks(3)
        async with joined(server.port, "Ann") as ann:
            assert ann.welcome is not None
            assert ann.welcome.name == "Ann"


async def test_an_actors_name_is_its_own(serving: Serving) -> None:
    async with serving(actors=1) as server:
        actor = server.world.actor_names[0]
        async with joined(server.port, actor.upper()) as client:
            assert client.welcome is not None
            assert client.welcome.name == f"{actor.upper()} 2"


@pytest.mark.parametrize("name", ["server", "аdmin", "Operator 2"])
async def test_names_of_the_world_itself_are_refused(serving: Serving, name: str) -> None:
    async with serving() as server, connected(server.port) as client:
        await client.send(Hello(name=name, version=VERSION))
        assert await client.refusal() == ("name_reserved", CloseCode.NAME_RESERVED)


@pytest.mark.parametrize(
    "name",
    ["   ", "\u3164", "A" + 31 * "\u0301"],
    ids=["spaces", "filler", "accents"],
)
async def test_a_name_that_is_none_is_refused_with_the_reason(serving: Serving, name: str) -> None:
    frame = encode(Hello(name="Ann", version=VERSION)).replace(b"\xa3Ann", packed(name))
    async with serving() as server, connected(server.port) as client:
        await client.connection.send(frame)
        error = await client.until(Error)
        assert error.error is ErrorCode.INVALID
        assert error.text.startswith("hello: name: ")


def packed(text: str) -> bytes:
    """A short text as msgpack has it."""
    data = text.encode()
    return bytes([0xD9, len(data)]) + data


async def test_many_of_one_name_come_in_together(serving: Serving) -> None:
    async with serving() as server, AsyncExitStack() as stack:
        clients = [await stack.enter_async_context(connected(server.port)) for _ in range(20)]
        hello = Hello(name="Bot", version=VERSION)
        welcomes = await asyncio.gather(*(welcomed(client, hello) for client in clients))
        assert len({welcome.name for welcome in welcomes}) == len(clients)
