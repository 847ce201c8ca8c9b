"""Traces of decisions over the private port: what they tell, and who gets none."""

import asyncio
import base64
from typing import Any

import numpy as np
import pytest

from esplanade.server.console import live_api
from esplanade.server.console.live_api import avatar_of
from esplanade.server.console.refusals import RefusedError
from esplanade.server.live import traces
from esplanade.server.live.bulletin import Bulletin
from esplanade.server.live.live import Live
from esplanade.server.metrics import Traffic
from tests.patience import PATIENCE_S
from tests.server.client import joined
from tests.server.conftest import Serving
from tests.server.console.browsers import codes
from tests.server.console.operators import Operator, operator
from tests.server.live.consoles import live_console
from tests.server.populated import Populated, spec

PARTS = {"time", "risk", "others", "turn", "wall", "hurry", "keep_right"}


async def traced(by: Operator, actor: str = "actor-1") -> dict[str, Any]:
    """A trace, as soon as one may be asked for again."""
    async with asyncio.timeout(PATIENCE_S):
        while True:
            status, body = await by.get(f"/actors/{actor}/trace")
            if status == 200:
                assert isinstance(body, dict)
                return body
            assert codes(body)[0] in {"too_many", "busy", "not_kept"}, body
            await asyncio.sleep(0.2)


def add_up(cost: dict[str, float]) -> None:
    assert PARTS | {"total"} == cost.keys()
    assert sum(cost[part] for part in PARTS) == pytest.approx(cost["total"], abs=1e-3)


async def test_a_trace_tells_the_last_decision_of_an_actor(serving: Serving) -> None:
    async with serving(actors=3) as server, joined(server.port, "Eve"):
        vera = await operator(server, "vera", "viewer")
        found = await traced(vera)
        assert found["exact"]
        assert found["actor"] == "main/actor-1"
        assert 0 < found["tick"] <= server.world.tick
        assert 0 <= found["expansions"] <= found["budget"]
        assert found["status"] in {"found", "partial", "no_path"}
        add_up(found["cost"])
        assert [len(place) for place in found["path"]] == [4] * len(found["path"])
        for path in ("previous", "searched", "perturbed"):
            if found[path] is not None:
                add_up(found[path]["cost"])
        codes = {"first", "forced", "search", "perturbation", "kept", "not_due"}
        assert found["why"]["code"] in codes
        assert found["why"]["text"]
        assert {"taken_s", "before_s", "hysteresis_s"} <= found["why"]["arguments"].keys()
        assert [round(each["t_s"], 1) for each in found["risk"]] == [
            round(0.4 * k, 1) for k in range(10)
        ]
        for each in found["risk"]:
            values = np.frombuffer(base64.b64decode(each["values"]), "<f4")
            assert len(values) == each["width"] * each["height"]
        orders = [node[6] for node in found["nodes"] if node[6] >= 0]
        assert orders == list(range(found["expansions"]))


async def test_an_actors_channel_tells_the_cost_of_its_path_and_of_the_one_before(
    serving: Serving,
) -> None:
    async with serving(actors=2) as server:
        vera = await operator(server, "vera", "viewer")
        async with live_console(server.private_port, vera.token) as console:
            await console.subscribe("actor:actor-1", hz=10)

            def priced() -> list[dict[str, Any]]:
                return [each for each in console.told if each.get("cost") and each["previous"]]

            (message, *_) = await console.until(priced)
            add_up(message["cost"])
            add_up(message["previous"]["cost"])
            assert len(message["previous"]["path"]) == len(message["path"])


async def test_two_traces_a_second_are_made_and_no_more(serving: Serving) -> None:
    async with serving(actors=1) as server:
        vera = await operator(server, "vera", "viewer")
        answers = await asyncio.gather(*(vera.get("/actors/actor-1/trace") for _ in range(12)))
        refused = [body for status, body in answers if status == 429]
        assert len(refused) == 10
        assert {codes(body)[0] for body in refused} == {"too_many"}


async def test_in_a_pause_the_last_decision_is_told_if_it_was_kept(serving: Serving) -> None:
    async with serving(actors=1) as server:
        dora = await operator(server, "dora", "director")
        assert (await dora.send({"op": "pace", "pause": True}))[0] == 200
        status, body = await dora.get("/actors/actor-1/trace")
        assert (status, codes(body)) == (409, ["not_kept"])
        assert (await dora.send({"op": "pace", "step": 2}))[0] == 200
        found = await traced(dora)
        assert found["exact"]
        again = await traced(dora)
        assert {**again, "seconds": 0} == {**found, "seconds": 0}


async def test_a_world_that_has_just_begun_knows_its_actors_at_once() -> None:
    world = Populated([spec(1)])
    live = Live(world.zone, [0.0], Bulletin(), Traffic(), hide_names=False)
    asked = [asyncio.create_task(avatar_of(live, f"main/{name}")) for name in ("a1", "a2")]
    await asyncio.sleep(0.05)
    assert not any(each.done() for each in asked)
    live.tap.take(world.frame(), 0.001, 0)
    live.beat()
    assert await asyncio.gather(*asked) == [world.zone.avatar_of("main/a1"), None]


async def test_a_world_that_never_begins_is_not_waited_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(live_api, "WAIT_S", 0.05)
    live = Live(Populated([spec(1)]).zone, [0.0], Bulletin(), Traffic(), hide_names=False)
    with pytest.raises(RefusedError, match="has run no tick"):
        await avatar_of(live, "main/a1")


async def test_hostile_questions_get_an_answer(serving: Serving) -> None:
    async with serving(actors=1) as server:
        vera = await operator(server, "vera", "viewer")
        for actor in ("nobody", "main/nobody", "a" * 3000, "..%2f..%2fetc", "%00", "actor-1%20"):
            status, body = await vera.get(f"/actors/{actor}/trace")
            assert status in {404, 422}, (actor, body)
            assert codes(body)
        status, _ = await vera.request("POST", "/actors/actor-1/trace", {"X-Esplanade": "1"})
        assert status == 405
        assert (await traced(vera))["exact"]


async def test_a_name_is_hidden_where_names_are(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with serving(actors=1, hide_names=True) as server, joined(server.port, "Eve") as eve:
        vera = await operator(server, "vera", "viewer")
        mona = await operator(server, "mona", "moderator")
        blocker = traces.Blocker("person", eve.id, 0.4)
        monkeypatch.setattr(type(server.world), "blocker", lambda *_: blocker)
        assert (await traced(vera))["blocker"]["name"] == f"Person {eve.id}"
        assert (await traced(mona))["blocker"]["name"] == "Eve"
