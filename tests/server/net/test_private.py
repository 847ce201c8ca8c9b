import re
import socket
import threading
import time
from http.client import HTTPConnection

import pytest
from websockets.asyncio.client import connect
from websockets.exceptions import InvalidStatus

from tests.patience import PATIENCE_S
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


async def test_a_stuck_world_is_told_truthfully(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("esplanade.server.net.readiness.STALLED_S", 0.5)
    monkeypatch.setattr("esplanade.server.net.health.SAMPLE_LIMIT_S", 0.1)
    async with serving() as server, joined(server.port) as client:
        await client.ticks(2)
        await get(server.private_port, "/metrics")
        # From here on to the next await the world is stuck: this test has its event loop.
        time.sleep(0.6)  # noqa: ASYNC251
        assert at_once(server.private_port, "/healthz") == (200, "alive\n")
        status, text = at_once(server.private_port, "/readyz")
        assert (status, text[:12]) == (503, "no tick for ")
        status, text = at_once(server.private_port, "/metrics")
        assert status == 200
        assert "esplanade_people 1.0" in text
        for name in ("tick_age_seconds", "sample_age_seconds"):
            (age,) = re.findall(rf"^esplanade_{name} (\S+)$", text, re.MULTILINE)
            assert float(age) > 0.5
        await client.ticks(2)
        assert (await get(server.private_port, "/readyz")).status == 200


async def test_figures_are_read_by_the_thread_that_changes_them(serving: Serving) -> None:
    async with serving() as server:
        readers: set[int] = set()

        def read() -> float:
            readers.add(threading.get_ident())
            return 7.0

        server.metrics.gauge("readers", "Who reads", read)
        assert b"esplanade_readers 7.0" in (await get(server.private_port, "/metrics")).body
        assert readers == {threading.get_ident()}


async def test_a_figure_that_cannot_be_read_ends_nothing(serving: Serving) -> None:
    async with serving() as server:
        server.metrics.gauge("broken", "Nothing", lambda: 1 // 0)
        assert (await get(server.private_port, "/metrics")).status == 500
        assert (await get(server.private_port, "/healthz")).status == 200


async def test_a_taken_private_port_is_refused(serving: Serving) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(OSError, match=str(port)):
            await serving(private_port=port).__aenter__()


def at_once(port: int, path: str) -> tuple[int, str]:
    """The answer to a request, while nothing else runs in this thread."""
    connection = HTTPConnection("127.0.0.1", port, timeout=PATIENCE_S)
    try:
        connection.request("GET", path)
        answer = connection.getresponse()
        return answer.status, answer.read().decode()
    finally:
        connection.close()
