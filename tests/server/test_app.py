import asyncio
from contextlib import AsyncExitStack
from pathlib import Path

import pytest
from websockets.exceptions import ConnectionClosed

from esplanade.planning import Polygon, Scene
from esplanade.protocol import ByeCode, CloseCode
from esplanade.protocol.messages import Bye
from esplanade.server.app import running
from esplanade.server.loading import LoadingError
from esplanade.server.settings import ServerSettings
from tests.server.client import connected, joined
from tests.server.conftest import NO_CLIENT, Serving
from tests.server.http import get
from tests.server.worlds import write_mesh_world


async def test_a_stopping_server_says_goodbye_to_everyone(serving: Serving) -> None:
    async with AsyncExitStack() as clients:
        async with serving() as server:
            ann = await clients.enter_async_context(joined(server.port, "Ann"))
            silent = await clients.enter_async_context(connected(server.port))
            reading = asyncio.create_task(ann.last_words())
        messages, code = await reading
        assert code == CloseCode.GOING_AWAY
        last = messages[-1]
        assert isinstance(last, Bye)
        assert last.reason is ByeCode.SHUTDOWN
        with pytest.raises(ConnectionClosed):
            await silent.next()
        with pytest.raises(OSError, match="Connect call failed"):
            await get(server.port, "/")


async def test_a_client_that_does_not_answer_the_goodbye_is_cut_off(serving: Serving) -> None:
    async with AsyncExitStack() as clients:
        async with serving() as server:
            ann = await clients.enter_async_context(joined(server.port, "Ann"))
            ann.connection.transport.pause_reading()
        assert server.ticking.done()
        ann.connection.transport.abort()


async def test_the_summary_has_the_run_in_figures(serving: Serving) -> None:
    async with serving(actors=1) as server, joined(server.port) as client:
        await client.ticks(5)
        summary = server.summary()
    assert summary["people_seen"] == 1
    assert summary["ticks"] >= 5
    assert 0.0 < summary["tick_p50_ms"] <= summary["tick_p99_ms"]
    assert summary["trips_completed"] == summary["contacts_actor_person"] == 0


async def test_a_fault_in_the_world_ends_the_server_instead_of_freezing_it(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def break_the_world() -> None:
        async with serving() as server:
            monkeypatch.setattr(server.world, "finish", lambda _: 1 // 0)
            await asyncio.wait([server.ticking])

    with pytest.raises(ZeroDivisionError):
        await break_the_world()


async def test_a_scene_without_room_is_refused_by_name(tmp_path: Path) -> None:
    block = Polygon(
        points=((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)), height_m=2.0, kind="water"
    )
    scene = Scene.open_space((0.0, 0.0, 4.0, 4.0), polygons=[block], name="stone")
    path = tmp_path / "stone.json"
    path.write_text(scene.model_dump_json())
    settings = ServerSettings(scene=path, port=0, private_port=0)
    with pytest.raises(LoadingError, match="'stone': main/actor-1: no free place"):
        async with running(settings, NO_CLIENT):
            pass


async def test_a_building_from_a_mesh_is_handed_out(serving: Serving, tmp_path: Path) -> None:
    path = write_mesh_world(tmp_path)
    async with serving(scene=path) as server, joined(server.port) as client:
        assert client.welcome is not None
        scene = client.welcome.scene
        assert scene["storeys"] == [0.0, 3.0]
        answer = await get(server.port, f"/{scene['mesh']}")
    assert (answer.status, len(answer.body)) == (200, 4 * 36)
    assert "immutable" in answer.headers["cache-control"]


async def test_a_scene_of_polygons_has_storeys_and_no_mesh(serving: Serving) -> None:
    async with serving() as server, joined(server.port) as client:
        assert client.welcome is not None
        assert client.welcome.scene["storeys"] == [0.0]
        assert "mesh" not in client.welcome.scene
