import pytest
from websockets.asyncio.client import connect
from websockets.exceptions import InvalidStatus

from tests.server.client import joined
from tests.server.conftest import Serving
from tests.server.http import get


async def test_alive_and_ready_are_told_apart_from_unknown_paths(serving: Serving) -> None:
    async with serving() as server:
        assert (await get(server.private_port, "/healthz")).status == 200
        assert (await get(server.private_port, "/readyz")).body == b"ready\n"
        assert (await get(server.private_port, "/")).status == 404
        assert (await get(server.private_port, "/healthz", method="PUT")).status == 405


async def test_head_tells_what_get_would_without_the_body(serving: Serving) -> None:
    async with serving() as server:
        told, sent = [
            await get(server.private_port, "/metrics", method=method) for method in ("HEAD", "GET")
        ]
        assert (told.status, told.body) == (200, b"")
        assert told.headers["content-type"] == sent.headers["content-type"]


async def test_the_private_port_upgrades_nothing(serving: Serving) -> None:
    async with serving() as server:
        for path in ("/ws", "/healthz"):
            with pytest.raises(InvalidStatus, match="403"):
                await connect(f"ws://127.0.0.1:{server.private_port}{path}")


async def test_metrics_tell_what_goes_on(serving: Serving) -> None:
    async with serving(actors=2) as server, joined(server.port) as client:
        await client.ticks(5)
        answer = await get(server.private_port, "/metrics")
        assert answer.status == 200
        assert answer.headers["content-type"].startswith("text/plain; version=0.0.4")
        values = dict(
            line.rsplit(" ", 1)
            for line in answer.body.decode().splitlines()
            if line and not line.startswith("#")
        )
        assert values["esplanade_clients"] == "1.0"
        assert values["esplanade_people"] == "1.0"
        assert values["esplanade_actors"] == "2.0"
        assert values["esplanade_people_seen_total"] == "1.0"
        assert float(values["esplanade_ticks_total"]) >= 5.0
        assert float(values["esplanade_tick_p50_seconds"]) > 0.0
        assert float(values["esplanade_bytes_out_total"]) > 100.0
        assert float(values['esplanade_tick_stage_seconds_total{stage="actors"}']) > 0.0
        assert values["esplanade_contacts_actor_person_total"] == "0.0"
        assert values["esplanade_actor_trips_total"] == "0.0"


@pytest.mark.parametrize("path", ["/metrics", "/healthz"])
async def test_the_public_port_knows_nothing_of_it(serving: Serving, path: str) -> None:
    async with serving() as server:
        assert (await get(server.port, path)).status == 404
