"""Bans keep people out: by token, name and address; each is told why and until when."""

import time

import pytest

from esplanade.protocol import VERSION, ByeCode, CloseCode, ErrorCode
from esplanade.protocol.messages import Bye, Error, Hello
from esplanade.server.app import Running
from esplanade.server.audit.log import Filter
from tests.server.client import Client, connected, joined
from tests.server.conftest import Serving
from tests.server.console.operators import operator


async def refused(server: Running, name: str, resume: str | None = None) -> Error | None:
    """The fault of somebody who tries to come in; None if they are let in."""
    async with connected(server.port) as client:
        await client.send(Hello(name=name, version=VERSION, resume=resume))
        said = await client.next()
        if not isinstance(said, Error):
            return None
        assert (await client.last_words())[1] == CloseCode.BANNED
        return said


async def farewell(client: Client) -> Bye:
    said, code = await client.last_words()
    assert code == CloseCode.BANNED
    (bye,) = [each for each in said if isinstance(each, Bye)]
    return bye


async def test_who_is_banned_goes_and_comes_back_neither_by_token_nor_by_name(
    serving: Serving,
) -> None:
    async with serving(resume_seconds=60) as server, joined(server.port, "Eve") as eve:
        mona = await operator(server, "mona", "moderator")
        until_s = float(int(time.time()) + 3600)
        wish = {"op": "ban", "person": eve.id, "until_s": until_s, "text": "No shouting."}
        status, answer = await mona.send({**wish, "dry_run": True})
        assert (status, answer["command"]) == (200, None)
        assert (await mona.get("/bans"))[1]["bans"] == []
        status, answer = await mona.send(wish)
        assert status == 200, answer
        bye = await farewell(eve)
        assert (bye.reason, bye.arguments) == (
            ByeCode.BANNED,
            {"text": "No shouting.", "until_s": until_s},
        )
        assert eve.welcome is not None
        for name, token in (("Eve", None), ("ÉVE", None), ("Someone", eve.welcome.resume)):
            fault = await refused(server, name, token)
            if name == "ÉVE":
                assert fault is None  # an accent tells names apart
                continue
            assert fault is not None
            assert fault.error is ErrorCode.BANNED
            assert fault.arguments == {"text": "No shouting.", "until_s": until_s}
        assert await refused(server, "Ann") is None
        (ban,) = (await mona.get("/bans"))[1]["bans"]
        assert (ban["kinds"], ban["by"], ban["holds"]) == (["token", "name"], "mona", True)
        assert (await mona.send({"op": "unban", "ban": ban["id"]}))[0] == 200
        assert await refused(server, "Eve") is None
        assert (await mona.send({"op": "unban", "ban": ban["id"]}))[0] == 422


async def test_a_pattern_an_address_and_a_digest(serving: Serving) -> None:
    async with serving() as server, joined(server.port, "Ann", source="127.0.0.7") as ann:
        mona = await operator(server, "mona", "moderator")
        assert (await mona.send({"op": "ban", "name_pattern": "troll*"}))[0] == 200
        assert await refused(server, "Trоll 7") is not None  # with a Cyrillic o
        assert await refused(server, "Stroller") is None
        address = {"op": "ban", "address": "127.0.0.4/30", "text": "Not from there."}
        assert (await mona.send(address))[0] == 200
        assert (await farewell(ann)).arguments["text"] == "Not from there."
        assert await refused(server, "Ben") is None
        for wrong in (
            {"name_pattern": "*"},
            {"name_pattern": "a*b*c*d*e"},
            {"address": "all of them"},
            {"person": 4711},
            {"until_s": 5.0, "name_pattern": "Old"},
            {},
        ):
            assert (await mona.send({"op": "ban", **wrong}))[0] == 422, wrong


async def test_the_audit_can_forget_whom_a_ban_is_of(serving: Serving) -> None:
    async with serving() as server, joined(server.port, "Eve") as eve:
        mona = await operator(server, "mona", "moderator")
        command = {"op": "ban", "person": eve.id, "by": ["name"], "text": "Eve shouts."}
        assert (await mona.send({**command, "note": "third time"}))[0] == 200
        rows = (await server.kept.audit.page(Filter(command="ban"))).rows
        (row,) = [row for row in rows if row.refers_to is None]
        assert (row.person, row.note, row.detail) == ("Eve", "third time", {"text": "Eve shouts."})
        assert "Eve" not in str(row.body)
        assert "Eve" not in row.target


async def test_a_tuner_takes_a_ban_back_and_makes_it_anew(serving: Serving) -> None:
    async with serving() as server:
        tom = await operator(server, "tom", "tuner")
        assert (await tom.send({"op": "ban", "name_pattern": "Eve"}))[0] == 200
        assert await refused(server, "Eve") is not None
        status, answer = await tom.send({"op": "revert"})
        assert status == 200, answer
        assert await refused(server, "Eve") is None
        assert (await tom.send({"op": "revert", "change": "undone"}))[0] == 200
        assert await refused(server, "Eve") is not None


@pytest.mark.parametrize("kind", ["ban", "warn", "walk_out"])
async def test_viewers_ban_nobody(serving: Serving, kind: str) -> None:
    async with serving() as server, joined(server.port) as ann:
        vera = await operator(server, "vera", "viewer")
        assert (await vera.send({"op": kind, "person": ann.id, "text": "Go."}))[0] == 403
        for path in ("/bans", "/reports", "/chat", "/moderation"):
            assert (await vera.get(path))[0] == 403
        await ann.ticks(2)


async def test_bans_rules_and_reports_survive_a_restart(serving: Serving, tmp_path) -> None:
    async with serving(data=tmp_path / "world") as server:
        mona = await operator(server, "mona", "moderator")
        for command in (
            {"op": "ban", "name_pattern": "Eve"},
            {"op": "slow_mode", "seconds": 5},
            {"op": "word_filter", "words": ["darn"], "action": "refuse"},
            {"op": "quiet_zone", "name": "hall", "polygon": [[0, 0], [2, 0], [2, 2]]},
        ):
            assert (await mona.send(command))[0] == 200
        before = (await mona.get("/moderation"))[1]
    async with serving(data=tmp_path / "world") as server:
        max_ = await operator(server, "max", "moderator")
        assert await refused(server, "Eve") is not None
        assert (await max_.get("/moderation"))[1] == before
        assert before["slow_mode_s"] == 5.0
        assert before["quiet_zones"][0]["name"] == "hall"
