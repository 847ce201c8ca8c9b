"""Ways into a closed world, and what a pass and a bot's token bring, on real sockets."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest
from websockets.asyncio.client import connect

from esplanade import bots
from esplanade.planning import Door
from esplanade.protocol import VERSION
from esplanade.protocol.messages import Admission, Doors, Error, Hello, SetDoor, Welcome
from esplanade.server.accounts.identity import MACHINE, Identity
from esplanade.server.accounts.lockout import WRONG
from esplanade.server.accounts.rights import ROLES
from esplanade.server.app import Running
from esplanade.server.audit.log import Filter
from tests.server.client import Client
from tests.server.conftest import Serving
from tests.server.console.browsers import PASSWORD, Browser, codes, logged_in
from tests.server.console.operators import operator
from tests.server.http import get
from tests.server.worlds import ROOM

NEEDED = ("admission_needed", 4020)
REFUSED = ("admission_refused", 4022)
WORLD = "the password of the world"


GATED = ROOM.model_copy(
    update={"doors": (Door(name="gate", start=(10.0, 15.0), end=(10.0, 20.0)),)}
)


@asynccontextmanager
async def greeting(
    server: Running, way: Any = None, secret: str = "", headers: Any = None, **more: Any
) -> AsyncIterator[Client]:
    """A connection that has said hello, and shown something."""
    admission = Admission(way=way, secret=secret) if way else None
    url = f"ws://127.0.0.1:{server.port}/ws"
    async with connect(url, additional_headers=headers) as connection:
        client = Client(connection)
        hello = {"name": "Ann", "version": VERSION, "admission": admission, **more}
        await client.send(Hello(**hello))
        yield client


async def refusal(server: Running, *given: Any, **more: Any) -> tuple[str, int | None]:
    async with greeting(server, *given, **more) as client:
        return await client.refusal()


async def comes_in(server: Running, *given: Any, **more: Any) -> Welcome:
    """The welcome of a client whose connection is lost afterwards."""
    async with greeting(server, *given, **more) as client:
        welcome = await client.until(Welcome)
        client.connection.transport.abort()
        return welcome


async def test_an_open_world_asks_for_nothing(serving: Serving) -> None:
    async with serving() as server:
        assert (await comes_in(server)).name == "Ann"
        assert (await comes_in(server, "password", "whatever")).name.startswith("Ann")


async def test_a_closed_world_says_what_it_wants(serving: Serving) -> None:
    async with serving(closed=True, operator_key="key") as server:
        assert await refusal(server) == NEEDED
        assert await refusal(server, "password", "guess") == NEEDED
        assert await refusal(server, operator="key") == NEEDED
        assert await refusal(server, resume="x" * 32) == NEEDED
        metrics = (await get(server.private_port, "/metrics")).body
        assert b"esplanade_admissions_refused_total 4.0" in metrics


async def test_an_invitation_lets_in_as_many_as_it_says(serving: Serving) -> None:
    async with serving(closed=True, resume_seconds=30.0) as server:
        mona = await logged_in(server, "mona", "moderator")
        body = {"label": "for the class", "uses": 2, "expires_hours": 1}
        status, made = await mona.send("POST", "/invitations", body)
        assert status == 201
        url, _, secret = made["url"].partition("#invitation=")
        assert url == f"http://localhost:{server.port}/"
        first = await comes_in(server, "invitation", secret)
        await comes_in(server, "invitation", secret)
        assert await refusal(server, "invitation", secret) == REFUSED
        back = await comes_in(server, resume=first.resume)
        assert back.resumed
        _, found = await mona.send("GET", "/invitations")
        (facts,) = found["invitations"]
        assert (facts["used"], facts["uses"], facts["by"]) == (2, 2, "mona")
        assert secret not in str(found)


async def test_a_revoked_or_unknown_invitation_lets_nobody_in(serving: Serving) -> None:
    async with serving(closed=True) as server:
        mona = await logged_in(server, "mona", "moderator")
        _, made = await mona.send("POST", "/invitations", {})
        secret = made["url"].partition("#invitation=")[2]
        assert (await mona.send("DELETE", f"/invitations/{made['id']}"))[0] == 204
        status, body = await mona.send("DELETE", f"/invitations/{made['id']}")
        assert (status, codes(body)) == (404, ["unknown"])
        for given in (secret, f"{secret}x", "x"):
            assert await refusal(server, "invitation", given) == REFUSED


async def test_a_use_that_led_nowhere_is_given_back(serving: Serving) -> None:
    async with serving(closed=True) as server:
        invitations = server.kept.invitations
        _, secret = await invitations.add(MACHINE, label=None, uses=1, lasts_us=10**9)
        assert await refusal(server, "invitation", secret, name="Admin") == ("name_reserved", 4011)
        assert (await invitations.list())[0].used == 0
        await comes_in(server, "invitation", secret)
        assert (await invitations.list())[0].used == 1


async def test_one_use_lets_one_of_many_in(serving: Serving) -> None:
    async with serving(closed=True) as server:
        _, secret = await server.kept.invitations.add(MACHINE, label=None, uses=1, lasts_us=10**9)

        async def tried() -> str:
            async with greeting(server, "invitation", secret) as client:
                message = await client.next()
                return type(message).__name__

        kinds = await asyncio.gather(*(tried() for _ in range(12)))
        assert sorted(kinds).count("Welcome") == 1
        assert kinds.count("Error") == 11


async def test_the_password_of_the_world_lets_in_and_guesses_are_braked(serving: Serving) -> None:
    async with serving(closed=True, world_password=WORLD) as server:
        assert await refusal(server) == ("password_needed", 4021)
        await comes_in(server, "password", WORLD)
        tries = [refusal(server, "password", f"guess {n}") for n in range(2 * WRONG)]
        assert set(await asyncio.gather(*tries)) == {REFUSED}
        assert await refusal(server, "password", WORLD) == REFUSED
        metrics = (await get(server.private_port, "/metrics")).body
        assert f"esplanade_world_passwords_wrong_total {WRONG}.0".encode() in metrics


async def test_a_hash_stands_for_the_password_of_the_world(serving: Serving) -> None:
    async with serving() as server:
        kept = await server.kept.passwords.hash(WORLD)
    async with serving(closed=True, world_password=kept) as server:
        await comes_in(server, "password", WORLD)
        assert await refusal(server, "password", kept) == REFUSED


async def test_an_identity_counts_from_a_trusted_proxy_only(serving: Serving) -> None:
    settings = {"closed": True, "identity_header": "X-Forwarded-User"}
    named = {"X-Forwarded-User": "ann@example.org"}
    async with serving(trusted_proxies="127.0.0.1", **settings) as server:
        await comes_in(server, headers=named)
        assert await refusal(server) == NEEDED
        assert await refusal(server, headers={"X-Forwarded-User": " "}) == NEEDED
        twice = [("X-Forwarded-User", "ann"), ("X-Forwarded-User", "eve")]
        assert await refusal(server, headers=twice) == NEEDED
        assert await refusal(server, headers={"X-Forwarded_User": "eve"}) == NEEDED
    async with serving(trusted_proxies="192.0.2.1", **settings) as server:
        assert await refusal(server, headers=named) == NEEDED
        spoofed = {**named, "X-Forwarded-For": "192.0.2.1"}
        assert await refusal(server, headers=spoofed) == NEEDED


async def test_a_pass_gives_a_seat_the_rights_of_an_operator_once(serving: Serving) -> None:
    async with serving(closed=True) as server:
        dora = await logged_in(server, "dora", "director")
        _, made = await dora.send("POST", "/passes")
        secret = made["url"].partition("#pass=")[2]
        welcome = await comes_in(server, "pass", secret)
        assert welcome.operator
        assert await refusal(server, "pass", secret) == REFUSED
        back = await comes_in(server, "pass", secret, resume=welcome.resume)
        assert (back.operator, back.resumed) == (True, True)
        assert (await comes_in(server, resume=back.resume)).operator
        viewer = Identity(account="dora", role="viewer", rights=ROLES["viewer"], via="session")
        secret = await server.kept.one_time.seat_pass(viewer)
        await server.kept.directory.add(MACHINE, "anna", "admin", None)
        await server.kept.directory.set_role(MACHINE, "dora", "viewer")
        assert not (await comes_in(server, "pass", secret)).operator


async def test_doors_that_are_clicked_are_in_the_audit_and_end_with_the_right(
    serving: Serving, tmp_path: Path
) -> None:
    scene = tmp_path / "gated.json"
    scene.write_text(GATED.model_dump_json())
    async with serving(scene=scene) as server:
        dora = await logged_in(server, "dora", "director")
        _, made = await dora.send("POST", "/passes")
        async with greeting(server, "pass", made["url"].partition("#pass=")[2]) as client:
            welcome = await client.until(Welcome)
            assert welcome.operator
            assert welcome.doors == {"gate": True}
            await client.send(SetDoor(name="gate", open=False))
            assert (await client.until(Doors)).doors == {"gate": False}
            rows = (await server.kept.audit.page(Filter(command="move_door"))).rows
            assert {row.account for row in rows} == {"dora"}
            await server.kept.directory.set_role(MACHINE, "dora", "tuner")
            await client.send(SetDoor(name="gate", open=True))
            assert (await client.until(Error)).error == "forbidden"
            assert server.world.doors.states() == {"gate": False}


async def test_the_operator_key_moves_doors_by_commands_that_are_in_the_audit(
    serving: Serving, tmp_path: Path
) -> None:
    scene = tmp_path / "gated.json"
    scene.write_text(GATED.model_dump_json())
    async with serving(scene=scene, operator_key="the key") as server:
        async with greeting(server, operator="the key") as client:
            assert (await client.until(Welcome)).operator
            await client.send(SetDoor(name="gate", open=False))
            assert (await client.until(Doors)).doors == {"gate": False}
        rows = (await server.kept.audit.page(Filter(command="move_door"))).rows
        assert {(row.account, row.role) for row in rows} == {("key", "doors")}
        olga = await operator(server, "olga", "viewer")
        _, answer = await olga.get("/changes")
        assert [each["account"] for each in answer["changes"]] == ["key"]


async def test_a_bot_comes_in_by_its_token_and_at_its_rate(serving: Serving) -> None:
    async with serving(closed=True, message_rate=5.0) as server:
        anna = await logged_in(server, "anna", "admin")
        body = {"name": "crowd", "message_rate": 500, "connections": 2}
        status, made = await anna.send("POST", "/bots", body)
        assert status == 201
        token = made["token"]
        async with greeting(server, "bot", token) as one, greeting(server, "bot", token) as two:
            await one.until(Welcome)
            await two.until(Welcome)
            assert await refusal(server, "bot", token) == REFUSED
            for _ in range(200):
                await one.move(0.0, 1.0)
            await one.ticks(10)
        await comes_in(server, "bot", token)
        assert (await anna.send("DELETE", "/bots/crowd"))[0] == 204
        assert await refusal(server, "bot", token) == REFUSED
        _, found = await anna.send("GET", "/bots")
        assert found == {"bots": []}


async def test_a_bot_of_the_python_client_comes_in_by_its_token(serving: Serving) -> None:
    async with serving(closed=True) as server:
        token = await server.kept.bots.add(
            MACHINE, "crowd", message_rate=60, connections=1, lasts_us=10**9
        )
        url = f"ws://127.0.0.1:{server.port}"
        with pytest.raises(bots.Refused):
            async with bots.connect(url, "Bot"):
                pass
        async with bots.connect(url, "Bot", token=token) as bot:
            assert bot.welcome.name == "Bot"


async def test_a_token_of_an_operator_is_none_of_a_bot_and_no_way_in(serving: Serving) -> None:
    async with serving(closed=True) as server:
        olga = await operator(server, "olga", "admin")
        await server.kept.directory.set_password(MACHINE, "olga", PASSWORD)
        browser = Browser(server.private_port)
        await browser.log_in("olga")
        for way in ("bot", "invitation", "pass"):
            assert await refusal(server, way, olga.token) == REFUSED
            assert await refusal(server, way, browser.cookie) == REFUSED
