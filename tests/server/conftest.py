"""Servers for tests: real ports, real time, a small room."""

from collections.abc import AsyncIterator, Callable
from contextlib import AbstractAsyncContextManager, asynccontextmanager
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from esplanade.server.app import Running, running
from esplanade.server.assets import Assets
from esplanade.server.settings import ServerSettings
from tests.server.client import PLACING_KEY
from tests.server.stores import database_server, location, store
from tests.server.worlds import ROOM

__all__ = ["database_server", "location", "store"]

NO_CLIENT = Assets.load(Path("no such folder"))

Serving = Callable[..., AbstractAsyncContextManager[Running]]
ServingAssets = Callable[..., AbstractAsyncContextManager[Running]]


@pytest.fixture
def room_file(tmp_path: Path) -> Path:
    path = tmp_path / "room.json"
    path.write_text(ROOM.model_dump_json())
    return path


@pytest.fixture
def serving(serving_assets: ServingAssets) -> Serving:
    """`async with serving(actors=2) as server`: settings by name, the rest as tests need it."""
    return partial(serving_assets, NO_CLIENT)


@pytest.fixture
def serving_assets(room_file: Path) -> ServingAssets:
    """`async with serving_assets(assets, actors=2) as server`: the same with other pages."""

    @asynccontextmanager
    async def serve(assets: Assets, **changes: Any) -> AsyncIterator[Running]:
        values: dict[str, Any] = {
            "scene": room_file,
            "host": "127.0.0.1",
            "port": 0,
            "private_port": 0,
            "actors": 0,
            "operator_key": PLACING_KEY,
            "operator_commands": 1_000_000,
        }
        async with running(ServerSettings(**{**values, **changes}), assets) as server:
            yield server

    return serve
