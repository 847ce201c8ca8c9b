"""Waves of actors come in and go together; actors lead tours that were drawn, and follow others."""

import math
from typing import Any

from tests.server.client import joined
from tests.server.conftest import Serving
from tests.server.console.operators import Operator, operator


async def done(by: Operator, command: Any) -> Any:
    status, answer = await by.send(command)
    assert status == 200, answer
    return answer


async def places(by: Operator) -> dict[str, tuple[float, float]]:
    _, found = await by.get("/actors")
    return {each["id"]: tuple(each["position"][:2]) for each in found["actors"]}


async def test_a_wave_comes_in_around_a_point_and_goes_by_its_tag(serving: Serving) -> None:
    async with serving(actors=1) as server:
        olga = await operator(server, "olga", "director")
        wave = {
            "op": "add_actors",
            "count": 12,
            "behaviour": {"kind": "idle"},
            "preset": "timid",
            "overrides": {"speed_mps": 0.9},
            "tags": ["wave-1"],
            "near": [5.0, 5.0, 0.0],
        }
        await done(olga, wave)
        where = await places(olga)
        assert len(where) == 13
        new = [place for actor, place in where.items() if actor != "main/actor-1"]
        assert all(math.dist(place, (5.0, 5.0)) < 4.0 for place in new)
        apart = [math.dist(a, b) for k, a in enumerate(new) for b in new[:k]]
        assert min(apart) > 0.5
        values = await olga.values("main/actor-2")
        _, timid = await olga.get("/presets/timid")
        name, value = next((n, v) for n, v in timid["values"].items() if n != "speed_mps")
        assert values["speed_mps"] == 0.9
        assert values[name] == value
        await done(olga, {"op": "remove_actors", "tag": "wave-1"})
        assert list(await places(olga)) == ["main/actor-1"]
        await done(olga, {"op": "revert"})
        assert len(await places(olga)) == 13


async def test_a_wave_that_cannot_be_is_refused_with_the_place_of_the_fault(
    serving: Serving,
) -> None:
    async with serving() as server:
        olga = await operator(server, "olga", "director")
        wave = {"op": "add_actors", "count": 3}
        for wrong, code, path in (
            ({"near": "moon"}, "unknown_place", ["near"]),
            ({"count": 201}, "invalid", ["count"]),
            ({"count": 200, "near": [0.0, 500.0, 0.0]}, "refused", []),
            ({"actors": [{}]}, "invalid", []),
            ({"overrides": {"speed_mps": 99}}, "values", ["actors", 0, "overrides", "speed_mps"]),
        ):
            status, answer = await olga.send({**wave, **wrong})
            assert status == 422, wrong
            assert answer["faults"][0]["code"] == code, answer
            assert answer["faults"][0]["path"][-len(path) :] == path or not path
        status, answer = await olga.send({"op": "remove_actors", "tag": "nobody"})
        assert answer["faults"][0]["code"] == "unknown_tag"
        assert await places(olga) == {}


async def test_an_actor_follows_a_person_and_another_becomes_a_guide(serving: Serving) -> None:
    async with serving(actors=2) as server, joined(server.port) as ann:
        olga = await operator(server, "olga", "director")
        near = {"kind": "follow", "person": ann.id, "distance_m": 1.5}
        tour = {"kind": "guide", "tour": [[2.0, 2.0, 0.0], [8.0, 2.0, 0.0], [8.0, 8.0, 0.0]]}
        await done(
            olga,
            [
                {"op": "set_behaviour", "actors": ["actor-1"], "behaviour": near},
                {"op": "set_behaviour", "actors": ["actor-2"], "behaviour": tour},
            ],
        )
        _, guide = await olga.get("/actors/actor-2")
        assert guide["behaviour"]["tour"] == tour["tour"]
        world = server.world

        def away_m() -> float:
            avatar = world.avatar_of("main/actor-1")
            if avatar is None:
                return math.inf
            a, b = world.state.slot(avatar), world.state.slot(ann.id)
            return math.dist(world.state.positions[a], world.state.positions[b])

        await ann.wait_for(lambda: away_m() < 2.4)
        for wrong in ({"kind": "follow"}, {"kind": "follow", "actor": "main/actor-2", "person": 1}):
            command = {"op": "set_behaviour", "actors": ["actor-1"], "behaviour": wrong}
            assert (await olga.send(command))[0] == 422
