"""Every application on the private port can rely on this, whatever its clients do."""

import asyncio
import json
import socket
from collections.abc import AsyncIterator

import pytest
from fastapi import FastAPI, WebSocket
from fastapi.responses import StreamingResponse
from pydantic import BaseModel, Field
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosedError

from esplanade.server.net import asgi, lingering
from tests.patience import PATIENCE_S
from tests.server.http import get

CHUNK = bytes(64 * 1024)


class Speed(BaseModel):
    speed_mps: float = Field(ge=0.0)


def application() -> FastAPI:
    """An API such as operators may get: models, a stream, a WebSocket."""
    app = FastAPI(max_body_size=asgi.MAX_BODY_BYTES)
    app.state.stream_ended = asyncio.Event()

    @app.post("/speed")
    async def set_speed(speed: Speed) -> Speed:
        return Speed(speed_mps=2.0 * speed.speed_mps)

    @app.get("/endless")
    async def endless() -> StreamingResponse:
        async def chunks() -> AsyncIterator[bytes]:
            try:
                while True:
                    await asyncio.sleep(0)
                    yield CHUNK
            finally:
                app.state.stream_ended.set()

        return StreamingResponse(chunks())

    @app.websocket("/echo")
    async def echo(connection: WebSocket) -> None:
        await connection.accept()
        async for text in connection.iter_text():
            await connection.send_text(text)

    return app


async def test_a_body_is_checked_by_its_model() -> None:
    async with asgi.serving(application(), "127.0.0.1", 0) as port:
        json_type = {"Content-Type": "application/json"}
        good = await get(port, "/speed", json_type, "POST", b'{"speed_mps": 1.5}')
        assert (good.status, json.loads(good.body)) == (200, {"speed_mps": 3.0})
        bad = await get(port, "/speed", json_type, "POST", b'{"speed_mps": -1}')
        assert bad.status == 422
        assert b"greater_than_equal" in bad.body
        assert (await get(port, "/speed")).status == 405
        assert good.headers["x-content-type-options"] == "nosniff"
        described = json.loads((await get(port, "/openapi.json")).body)
        assert (
            described["components"]["schemas"]["Speed"]["properties"]["speed_mps"]["minimum"] == 0
        )


async def test_what_is_too_long_is_refused() -> None:
    async with asgi.serving(application(), "127.0.0.1", 0) as port:
        body = b'"' + b"x" * asgi.MAX_BODY_BYTES + b'"'
        assert (await get(port, "/speed", method="POST", body=body)).status == 413
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        writer.write(b"GET / HTTP/1.1\r\nX-Long: " + b"x" * 32 * asgi.MAX_HEAD_BYTES)
        assert (await _to_the_end(reader))[:12] == b"HTTP/1.1 400"
        writer.close()


async def test_an_early_answer_reaches_a_client_that_is_still_sending() -> None:
    """Closing on what is unread would reset the connection, and the answer would be lost."""
    async with asgi.serving(application(), "127.0.0.1", 0) as port:
        body = bytes(lingering.LINGER_BYTES // 2)
        for _ in range(20):
            answer = await get(port, "/speed", method="POST", body=body)
            assert answer.status == 413
            assert len(answer.body) == int(answer.headers["content-length"])


@pytest.mark.parametrize("sends_on", [True, False], ids=["endless", "silent"])
async def test_a_client_that_has_its_answer_does_not_stay_for_ever(
    monkeypatch: pytest.MonkeyPatch, sends_on: bool
) -> None:
    monkeypatch.setattr(lingering, "LINGER_S", PATIENCE_S if sends_on else 0.2)
    monkeypatch.setattr(asgi, "MAX_CONNECTIONS", 1)
    async with asgi.serving(application(), "127.0.0.1", 0) as port, asyncio.timeout(PATIENCE_S):
        _, writer = await _too_long_by(port, 10**12)
        # Only the end of the connection makes room for another.
        while not await _is_answered(port):
            if sends_on:
                writer.write(bytes(asgi.MAX_BODY_BYTES))
            await asyncio.sleep(0.01)
        writer.close()


async def _too_long_by(port: int, unsent: int) -> tuple[asyncio.StreamReader, asyncio.StreamWriter]:
    """A request with too long a body, of which so many bytes are still to be sent."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    length = 2 * asgi.MAX_BODY_BYTES + unsent
    fields = f"Host: x\r\nConnection: close\r\nContent-Length: {length}"
    head = f"POST /speed HTTP/1.1\r\n{fields}\r\n\r\n"
    writer.write(head.encode() + bytes(2 * asgi.MAX_BODY_BYTES))
    return reader, writer


async def _is_answered(port: int) -> bool:
    try:
        return (await get(port, "/nothing")).status == 404
    except (ConnectionError, IndexError):  # nothing at all came
        return False


async def test_web_sockets_are_carried_and_bounded() -> None:
    async with (
        asgi.serving(application(), "127.0.0.1", 0) as port,
        connect(f"ws://127.0.0.1:{port}/echo") as connection,
    ):
        await connection.send("hello")
        assert await connection.recv() == "hello"
        await connection.send("x" * (asgi.MAX_BODY_BYTES + 1))
        with pytest.raises(ConnectionClosedError, match="1009"):
            await connection.recv()


async def test_a_web_socket_stays_open_for_longer_than_a_request_may_take(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(asgi, "PATIENCE_S", 0.2)
    async with (
        asgi.serving(application(), "127.0.0.1", 0) as port,
        asyncio.timeout(PATIENCE_S),
        connect(f"ws://127.0.0.1:{port}/echo", proxy=None) as client,
    ):
        await asyncio.sleep(0.6)
        await client.send("still here")
        assert await client.recv() == "still here"


async def test_an_open_web_socket_holds_no_stop_up() -> None:
    async with asgi.serving(application(), "127.0.0.1", 0) as port:
        connection = await connect(f"ws://127.0.0.1:{port}/echo")
    with pytest.raises(ConnectionClosedError, match="1012"):
        await connection.recv()
    await connection.close()


@pytest.mark.parametrize(
    "sent",
    [b"", b"GET /nothing HT", b"POST /speed HTTP/1.1\r\nHost: x\r\nContent-Length: 9\r\n\r\n{"],
    ids=["nothing", "half a line", "half a body"],
)
async def test_half_a_request_is_cut_off(sent: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(asgi, "PATIENCE_S", 0.2)
    async with asgi.serving(application(), "127.0.0.1", 0) as port:
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        writer.write(sent)
        assert await _to_the_end(reader) == b""
        writer.close()


async def test_who_does_not_read_is_cut_off(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(asgi, "PATIENCE_S", 0.2)
    app = application()
    async with asgi.serving(app, "127.0.0.1", 0) as port, asyncio.timeout(PATIENCE_S):
        _, writer = await _unread_stream(port)
        await app.state.stream_ended.wait()
        writer.close()


async def test_who_does_not_read_holds_no_stop_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(asgi, "SHUT_S", 1.0)
    app = application()
    async with asyncio.timeout(PATIENCE_S):
        async with asgi.serving(app, "127.0.0.1", 0) as port:
            _, writer = await _unread_stream(port)
        assert app.state.stream_ended.is_set()
        writer.close()


async def test_a_client_that_reads_steadily_is_not_cut_off(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(asgi, "PATIENCE_S", 2.0)
    app = application()
    async with asgi.serving(app, "127.0.0.1", 0) as port, asyncio.timeout(PATIENCE_S):
        reader, writer = await _unread_stream(port)
        begin = asyncio.get_running_loop().time()
        while asyncio.get_running_loop().time() < begin + 3.0:
            await reader.readexactly(len(CHUNK))
        assert not app.state.stream_ended.is_set()
        writer.close()


async def test_connections_are_bounded_and_a_place_is_free_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(asgi, "MAX_CONNECTIONS", 2)
    async with asgi.serving(application(), "127.0.0.1", 0) as port, asyncio.timeout(PATIENCE_S):
        async with connect(f"ws://127.0.0.1:{port}/echo") as first:
            _, second = await asyncio.open_connection("127.0.0.1", port)
            third, writer = await asyncio.open_connection("127.0.0.1", port)
            assert await _to_the_end(third) == b""
            writer.close()
            await first.send("still here")
            assert await first.recv() == "still here"
        # The client of a WebSocket is told of its end once the server has let go of it.
        assert (await get(port, "/nothing")).status == 404
        second.close()


async def test_a_connection_serves_one_request_after_another() -> None:
    async with asgi.serving(application(), "127.0.0.1", 0) as port, asyncio.timeout(PATIENCE_S):
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        for _ in range(3):
            writer.write(b"GET /nothing HTTP/1.1\r\nHost: x\r\n\r\n")
            head = await reader.readuntil(b"\r\n\r\n")
            assert head.startswith(b"HTTP/1.1 404")
            await reader.readexactly(len(b'{"detail":"Not Found"}'))
        writer.close()


async def test_a_taken_port_is_refused_as_for_any_other_server() -> None:
    loop = asyncio.get_running_loop()
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(OSError, match=str(port)) as ours:
            async with asgi.serving(application(), "127.0.0.1", port):
                raise AssertionError("two servers share a port")
        with pytest.raises(OSError, match=str(port)) as plain:
            await loop.create_server(asyncio.Protocol, "127.0.0.1", port)
    assert ours.value.errno == plain.value.errno


async def _unread_stream(port: int) -> tuple[asyncio.StreamReader, asyncio.StreamWriter]:
    reader, writer = await asyncio.open_connection("127.0.0.1", port, limit=1024)
    writer.write(b"GET /endless HTTP/1.1\r\nHost: x\r\n\r\n")
    await reader.readuntil(b"\r\n\r\n")
    return reader, writer


async def _to_the_end(reader: asyncio.StreamReader) -> bytes:
    async with asyncio.timeout(PATIENCE_S):
        try:
            return await reader.read()
        except ConnectionResetError:
            return b""
