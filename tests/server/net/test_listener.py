import pytest
from websockets.asyncio.client import connect
from websockets.exceptions import InvalidStatus

from tests.server.client import joined
from tests.server.conftest import Serving
from tests.server.http import get


async def test_pages_and_the_socket_share_one_port(serving: Serving) -> None:
    async with serving() as server, joined(server.port):
        page = await get(server.port, "/")
        assert page.status == 200
        assert page.headers["content-type"] == "text/html; charset=utf-8"
        assert b"make client" in page.body


async def test_head_is_answered_without_a_body(serving: Serving) -> None:
    async with serving() as server:
        head = await get(server.port, "/", method="HEAD")
        whole = await get(server.port, "/")
        assert (head.status, head.body) == (200, b"")
        assert head.headers["content-length"] == str(len(whole.body))


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE"])
async def test_only_get_and_head_are_answered(serving: Serving, method: str) -> None:
    async with serving() as server:
        answer = await get(server.port, "/", method=method)
        assert answer.status == 405
        assert answer.headers["allow"] == "GET, HEAD"


@pytest.mark.parametrize(
    "path",
    ["/../server/main.py", "/%2e%2e/%2e%2e/etc/passwd", "//etc/passwd", "//[", "/nothing", "*"],
)
async def test_nothing_outside_the_table_can_be_reached(serving: Serving, path: str) -> None:
    async with serving() as server:
        assert (await get(server.port, path)).status == 404


async def test_a_plain_get_of_the_socket_is_told_to_upgrade(serving: Serving) -> None:
    async with serving() as server:
        assert (await get(server.port, "/ws")).status == 426


async def test_foreign_pages_are_refused_where_origins_are_named(serving: Serving) -> None:
    async with serving(allowed_origins="https://esplanade.example") as server:
        url = f"ws://127.0.0.1:{server.port}/ws"
        async with connect(url, origin="https://esplanade.example", proxy=None):  # type: ignore[arg-type]
            pass
        with pytest.raises(InvalidStatus) as refused:
            async with connect(url, origin="https://evil.example", proxy=None):  # type: ignore[arg-type]
                pass
        assert refused.value.response.status_code == 403
        async with joined(server.port):
            pass


async def test_connections_at_the_door_are_bounded(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("esplanade.server.net.listener.MAX_UNGREETED", 1)
    async with serving(max_clients=1) as server, joined(server.port):
        url = f"ws://127.0.0.1:{server.port}/ws"
        async with connect(url, proxy=None):
            with pytest.raises(InvalidStatus) as refused:
                async with connect(url, proxy=None):
                    pass
        assert refused.value.response.status_code == 503
