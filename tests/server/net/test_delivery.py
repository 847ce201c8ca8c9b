import numpy as np

from actors import Explanation, Reason
from protocol import Reason as WireReason
from protocol import decode_server, encode
from protocol.messages import Census, Error, Plan, Watch
from server.net.delivery import plan
from tests.server.client import joined
from tests.server.conftest import Serving


def test_an_explanation_becomes_a_plan_to_the_millimetre() -> None:
    explanation = Explanation(
        "guide",
        Reason.GIVING_WAY,
        (1.0, 2.0, 0),
        np.array([[0.12345, 1.0, 0.0, 0.0], [0.5, 1.0, 0.0, 0.4]]),
        [np.array([[3.00049, 4.0, 0.0, 0.7]])],
    )
    made = plan(9, 4, explanation)
    assert made.reason is WireReason.GIVING_WAY
    assert made.path[0] == (0.123, 1.0, 0.0, 0.0)
    assert made.people[0][0].x == 3.0
    assert decode_server(encode(made)) == made


async def test_an_actor_in_view_can_be_watched_about_five_times_a_second(serving: Serving) -> None:
    async with serving(actors=2) as server, joined(server.port) as client:
        await client.wait_for(lambda: len(client.positions) == 3)
        actor = next(i for i, e in client.entities.items() if e.kind.value == "actor")
        await client.send(Watch(id=actor))
        first = await client.until(Plan)
        second = await client.until(Plan)
        assert (first.id, second.id) == (actor, actor)
        assert second.tick - first.tick == 4
        assert first.behaviour in {"wander", "patrol"}
        assert len(first.path) >= 1
        assert len(first.people) <= 1
        await client.send(Watch(id=None))
        await client.ticks(2)


async def test_only_actors_in_view_can_be_watched(serving: Serving) -> None:
    async with serving() as server, joined(server.port) as client:
        for nobody in (client.id, 999_999):
            await client.send(Watch(id=nobody))
            error = await client.until(Error)
            assert f"{nobody} is no actor in view" in error.text


async def test_the_census_counts_the_whole_world(serving: Serving) -> None:
    async with (
        serving(actors=2, view_radius_m=1.0) as server,
        joined(server.port, at=(2.0, 2.0, 0)) as client,
        joined(server.port, at=(18.0, 18.0, 0)),
    ):
        first = await client.until(Census)
        while first.people < 2:
            first = await client.until(Census)
        assert (first.people, first.actors) == (2, 2)
