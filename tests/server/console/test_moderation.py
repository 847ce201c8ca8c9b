"""Operators speak to people, mute them and send them out; each is told why."""

from esplanade.protocol import ByeCode, CloseCode, ErrorCode
from esplanade.protocol.messages import Bye, Chat, ChatLine, Error, Notice
from esplanade.server.audit.log import Filter
from tests.server.client import joined
from tests.server.conftest import Serving
from tests.server.console.operators import operator


async def test_an_announcement_reaches_everyone(serving: Serving) -> None:
    async with serving() as server, joined(server.port) as ann, joined(server.port) as bob:
        mona = await operator(server, "mona", "moderator")
        assert (await mona.send({"op": "announce", "text": "We close at ten."}))[0] == 200
        assert (await ann.until(Notice)).text == "We close at ten."
        assert (await bob.until(Notice)).text == "We close at ten."


async def test_nobody_hears_who_is_muted_and_both_ends_are_told(serving: Serving) -> None:
    async with serving() as server, joined(server.port) as ann, joined(server.port) as bob:
        mona = await operator(server, "mona", "moderator")
        command = {"op": "mute", "person": ann.id, "seconds": 600, "text": "Softly, please."}
        assert (await mona.send(command))[0] == 200
        assert (await ann.until(Notice)).text == "Softly, please."
        await ann.send(ChatLine(text="loud"))
        assert (await ann.until(Error)).error is ErrorCode.MUTED
        _, found = await mona.get("/people")
        muted = {person["id"]: person["muted_s"] > 0 for person in found["people"]}
        assert muted == {ann.id: True, bob.id: False}
        assert (await mona.send({**command, "seconds": 0, "text": "Speak."}))[0] == 200
        await ann.until(Notice)
        await ann.send(ChatLine(text="soft"))
        assert (await bob.until(Chat)).text == "soft"


async def test_who_is_kicked_is_told_why_and_does_not_get_the_avatar_back(serving: Serving) -> None:
    async with serving(resume_seconds=60) as server, joined(server.port) as ann:
        mona = await operator(server, "mona", "moderator")
        command = {"op": "kick", "person": ann.id, "text": "No running.", "note": "third time"}
        status, answer = await mona.send(command)
        assert status == 200, answer
        said, code = await ann.last_words()
        assert code == CloseCode.KICKED
        (bye,) = [each for each in said if isinstance(each, Bye)]
        assert (bye.reason, bye.text) == (ByeCode.KICKED, "No running.")
        (row,) = [
            row
            for row in (await server.kept.audit.page(Filter(command="kick"))).rows
            if row.refers_to is None
        ]
        assert row.note == "third time"
        assert row.person
        # Rows that speak of a person stand where they can be forgotten.
        assert row.detail == {"text": "No running."}
        assert "No running." not in str(row.body)
        async with joined(server.port) as other:
            await other.ticks(2)
            assert server.world.count()[0] == 1
        assert (await mona.send({"op": "kick", "person": 4711}))[0] == 422


async def test_moderators_change_no_actors_and_viewers_moderate_nobody(serving: Serving) -> None:
    async with serving(actors=1) as server, joined(server.port) as ann:
        mona = await operator(server, "mona", "moderator")
        vera = await operator(server, "vera", "viewer")
        assert (await vera.send({"op": "kick", "person": ann.id}))[0] == 403
        hold = {"op": "hold_actor", "actor": "actor-1"}
        assert (await mona.send(hold))[0] == 403
        await ann.ticks(3)
