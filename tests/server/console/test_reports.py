"""People report others to the moderators' inbox, a few times each, and mute others."""

import msgpack
import pytest

from esplanade.protocol import ClientCode, CloseCode, ErrorCode, NoticeCode
from esplanade.protocol.messages import Chat, ChatLine, Error, MutePerson, Notice, Report
from esplanade.server.moderation import inbox
from esplanade.server.net.moderation import PeopleModeration
from tests.server.client import joined
from tests.server.conftest import Serving
from tests.server.console.operators import operator


async def test_a_report_is_read_and_settled(serving: Serving) -> None:
    async with serving() as server, joined(server.port) as ann, joined(server.port, "Ben") as ben:
        mona = await operator(server, "mona", "moderator")
        await ann.send(Report(id=ben.id, text="shouts at me"))
        notice = await ann.until(Notice)
        assert (notice.notice, notice.arguments) == (NoticeCode.REPORT_TAKEN, {"id": ben.id})
        _, found = await mona.get("/reports?state=open")
        (report,) = found["reports"]
        assert report["reporter"] == {"id": ann.id, "name": ann.welcome and ann.welcome.name}
        assert (report["person"], report["name"], report["text"], report["state"]) == (
            *(ben.id, "Ben", "shouts at me", "open"),
        )
        assert report["place"] == pytest.approx([*ben.position, 0.0], abs=0.02)
        wish = {"op": "settle_report", "report": report["id"], "note": "talked to Ben"}
        assert (await mona.send({**wish, "dry_run": True}))[0] == 200
        assert (await mona.get("/reports"))[1]["open"] == 1
        assert (await mona.send(wish))[0] == 200
        _, found = await mona.get("/reports")
        assert (found["open"], found["reports"][0]["state"]) == (0, "done")
        assert (await mona.get("/reports?state=open"))[1]["reports"] == []
        assert (await mona.send({**wish, "report": 4711}))[0] == 422


async def test_nobody_reports_themselves_or_nobody_and_who_has_left_can_be_reported(
    serving: Serving,
) -> None:
    async with serving() as server, joined(server.port) as ann:
        async with joined(server.port, "Ben") as ben:
            await ben.connection.close(1000)
        await ann.ticks(3)
        for wrong in (ann.id, 4711):
            await ann.send(Report(id=wrong, text="?"))
            assert (await ann.until(Error)).error is ErrorCode.INVALID
        await ann.send(Report(id=ben.id, text="said it and ran"))
        assert (await ann.until(Notice)).notice is NoticeCode.REPORT_TAKEN
        mona = await operator(server, "mona", "moderator")
        (report,) = (await mona.get("/reports"))[1]["reports"]
        assert (report["name"], report["place"]) == ("Ben", None)


async def test_a_hostile_client_that_reports_a_thousand_times_fills_no_inbox(
    serving: Serving,
) -> None:
    async with (
        serving(message_rate=2000) as server,
        joined(server.port, "Eve") as eve,
        joined(server.port, "Ann") as ann,
    ):
        mona = await operator(server, "mona", "moderator")
        for _ in range(1000):
            await eve.send(Report(id=ann.id, text="x" * 300))
        refused = 0
        while refused < 997:
            fault = await eve.until(Error)
            assert fault.error is ErrorCode.FLOODING
            refused += 1
        assert (await mona.get("/reports"))[1]["open"] == 3
        # Nobody else is kept from reporting.
        await ann.send(Report(id=eve.id, text="a flood"))
        assert (await ann.until(Notice)).notice is NoticeCode.REPORT_TAKEN


@pytest.mark.parametrize(
    "fields",
    [
        {"id": 1, "text": "a\x00b"},
        {"id": 1, "text": "up\x1b[2Jand away"},
        {"id": 1, "text": "turned \u202e around"},
        {"id": 1, "text": "two\nlines"},
        {"id": 1, "text": ""},
        {"id": 1, "text": "x" * 301},
        {"id": -1, "text": "x"},
        {"id": 1, "text": "x", "line": -1},
        {"id": 1, "text": "x", "line": 2**53},
        {"id": 1, "text": "x", "state": "done"},
        {"id": "1", "text": "x"},
        {"text": "x"},
    ],
)
async def test_a_report_that_breaks_the_rules_ends_the_connection(
    serving: Serving, fields: dict[str, object]
) -> None:
    async with serving() as server, joined(server.port) as eve:
        await eve.connection.send(msgpack.packb([int(ClientCode.REPORT), fields]))
        assert await eve.refusal() == (ErrorCode.INVALID, CloseCode.INVALID)
        mona = await operator(server, "mona", "moderator")
        assert (await mona.get("/reports"))[1]["reports"] == []


async def test_a_full_inbox_refuses_by_name(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(inbox, "MOST_OF_ONE", 1)
    async with serving() as server, joined(server.port) as ann, joined(server.port, "Ben") as ben:
        await ann.send(Report(id=ben.id, text="one"))
        await ann.until(Notice)
        await ann.send(Report(id=ben.id, text="two"))
        fault = await ann.until(Error)
        assert fault.error is ErrorCode.FLOODING
        assert "wait for moderators" in fault.text


async def test_lines_of_somebody_who_is_muted_are_not_sent(serving: Serving) -> None:
    async with (
        serving(chat_rate=100) as server,
        joined(server.port) as ann,
        joined(server.port, "Ben") as ben,
    ):
        await ann.send(MutePerson(id=ben.id, muted=True))
        await ann.ticks(2)
        await ben.send(ChatLine(text="la la"))
        assert (await ben.until(Chat)).text == "la la"
        await ann.send(ChatLine(text="quiet at last"))
        assert (await ann.until(Chat)).text == "quiet at last"
        await ann.send(MutePerson(id=ben.id, muted=False))
        await ann.ticks(2)
        await ben.send(ChatLine(text="la again"))
        assert (await ann.until(Chat)).text == "la again"


async def test_no_more_than_some_can_be_muted(serving: Serving) -> None:
    async with serving(message_rate=2000) as server, joined(server.port) as ann:
        for other in range(1000, 1201):
            await ann.send(MutePerson(id=other, muted=True))
        assert (await ann.until(Error)).error is ErrorCode.FLOODING
        await ann.send(MutePerson(id=1000, muted=False))
        await ann.send(MutePerson(id=5000, muted=True))
        await ann.ticks(2)


async def test_the_console_is_told_of_reports(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[tuple[str, dict[str, object]]] = []

    def happened(moderation: PeopleModeration, kind: str, about: dict[str, object]) -> None:
        told.append((kind, about))

    monkeypatch.setattr(PeopleModeration, "happened", happened)
    async with (
        serving(keep_chat=True) as server,
        joined(server.port) as ann,
        joined(server.port, "Ben") as ben,
    ):
        await ben.send(ChatLine(text="silly"))
        line = (await ann.until(Chat)).line
        await ann.send(Report(id=ben.id, line=line, text="says so"))
        await ann.until(Notice)
    (chat, said), (report, about) = told
    assert (chat, said["line"], said["text"]) == ("chat", line, "silly")
    assert (report, about["who"], about["other"], about["text"]) == (
        *("report", ann.id, ben.id, "says so"),
    )


async def test_operators_see_who_is_there(serving: Serving) -> None:
    async with serving() as server, joined(server.port) as ann:
        mona = await operator(server, "mona", "moderator")
        assert (await mona.send({"op": "mute", "person": ann.id, "seconds": 600}))[0] == 200
        (person,) = (await mona.get("/people"))[1]["people"]
        assert 590 < person["muted_s"] <= 600
        assert (person["name"], len(person["address_hash"])) == ("Ann", 10)
        assert person["queue_bytes"] >= 0
