"""A world below a path, with proxies that take the path away and with those that do not."""

from http import HTTPStatus

import pytest
from websockets.asyncio.client import connect
from websockets.exceptions import InvalidStatus

from esplanade.bots.address import websocket_url
from esplanade.server.assets import Assets
from tests.server.conftest import Serving, ServingAssets
from tests.server.http import get


@pytest.mark.parametrize("root_path", ["/world", "/world/", "/a/b-1"])
async def test_page_data_and_socket_are_below_the_root_path_and_without_it(
    serving_assets: ServingAssets, root_path: str
) -> None:
    assets, address = Assets.load().with_data("mesh", b"12345")
    root = root_path.rstrip("/")
    async with serving_assets(assets, root_path=root_path) as server:
        for path in (root, ""):
            assert (await get(server.port, f"{path}/")).status == HTTPStatus.OK
            assert (await get(server.port, f"{path}/index.html?x=1")).status == HTTPStatus.OK
            assert (await get(server.port, f"{path}/{address}")).body == b"12345"
            async with connect(f"ws://127.0.0.1:{server.port}{path}/ws", proxy=None):
                pass
        async with connect(websocket_url(f"ws://127.0.0.1:{server.port}{root}/"), proxy=None):
            pass


async def test_the_page_is_named_with_a_slash(serving: Serving) -> None:
    async with serving(root_path="/world") as server:
        answer = await get(server.port, "/world?x=1")
        assert answer.status == HTTPStatus.PERMANENT_REDIRECT
        assert answer.headers["location"] == "/world/?x=1"


@pytest.mark.parametrize("path", ["/worlds/", "/worldws", "/other/", "/world/world/", "/world//"])
async def test_other_paths_are_not_there(serving: Serving, path: str) -> None:
    async with serving(root_path="/world") as server:
        assert (await get(server.port, path)).status == HTTPStatus.NOT_FOUND


async def test_without_a_root_path_there_is_nothing_below_any(serving: Serving) -> None:
    async with serving() as server:
        assert (await get(server.port, "/world/")).status == HTTPStatus.NOT_FOUND
        with pytest.raises(InvalidStatus, match="404"):
            await connect(f"ws://127.0.0.1:{server.port}/world/ws", proxy=None)
