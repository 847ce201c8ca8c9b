"""Operators pause the world, go on by single ticks, and let time run slower and faster."""

import asyncio
import time

from esplanade import bots
from esplanade.protocol import VERSION, NoticeCode
from esplanade.protocol.messages import Chat, ChatLine, Hello, Notice
from esplanade.server.world.frame import Frame
from tests.patience import PATIENCE_S
from tests.server.client import Client, connected, joined
from tests.server.conftest import Serving
from tests.server.console.operators import Operator, operator


async def pace(by: Operator, **how: object) -> None:
    status, answer = await by.send({"op": "pace", **how})
    assert status == 200, answer


async def told(client: Client) -> Notice:
    """The next notice of the pace, of which all fields are checked that clients go by."""
    notice = await client.until(Notice)
    assert notice.text
    assert set(notice.arguments) == {"factor", "rate", "server_time"}
    return notice


async def test_the_clock_of_a_bot_goes_at_the_pace(serving: Serving) -> None:
    async with (
        serving() as server,
        bots.connect(f"ws://127.0.0.1:{server.port}") as bot,
    ):
        olga = await operator(server, "olga", "director")
        for factor in (4.0, 0.25):
            await pace(olga, factor=factor)
            await _noticed(bot)
            before, began_s = bot.server_time, time.monotonic()
            await asyncio.sleep(0.5)
            passed_s = bot.server_time - before
            rate = passed_s / (time.monotonic() - began_s)
            # A slow machine may have told of a lower rate meanwhile.
            assert 0.1 * factor < rate < 1.05 * factor
        await pace(olga, pause=True)
        await _noticed(bot, NoticeCode.PAUSED)
        stands = bot.server_time
        await asyncio.sleep(0.1)
        assert bot.server_time == stands


async def _noticed(bot: bots.Bot, code: NoticeCode = NoticeCode.PACE) -> None:
    """Wait until a bot is told of a pace."""
    async with asyncio.timeout(PATIENCE_S):
        async for event in bot.events():
            if isinstance(event, Notice) and event.notice is code:
                return


async def test_in_a_pause_nobody_moves_and_nobody_is_lost(serving: Serving) -> None:
    async with (
        serving(resume_seconds=0.3) as server,
        joined(server.port) as ann,
        joined(server.port) as bob,
    ):
        olga = await operator(server, "olga", "director")
        await ann.move(0.0, 1.0)
        await ann.wait_for(lambda: ann.ack == ann.seq)
        await pace(olga, pause=True)
        notice = await told(ann)
        assert (notice.notice, notice.arguments["rate"]) == (NoticeCode.PAUSED, 0.0)
        _, world = await olga.get("/world")
        assert world["pace"]["paused"]
        begun = server.world.state.positions.copy()
        # Bob loses his connection, for longer than an avatar waits while time runs.
        await bob.connection.close(4999)
        await ann.send(ChatLine(text="still here"))
        assert (await ann.until(Chat)).text == "still here"
        status, _ = await olga.send(
            {"op": "set_parameters", "scope": "world", "values": {"risk_weight": 11}}
        )
        assert status == 200
        await asyncio.sleep(0.5)
        async with connected(server.port) as cleo:
            await cleo.send(Hello(name="Cleo", version=VERSION))
            assert (await told(cleo)).notice is NoticeCode.PAUSED
            await cleo.wait_for(lambda: cleo.id in cleo.positions)
            assert server.world.count()[0] == 3
        assert (server.world.state.positions[:2] == begun[:2]).all()
        await pace(olga, pause=False)
        assert (await told(ann)).notice is NoticeCode.RESUMED
        x = ann.position[0]
        await ann.wait_for(lambda: ann.position[0] > x + 0.2)
        async with connected(server.port) as again:
            assert bob.welcome is not None
            await again.send(Hello(name="Bob", version=VERSION, resume=bob.welcome.resume))
            await again.wait_for(lambda: again.welcome is not None)
            assert again.id == bob.id


async def test_a_paused_world_goes_on_by_as_many_ticks_as_are_wanted(serving: Serving) -> None:
    async with serving() as server, joined(server.port) as ann:
        olga = await operator(server, "olga", "director")
        await ann.move(0.0, 1.0)
        await ann.wait_for(lambda: ann.ack == ann.seq)
        status, answer = await olga.send({"op": "pace", "step": 1})
        assert status == 422, answer
        assert answer["faults"][0]["code"] == "not_paused"
        await pace(olga, pause=True)
        stood = (await told(ann)).arguments["server_time"]
        slot = server.world.state.slot(ann.id)
        tick, x = server.world.tick, float(server.world.state.positions[slot, 0])
        for ticks in (1, 10):
            await pace(olga, step=ticks)
            notice = await told(ann)
            assert notice.notice is NoticeCode.PAUSED
            assert server.world.tick == tick + ticks
            walked = float(server.world.state.positions[slot, 0]) - x
            assert abs(walked - ticks * server.world.tick_s) < 0.02
            assert abs(notice.arguments["server_time"] - stood - ticks / 20.0) < 1e-6
            tick, x = server.world.tick, x + walked
            stood = notice.arguments["server_time"]
        await pace(olga, pause=False)
        await ann.ticks(5)


async def test_time_runs_slower_and_faster_and_an_undo_brings_it_back(serving: Serving) -> None:
    async with serving() as server, joined(server.port) as ann:
        olga = await operator(server, "olga", "director")
        loop = asyncio.get_running_loop()
        await pace(olga, factor=0.25)
        assert (await told(ann)).arguments["rate"] == 0.25
        begun, tick = loop.time(), server.world.tick
        await ann.until_tick(tick + 4)
        assert loop.time() - begun > 0.5
        # A list of commands enters one tick; a question is answered no later than usual.
        assert (await olga.get("/world"))[1]["pace"]["factor"] == 0.25
        assert (await olga.send({"op": "revert"}))[0] == 200
        assert (await told(ann)).arguments["rate"] == 1.0
        await pace(olga, factor=4)
        assert (await told(ann)).arguments["factor"] == 4.0
        await ann.ticks(20)
        assert b"esplanade_pace_factor 4.0" in server.metrics.exposition()


async def test_people_and_operators_are_told_when_the_machine_is_too_slow(
    serving: Serving,
) -> None:
    async with serving() as server, joined(server.port) as ann:
        olga = await operator(server, "olga", "director")
        finish = server.world.finish

        def slow(moved: bool) -> Frame:
            time.sleep(0.04)
            return finish(moved)

        server.world.finish = slow  # type: ignore[method-assign]
        await pace(olga, factor=4)
        await told(ann)
        async with asyncio.timeout(PATIENCE_S):
            notice = await told(ann)
        assert notice.arguments["rate"] < 2.0
        assert "manages only" in notice.text
        _, world = await olga.get("/world")
        assert not world["pace"]["reached"]
        assert world["pace"]["factor"] == 4.0


async def test_only_who_may_changes_the_pace(serving: Serving) -> None:
    async with serving() as server:
        tuner = await operator(server, "tim", "tuner")
        assert (await tuner.send({"op": "pace", "pause": True}))[0] == 403
        olga = await operator(server, "olga", "director")
        for wrong in ({}, {"factor": 9}, {"factor": 1, "pause": True}, {"step": 0}):
            assert (await olga.send({"op": "pace", **wrong}))[0] == 422
        assert not (await olga.get("/world"))[1]["pace"]["paused"]
