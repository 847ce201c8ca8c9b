import asyncio
import statistics
import threading
from typing import Any

import pytest

from esplanade.actors import Population
from esplanade.protocol.messages import Ping, Pong
from esplanade.server.console import questions
from esplanade.server.world.zone import Zone
from tests.patience import PATIENCE_S
from tests.server.client import joined
from tests.server.conftest import Serving


async def test_ticks_follow_one_another_at_their_rate(serving: Serving) -> None:
    async with serving(tick_rate=40) as server, joined(server.port) as client:
        ticks = []
        for _ in range(20):
            await client.ticks(1)
            ticks.append(client.tick)
        assert ticks == list(range(ticks[0], ticks[0] + 20))


@pytest.mark.parametrize(("given", "wanted"), [(None, 2), (1, 1)])
async def test_the_planning_interval_of_the_settings_is_kept_to_and_told(
    serving: Serving, monkeypatch: pytest.MonkeyPatch, given: int | None, wanted: int
) -> None:
    planned: list[int] = []
    think = Zone.think

    def counted(zone: Zone) -> bool:
        moved = think(zone)
        decisions = zone._population.navigator._batch.zone.decisions
        planned.append(int(decisions.replanned.sum()))
        return moved

    async with serving(actors=4, planning_interval=given) as server:
        async with joined(server.port) as client:
            await client.until_tick(server.world.tick + 2)
            monkeypatch.setattr(Zone, "think", counted)
            await client.until_tick(server.world.tick + 12)
        # An actor that has got a new goal is planned in any tick.
        assert statistics.median(planned) == 4 // wanted
        text = server.metrics.exposition().decode()
        assert f"esplanade_planning_interval_ticks {wanted}.0" in text
        assert questions.world(server.console)["planning_interval_ticks"] == wanted


async def test_when_planning_fails_people_walk_on(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: Any) -> None:
        raise RuntimeError("told to fail")

    async with serving(actors=1) as server, joined(server.port) as client:
        monkeypatch.setattr(Population, "advance", fail)
        await client.move(0.0, 1.0)
        x = client.position[0]
        await client.wait_for(lambda: client.position[0] > x + 0.2)
        assert b"esplanade_planning_failures_total 0.0" not in server.metrics.exposition()


async def test_the_event_loop_serves_while_actors_are_planned(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    planning, go_on = threading.Event(), threading.Event()

    def think_long(*_: Any) -> None:
        planning.set()
        assert go_on.wait(PATIENCE_S)

    async with serving(actors=1) as server, joined(server.port) as client:
        monkeypatch.setattr(Population, "advance", think_long)
        assert await asyncio.to_thread(planning.wait, PATIENCE_S)
        tick = server.world.tick
        await client.send(Ping(nonce=5))
        await client.until(Pong)
        assert server.world.tick == tick
        go_on.set()
        await client.until_tick(tick + 2)
