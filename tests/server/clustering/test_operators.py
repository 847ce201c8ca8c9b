"""Operators work in a cluster as in one process: at any gateway, in every zone, after takeovers."""

import asyncio
import json
import time
from collections.abc import Awaitable, Callable
from contextlib import suppress
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed

from esplanade.protocol import VERSION, CloseCode, ErrorCode, NoticeCode
from esplanade.protocol.messages import (
    Bye,
    Chat,
    ChatLine,
    Error,
    Hello,
    Hide,
    MutePerson,
    Notice,
    Report,
    ServerMessage,
    Travel,
)
from tests.patience import PATIENCE_S
from tests.server.client import Client, connected, joined
from tests.server.clustering.clusters import Cluster, said
from tests.server.clustering.people import back, go_on, sees, walk
from tests.server.console.operators import Operator
from tests.server.http import get
from tests.server.live.consoles import live_console
from tests.server.zones import BEFORE_GATE

PLACE = (6.0, 10.0, 0)
OTHER = (6.0, 12.0, 0)
SET = {"op": "set_parameters", "scope": "world", "values": {"risk_weight": 12}}


async def settled(asked: Callable[[], Awaitable[tuple[int, Any]]]) -> Any:
    """Ask again while no host has the zone; returns the body of the first answer of success."""
    async with asyncio.timeout(PATIENCE_S):
        while True:
            status, body = await asked()
            if status == 200:
                return body
            assert status in {503, 504}, body
            await asyncio.sleep(0.1)


async def notice(client: Client, code: NoticeCode) -> Notice:
    """The next notice of a kind."""
    while True:
        said = await client.until(Notice)
        if said.notice is code:
            return said


async def reports(moderator: Operator) -> list[dict[str, Any]]:
    """The reports in the inbox of a zone, as soon as there are any."""
    async with asyncio.timeout(PATIENCE_S):
        while True:
            found = await settled(lambda: moderator.get("/reports"))
            if found["reports"]:
                return list(found["reports"])
            await asyncio.sleep(0.1)


async def _until(ask: Callable[[], Awaitable[Any]], holds: Callable[[Any], bool]) -> None:
    """Ask again until it holds."""
    async with asyncio.timeout(PATIENCE_S):
        while not holds(await ask()):  # noqa: ASYNC110 - nothing tells of it
            await asyncio.sleep(0.1)


async def _of_world(asked: Operator, name: str) -> Any:
    return (await settled(lambda: asked.get("/world")))[name]


def weight(values: dict[str, Any]) -> float:
    return float(values["risk_weight"])


async def test_what_is_set_holds_after_another_host_has_taken_the_zone(at_town: Cluster) -> None:
    east, west = at_town.gateways
    olga = at_town.operator("admin", east, "yard")
    vera = at_town.operator("viewer", west, "yard")
    usual = weight(await olga.values("yard/actor-1"))
    status, answer = await olga.send({**SET, "note": "for the takeover"})
    assert status == 200, answer
    assert weight(await vera.values("yard/actor-1")) == 12.0 != usual
    status, refused = await vera.send({**SET, "values": {"risk_weight": 3}})
    assert (status, refused["faults"][0]["code"]) == (403, "forbidden")
    hall = Operator(olga.port, olga.token, "hall")
    assert weight(await hall.values("hall/actor-1")) == usual
    epoch = at_town.owner("yard")[1]
    at_town.owning("yard").kill()
    await at_town.taken_over("yard", epoch)
    actor = await settled(lambda: olga.get("/actors/yard/actor-1"))
    assert actor["parameters"]["risk_weight"]["value"] == 12.0
    _, found = await vera.get("/changes")
    (change,) = [one for one in found["changes"] if one["number"] == answer["command"]]
    assert change["note"] == "for the takeover"
    status, reverted = await olga.send({"op": "revert", "change": answer["command"]})
    assert status == 200, reverted
    assert weight(await olga.values("yard/actor-1")) == usual
    # One audit has all of it, with the zone and each of its owners.
    status, page = await Operator(west.private_port, olga.token).get("/audit?limit=1000")
    assert status == 200
    own = [row for row in page["rows"] if row["account"] and row["writer"] == "zone yard"]
    told = [(row["command"], row["outcome"]) for row in reversed(own)]
    assert told[-4:] == [
        ("set_parameters", ""),
        ("set_parameters", "done"),
        ("revert", ""),
        ("revert", "done"),
    ]
    starts = [row["body"]["epoch"] for row in page["rows"] if row["command"] == "zone_start"]
    assert epoch in starts
    assert max(starts) > epoch
    assert (await olga.get("/audit/verify"))[1]["faults"] == []
    words = ["op", "audit", "--command", "revert", "--store", at_town.database]
    listed = await asyncio.to_thread(said, words)
    assert "revert" in listed.output


async def test_all_that_goes_on_goes_on_at_another_host(at_town: Cluster) -> None:
    olga = at_town.operator("admin", zone="yard")
    risk = {"op": "set_parameters", "scope": "world", "values": {"risk_weight": 4}}
    ramp = {**risk, "values": {"foresight_s": 4.0}, "over_s": 3600.0}
    for command in (
        {**risk, "guard": {"figure": "people", "above": 500}},
        {"op": "schedule", "when": {"after_s": 3600}, "commands": [risk]},
        {"op": "pace", "factor": 0.5},
        {"op": "move_door", "door": "shed", "open": False},
        ramp,
    ):
        status, answer = await olga.send(command)
        assert status == 200, answer
    _, before = await olga.get("/schedules")
    at_first = (await olga.values("yard/actor-1"))["foresight_s"]
    epoch = at_town.owner("yard")[1]
    at_town.owning("yard").kill()
    await at_town.taken_over("yard", epoch)
    world = await settled(lambda: olga.get("/world"))
    assert world["pace"]["factor"] == 0.5
    await _until(lambda: _of_world(olga, "doors"), {"shed": False}.__eq__)
    _, after = await olga.get("/schedules")
    assert (after["schedules"], after["guards"]) == (before["schedules"], before["guards"])
    assert weight(await olga.values("yard/actor-1")) == 4.0
    await _until(lambda: olga.values("yard/actor-1"), lambda now: now["foresight_s"] != at_first)
    for command in (
        {"op": "revert", "change": answer["command"]},
        {"op": "revert"},
        {"op": "pace", "factor": 1.0},
        {"op": "move_door", "door": "shed", "open": True},
        {"op": "cancel_schedule", "id": after["schedules"][0]["id"]},
    ):
        status, answer = await olga.send(command)
        assert status == 200, answer


async def test_an_owner_that_was_frozen_carries_out_no_command(at_town: Cluster) -> None:
    olga = at_town.operator("admin", zone="yard")
    owner, epoch = at_town.owning("yard"), at_town.owner("yard")[1]
    owner.freeze()
    waiting = asyncio.create_task(olga.send({**SET, "values": {"risk_weight": 7}}))
    await at_town.taken_over("yard", epoch)
    status, answer = await waiting
    assert status in {503, 504}, answer  # it was asked of the one that is frozen
    owner.thaw()
    await owner.told("the zone is another host's")
    actor = await settled(lambda: olga.get("/actors/yard/actor-1"))
    assert actor["parameters"]["risk_weight"]["value"] != 7.0
    status, answer = await olga.send({**SET, "values": {"risk_weight": 9}})
    assert status == 200, answer
    assert weight(await olga.values("yard/actor-1")) == 9.0
    assert (await olga.send({"op": "revert", "change": answer["command"]}))[0] == 200


async def test_all_zones_are_told_at_every_gateway_and_strangers_nothing(
    at_town: Cluster,
) -> None:
    east, west = at_town.gateways
    vera = at_town.operator("viewer", west)
    async with joined(east.port, "Ann", PLACE) as ann:
        await go_on(ann)
        status, found = await vera.get("/zones")
        assert (status, found["here"]) == (200, "yard")
        told = [
            (each["name"], each["scene"], each["people"], each["actors"]) for each in found["zones"]
        ]
        assert told == [("yard", "The yard", 1, 1), ("hall", "The hall", 0, 1)]
        (person,) = (await vera.get("/people"))[1]["people"]
        assert (person["id"], person["name"], person["muted_s"]) == (ann.id, "Ann", 0.0)
    attic = Operator(west.private_port, vera.token, "attic")
    status, refused = await attic.get("/world")
    assert (status, refused["faults"][0]["code"]) == (404, "no_such_zone")
    for token in ("", "esplanade_wrong"):
        assert (await Operator(west.private_port, token, "yard").get("/world"))[0] == 401
    no_header = {"Content-Type": "application/json"}
    assert (await vera.request("POST", "/commands", no_header, b"{}"))[0] == 403
    long = json.dumps({"op": "mark", "text": "x" * 70_000}).encode()
    headers = {**no_header, "X-Esplanade": "1"}
    own = {**headers, "Authorization": f"Bearer {vera.token}"}
    answer = await get(west.private_port, "/api/v1/commands", own, "POST", long)
    assert answer.status == 413
    assert (await vera.request("POST", "/commands", headers, b"{"))[0] == 422
    assert (await vera.get("/nothing"))[0] == 404
    assert (await vera.get("/audit"))[0] == 403
    for gateway in (east, west):
        page = await get(gateway.private_port, "/zones/hall/console/")
        assert page.status in {200, 503}  # 503 where the client is not built
        assert (await get(gateway.private_port, "/readyz")).status == 200


async def test_a_browser_logs_in_at_a_gateway_and_out_again(at_town: Cluster) -> None:
    admin = at_town.operator("admin")
    name, password = f"nora-{time.monotonic_ns()}", "correct horse battery"
    body = json.dumps({"name": name, "role": "tuner", "password": password}).encode()
    headers = {"X-Esplanade": "1", "Content-Type": "application/json"}
    assert (await admin.request("POST", "/accounts", headers, body))[0] == 201
    east, west = at_town.gateways
    here = f"http://localhost:{east.private_port}"
    login = json.dumps({"name": name, "password": password}).encode()
    answer = await get(
        east.private_port,
        "/api/v1/login",
        {**headers, "Origin": here, "Host": here[7:]},
        "POST",
        login,
    )
    assert answer.status == 200, answer.body
    cookie = answer.headers["set-cookie"].partition(";")[0]
    command = json.dumps({**SET, "dry_run": True}).encode()
    paths = "/api/v1/zones/hall/commands", "/api/v1/commands"
    own = {**headers, "Cookie": cookie, "Origin": here, "Host": here[7:]}
    for path in paths:
        done = await get(east.private_port, path, own, "POST", command)
        assert done.status == 200, done.body
        foreign = {**own, "Origin": "http://elsewhere.example"}
        assert (await get(east.private_port, path, foreign, "POST", command)).status == 403
    # The session is one for the whole cluster, and so is its end.
    there = f"localhost:{west.private_port}"
    at_west = {**own, "Origin": f"http://{there}", "Host": there}
    assert (await get(west.private_port, paths[1], at_west, "POST", command)).status == 200
    assert (await get(west.private_port, "/api/v1/logout", at_west, "POST")).status in {200, 204}
    assert (await get(east.private_port, paths[1], own, "POST", command)).status == 401


async def test_the_map_is_live_and_comes_again_after_a_takeover(at_town: Cluster) -> None:
    east, west = at_town.gateways
    vera = at_town.operator("viewer", west)
    async with joined(east.port, "Ann", PLACE) as ann:
        async with live_console(vera.port, vera.token, "/zones/yard") as console:
            await console.subscribe("map", hz=10)
            await console.subscribe("events")
            await console.until(lambda: len(console.entities) == 2)
            await walk(ann, 1.0)
            await ann.send(ChatLine(text="hello"))
            event = await console.event("chat")
            assert event["text"] == "Ann: hello"
            epoch = at_town.owner("yard")[1]
            at_town.owning("yard").kill()
            with pytest.raises(ConnectionClosed) as closed:
                await console.until(lambda: False)
            assert closed.value.rcvd is not None
            assert closed.value.rcvd.code == 1012
        await at_town.taken_over("yard", epoch)
        await settled(lambda: Operator(vera.port, vera.token, "yard").get("/world"))
        async with live_console(vera.port, vera.token, "/zones/yard") as console:
            await console.subscribe("map", hz=10)
            await console.until(lambda: len(console.entities) == 2)
        await go_on(ann)


async def test_people_are_told_muted_and_sent_out(at_town: Cluster) -> None:
    east, west = at_town.gateways
    mona = at_town.operator("moderator", east, "yard")
    async with joined(east.port, "Ann", PLACE) as ann, joined(west.port, "Ben", OTHER) as ben:
        await sees(ann, ben)
        status, answer = await mona.send({"op": "announce", "text": "We close in an hour."})
        assert status == 200, answer
        for client in (ann, ben):
            heard = await notice(client, NoticeCode.ANNOUNCEMENT)
            assert heard.text == "We close in an hour."
        wish = {"op": "mute", "person": ben.id, "seconds": 600, "text": "Let others speak."}
        assert (await mona.send(wish))[0] == 200
        assert (await notice(ben, NoticeCode.MUTED)).arguments["seconds"] == 600
        await ben.send(ChatLine(text="I do not"))
        assert (await ben.until(Error)).error is ErrorCode.MUTED
        await ann.send(Report(id=ben.id, text="shouts at me"))
        assert (await notice(ann, NoticeCode.REPORT_TAKEN)).arguments == {"id": ben.id}
        (report,) = await reports(mona)
        assert await reports(Operator(mona.port, mona.token, "hall")) == [report]
        assert (report["name"], report["text"], report["state"]) == ("Ben", "shouts at me", "open")
        # A mute and a report hold at another gateway and at another host.
        epoch = at_town.owner("yard")[1]
        at_town.owning("yard").kill()
        await at_town.taken_over("yard", epoch)
        await go_on(ann, ben)
        assert ben.welcome is not None
        async with back(east.port, ben.welcome.resume) as again:
            assert again.id == ben.id
            assert await reports(mona) == [report]
            settle = {"op": "settle_report", "report": report["id"], "note": "talked to Ben"}
            await settled(lambda: mona.send(settle))
            assert (await mona.get("/reports"))[1]["reports"][0]["state"] == "done"
            await again.send(ChatLine(text="nor here"))
            assert (await again.until(Error)).error is ErrorCode.MUTED
            await ann.send(ChatLine(text="thank you"))
            line = await again.until(Chat)
            assert line.text == "thank you"
            await settled(lambda: mona.send({"op": "hide_line", "line": line.line}))
            assert (await again.until(Hide)).lines == [line.line]
            assert again.welcome is not None
            token = again.welcome.resume
            assert (await mona.send({"op": "kick", "person": again.id, "text": "Go."}))[0] == 200
            messages, code = await again.last_words()
            assert code == CloseCode.KICKED
            (bye,) = [each for each in messages if isinstance(each, Bye)]
            assert bye.arguments["text"] == "Go."
        await ann.wait_for(lambda: ben.id not in ann.entities)
        async with joined(west.port, "Ben", resume=token) as anew:
            assert anew.welcome is not None
            assert not anew.welcome.resumed


async def farewell(client: Client) -> tuple[list[ServerMessage], int | None]:
    """Read to the end of the connection."""
    with suppress(ConnectionClosed):
        return await client.last_words()
    return [], client.connection.close_code


async def test_a_ban_reaches_all_zones_and_gateways_at_once(at_town: Cluster) -> None:
    east, west = at_town.gateways
    mona = at_town.operator("moderator", east, "yard")
    async with joined(west.port, "Trolla", BEFORE_GATE) as troll, joined(east.port, "Ann") as ann:
        await troll.move(0.0, 1.5)
        assert (await troll.until(Travel)).zone == "hall"
        status, answer = await mona.send({"op": "ban", "name_pattern": "troll*", "text": "No."})
        assert status == 200, answer
        messages, code = await farewell(troll)
        assert code == CloseCode.BANNED
        assert [each.text for each in messages if isinstance(each, Bye)] == ["No."]
        for port in (east.port, west.port):
            await until_banned(port)
        await go_on(ann)
        (ban,) = [one for one in (await mona.get("/bans"))[1]["bans"] if one["holds"]]
        hall = Operator(mona.port, mona.token, "hall")
        await until_lifted(hall, ban["id"])
    async with asyncio.timeout(PATIENCE_S):
        while True:
            async with connected(west.port) as client:
                await client.send(Hello(name="Trollo", version=VERSION))
                if not isinstance(await client.next(), Error):
                    break
            await asyncio.sleep(0.2)


async def until_banned(port: int) -> None:
    """Come to a gateway until it refuses, as it does once the ban has reached it; whoever comes
    just before that is shown out."""
    async with asyncio.timeout(PATIENCE_S):
        while True:
            async with connected(port) as client:
                await client.send(Hello(name="Trollo", version=VERSION))
                messages, code = await client.last_words()
            assert code == CloseCode.BANNED
            errors = [each.error for each in messages if isinstance(each, Error)]
            if errors:
                assert errors == [ErrorCode.BANNED]
                return


async def until_lifted(asked: Operator, ban: int) -> None:
    """Lift a ban in another zone than that where it was made, once that one knows of it."""
    async with asyncio.timeout(PATIENCE_S):
        while (await asked.send({"op": "unban", "ban": ban}))[0] != 200:  # noqa: ASYNC110
            await asyncio.sleep(0.2)


async def test_the_time_of_a_zone_stands_and_runs_on(at_town: Cluster) -> None:
    east, west = at_town.gateways
    dora = at_town.operator("director", east, "yard")
    async with joined(west.port, "Ann", PLACE) as ann:
        await walk(ann, 0.5)
        assert (await dora.send({"op": "pace", "pause": True}))[0] == 200
        paused = await notice(ann, NoticeCode.PAUSED)
        assert paused.arguments["rate"] == 0.0
        assert "operator" in paused.text
        place = ann.position
        await ann.move(0.0, 1.5)
        await ann.send(ChatLine(text="everything stands"))
        heard: list[ServerMessage] = []
        while not any(isinstance(each, Chat) for each in heard):
            heard.append(await ann.next())
        # It is told of often enough that nobody thinks that the host is gone.
        async with asyncio.timeout(PATIENCE_S):
            begin = time.monotonic()
            while time.monotonic() - begin < 2.5:
                heard.append(await ann.next())
        notices = [each for each in heard if isinstance(each, Notice)]
        assert all("operator" in each.text for each in notices)
        assert ann.position == place
        async with connected(east.port) as ben:
            await ben.send(Hello(name="Ben", version=VERSION))
            assert (await notice(ben, NoticeCode.PAUSED)).arguments["rate"] == 0.0
            assert (await dora.send({"op": "pace", "pause": False}))[0] == 200
            await notice(ben, NoticeCode.RESUMED)
            await ann.wait_for(lambda: ann.position[0] > place[0] + 0.5)


async def test_a_gateway_that_stood_still_tells_each_line_once(at_town: Cluster) -> None:
    east, west = at_town.gateways
    async with joined(east.port, "Ann", PLACE) as ann, joined(west.port, "Ben", OTHER) as ben:
        await sees(ann, ben)
        east.freeze()
        await asyncio.sleep(1.0)
        for text in ("one", "two"):
            await ben.send(ChatLine(text=text))
            await ben.until(Chat)
            await asyncio.sleep(2.0)
        east.thaw()
        heard: list[str] = []
        while "last" not in heard:
            if heard == ["one", "two"]:
                await ben.send(ChatLine(text="last"))
                await ben.until(Chat)
            heard.append((await ann.until(Chat)).text)
        assert heard == ["one", "two", "last"]


async def test_whom_somebody_does_not_hear_is_known_at_the_next_gateway(at_town: Cluster) -> None:
    east, west = at_town.gateways
    async with joined(east.port, "Ann", PLACE) as ann, joined(west.port, "Ben", OTHER) as ben:
        await sees(ann, ben)
        await ann.send(MutePerson(id=ben.id, muted=True))
        await ben.send(ChatLine(text="to nobody"))
        await ben.until(Chat)
        await go_on(ann, ben)
        assert ann.welcome is not None
        east.kill()
        async with back(west.port, ann.welcome.resume) as again:
            await sees(again, ben)
            await ben.send(ChatLine(text="to nobody either"))
            await again.send(ChatLine(text="I hear myself"))
            assert (await again.until(Chat)).text == "I hear myself"
            await again.send(MutePerson(id=ben.id, muted=False))
            await go_on(again, ben)
            await ben.send(ChatLine(text="at last"))
            assert (await again.until(Chat)).text == "at last"
