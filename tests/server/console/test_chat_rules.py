"""Slow mode, words, quiet zones, hidden lines, announcements to some, and the way out."""

from esplanade.protocol import ByeCode, CloseCode, ErrorCode, NoticeCode
from esplanade.protocol.messages import Bye, Chat, ChatLine, Error, Hide, Notice
from tests.server.client import Client, joined
from tests.server.conftest import Serving
from tests.server.console.operators import Operator, operator

LEFT = [[0.0, 0.0], [4.0, 0.0], [4.0, 10.0], [0.0, 10.0]]
"""Part of the room under test."""


async def done(mona: Operator, **command: object) -> dict[str, object]:
    status, answer = await mona.send(command)
    assert status == 200, answer
    return answer


async def says(client: Client, text: str) -> str | ErrorCode:
    """A line as its speaker hears it, or the fault."""
    await client.send(ChatLine(text=text))
    while True:
        said = await client.next()
        if isinstance(said, Chat) and said.id == client.id:
            return said.text
        if isinstance(said, Error):
            return ErrorCode(said.error)


async def test_slow_mode(serving: Serving) -> None:
    async with serving(chat_rate=100) as server, joined(server.port) as ann:
        mona = await operator(server, "mona", "moderator")
        answer = await done(mona, op="slow_mode", seconds=3600)
        assert answer["before"] == {"people": {"slow_mode_s": None}}
        assert await says(ann, "one") == "one"
        assert await says(ann, "two") is ErrorCode.SLOW_MODE
        await done(mona, op="slow_mode", seconds=0)
        assert await says(ann, "three") == "three"


async def test_words(serving: Serving) -> None:
    async with serving(chat_rate=100) as server, joined(server.port) as ann:
        mona = await operator(server, "mona", "moderator")
        await done(mona, op="word_filter", words=["darn", "Blast"])
        assert await says(ann, "Darn it, bIast! dаrn") == "••• it, •••! •••"
        assert await says(ann, "darning a blaster") == "darning a blaster"
        await done(mona, op="word_filter", words=["darn"], action="refuse")
        assert await says(ann, "oh darn") is ErrorCode.WORD_REFUSED
        await done(mona, op="word_filter", words=[])
        assert await says(ann, "oh darn") == "oh darn"


async def test_quiet_zones(serving: Serving) -> None:
    async with (
        serving(chat_rate=100) as server,
        joined(server.port, at=(2.0, 2.0, 0)) as ann,
        joined(server.port, "Ben", at=(6.0, 2.0, 0)) as ben,
    ):
        mona = await operator(server, "mona", "moderator")
        await done(mona, op="quiet_zone", name="library", polygon=LEFT, storey_m=0.0)
        await ann.send(ChatLine(text="psst"))
        fault = await ann.until(Error)
        assert (fault.error, fault.arguments) == (ErrorCode.QUIET_ZONE, {"name": "library"})
        assert await says(ben, "hello") == "hello"
        await done(mona, op="quiet_zone", name="library", remove=True)
        assert await says(ann, "psst") == "psst"
        wrong = {"op": "quiet_zone", "name": "nowhere", "remove": True}
        assert (await mona.send(wrong))[0] == 422


async def test_a_hidden_line_goes_from_every_client(serving: Serving) -> None:
    async with (
        serving(keep_chat=True) as server,
        joined(server.port) as ann,
        joined(server.port, "Ben") as ben,
    ):
        mona = await operator(server, "mona", "moderator")
        await ann.send(ChatLine(text="regrettable"))
        line = (await ben.until(Chat)).line
        (kept,) = (await mona.get("/chat"))[1]["lines"]
        assert (kept["line"], kept["text"], kept["hidden"]) == (line, "regrettable", False)
        assert (kept["id"], kept["seen_by"], set(kept["seen"])) == (ann.id, 2, {ann.id, ben.id})
        await done(mona, op="hide_line", line=line)
        assert (await ann.until(Hide)).lines == (await ben.until(Hide)).lines == [line]
        assert (await mona.get("/chat"))[1]["lines"][0]["hidden"] is True
        assert (await mona.send({"op": "hide_line", "line": line + 1}))[0] == 422


async def test_no_line_is_kept_unless_told(serving: Serving) -> None:
    async with serving() as server, joined(server.port) as ann:
        mona = await operator(server, "mona", "moderator")
        await ann.send(ChatLine(text="between us"))
        line = (await ann.until(Chat)).line
        assert (await mona.get("/chat"))[1] == {"keeps_chat": False, "lines": []}
        await done(mona, op="hide_line", line=line)
        assert (await ann.until(Hide)).lines == [line]


async def test_chat_is_kept_for_days(serving: Serving, tmp_path) -> None:
    settings = {"keep_chat": True, "keep_chat_days": 7, "data": tmp_path / "world"}
    async with serving(**settings) as server, joined(server.port) as ann:
        await ann.send(ChatLine(text="for later"))
        line = (await ann.until(Chat)).line
    async with serving(**settings) as server, joined(server.port) as ann:
        mona = await operator(server, "mona", "moderator")
        (kept,) = (await mona.get("/chat"))[1]["lines"]
        assert (kept["line"], kept["text"]) == (line, "for later")
        await ann.send(ChatLine(text="another"))
        assert (await ann.until(Chat)).line > line
    async with serving(data=tmp_path / "world") as server:
        assert list(server.kept.moderation.chat) == []


async def test_an_announcement_to_some(serving: Serving) -> None:
    async with (
        serving(actors=1) as server,
        joined(server.port, at=(2.0, 2.0, 0)) as ann,
        joined(server.port, "Ben", at=(8.0, 2.0, 0)) as ben,
    ):
        mona = await operator(server, "mona", "moderator")
        answer = await done(mona, op="announce", text="on the left", polygon=LEFT)
        assert answer["after"] == {"people": {"announced": "on the left", "reached": 1}}
        answer = await done(mona, op="announce", text="upstairs", storey_m=30.0, dry_run=True)
        await done(mona, op="announce", text="around", near_actor="actor-1", radius_m=1000)
        first, second = await ann.until(Notice), await ann.until(Notice)
        assert [first.text, second.text] == ["on the left", "around"]
        assert first.notice is NoticeCode.ANNOUNCEMENT
        assert (await ben.until(Notice)).text == "around"
        wrong = {"op": "announce", "text": "x", "near_actor": "actor-9"}
        assert (await mona.send(wrong))[0] == 422


async def test_a_warning_and_the_way_out(serving: Serving) -> None:
    async with serving() as server, joined(server.port, at=(9.0, 9.0, 0)) as ann:
        mona = await operator(server, "mona", "moderator")
        await done(mona, op="warn", person=ann.id, text="Softly.")
        notice = await ann.until(Notice)
        assert (notice.notice, notice.text) == (NoticeCode.WARNED, "Softly.")
        await done(mona, op="walk_out", person=ann.id, text="Time to go.")
        notice = await ann.until(Notice)
        assert (notice.notice, notice.text) == (NoticeCode.WALKED_OUT, "Time to go.")
        await ann.move(0.0, 2.0)  # it is void
        said, code = await ann.last_words()
        assert code == CloseCode.KICKED
        (bye,) = [each for each in said if isinstance(each, Bye)]
        assert (bye.reason, bye.text) == (ByeCode.WALKED_OUT, "Time to go.")
        x, y = ann.position
        assert abs(x - 3.0) < 1.6
        assert abs(y - 3.0) < 1.6
        async with joined(server.port, "Ben") as ben:
            await ben.ticks(2)
            assert server.world.count()[0] == 1
