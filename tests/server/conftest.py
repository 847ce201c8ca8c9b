"""Servers for tests: real ports, real time, a small room."""

from collections.abc import AsyncIterator, Callable
from contextlib import AbstractAsyncContextManager, asynccontextmanager
from pathlib import Path
from typing import Any

import pytest

from esplanade.server.app import Running, running
from esplanade.server.assets import Assets
from esplanade.server.settings import ServerSettings
from tests.server.worlds import ROOM

NO_CLIENT = Assets.load(Path("no such folder"))

Serving = Callable[..., AbstractAsyncContextManager[Running]]


@pytest.fixture
def room_file(tmp_path: Path) -> Path:
    path = tmp_path / "room.json"
    path.write_text(ROOM.model_dump_json())
    return path


@pytest.fixture
def serving(room_file: Path) -> Serving:
    """`async with serving(actors=2) as server`: settings by name, the rest as tests need it."""

    @asynccontextmanager
    async def serve(**changes: Any) -> AsyncIterator[Running]:
        values: dict[str, Any] = {
            "scene": room_file,
            "host": "127.0.0.1",
            "port": 0,
            "private_port": 0,
            "actors": 0,
        }
        async with running(ServerSettings(**{**values, **changes}), NO_CLIENT) as server:
            yield server

    return serve
