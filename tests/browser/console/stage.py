"""A server that answers as the private port does, with as many avatars as a test wants.

The world in it is no real one: it is there to see how the page bears many avatars, sessions that
end and a line that is cut, none of which a real world does at the moment when a test wants it.
"""

import asyncio
import math
import struct
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from typing import Any, Final

import numpy as np
from fastapi import FastAPI, Request, Response, WebSocket
from fastapi.responses import JSONResponse
from starlette.websockets import WebSocketDisconnect

from esplanade.protocol.snapshot import pack_records
from esplanade.server.assets import CLIENT_ASSETS, SECURITY_HEADERS
from esplanade.server.net.asgi import serving
from tests.browser.console.stage_answers import (
    ACCOUNT,
    PASSWORD,
    actor_message,
    answers,
    contacts,
    entered,
    ground,
    layers,
)

FRAME_S: Final = 0.1
TICKS: Final = 2
"""Ticks from one frame of the map to the next."""
COOKIE: Final = "esplanade_session"


class Stage:
    """The parts of the server that a test may change while the page is open."""

    def __init__(self, actors: int, people: int) -> None:
        self.actors, self.people = actors, people
        self.sessions: set[str] = set()
        self.sockets: set[WebSocket] = set()
        self.first_token: str | None = None
        self.tick = 1000
        self.asked: list[str] = []
        """Paths that were asked for."""
        self.commands: list[dict[str, Any]] = []

    def end_sessions(self) -> None:
        """End the session of everybody."""
        self.sessions.clear()

    async def cut(self) -> None:
        """Cut all live lines."""
        for socket in tuple(self.sockets):
            with suppress(RuntimeError):
                await socket.close(1012)

    def frame(self, *, whole: bool) -> bytes:
        """A frame of the map: everybody walks in circles."""
        count = self.actors + self.people
        index = np.arange(count)
        turn = self.tick * 0.05 / (3.0 + index % 5) + index
        radius = 2.0 + index % 4
        x = 8.0 + (index * 7) % 64 + radius * np.cos(turn)
        y = 8.0 + (index * 11) % 34 + radius * np.sin(turn)
        records = pack_records(
            ids=index + 1,
            layers=np.zeros(count, dtype=int),
            reasons=np.where(index < self.actors, 1 + (index + self.tick // 60) % 6, 0),
            positions_m=np.stack([x, y], axis=1),
            heights_m=np.where(index % 3 == 0, 4.0, 0.0),
            headings_rad=turn + math.pi / 2,
            speeds_mps=np.full(count, 1.0),
            origin_m=(0.0, 0.0),
        )
        return struct.pack("<BBHII", 1, whole, 0, self.tick, count) + records.tobytes()


@asynccontextmanager
async def staged(
    actors: int = 20, people: int = 8, port: int = 0
) -> AsyncIterator[tuple[str, Stage]]:
    """The address of the page and its stage."""
    stage = Stage(actors, people)
    ticking = asyncio.create_task(_tick(stage))
    try:
        async with serving(_app(stage), "127.0.0.1", port) as number:
            yield f"http://127.0.0.1:{number}/console/", stage
    finally:
        ticking.cancel()


async def _tick(stage: Stage) -> None:
    while True:
        await asyncio.sleep(FRAME_S)
        stage.tick += TICKS


def _app(stage: Stage) -> FastAPI:
    app = FastAPI()

    @app.middleware("http")
    async def guard(request: Request, handle: Any) -> Response:
        response: Response = await handle(request)
        for name, value in SECURITY_HEADERS.items():
            response.headers[name] = value
        return response

    @app.get("/console/{rest:path}")
    async def page(rest: str) -> Response:
        file = CLIENT_ASSETS / (rest or "console.html")
        types = {".html": "text/html", ".js": "text/javascript", ".css": "text/css"}
        kind = types.get(file.suffix, "image/svg+xml")
        return Response(file.read_bytes(), media_type=kind)

    @app.api_route("/api/v1/{path:path}", methods=["GET", "POST"])
    async def api(request: Request, path: str) -> Response:
        stage.asked.append(path)
        body = await request.json() if int(request.headers.get("content-length", 0)) else None
        if path in ("login", "first"):
            return _log_in(stage, path, body)
        session = request.cookies.get(COOKIE)
        if session not in stage.sessions:
            return _refused(401, "unauthorized", "log in", first=stage.first_token is not None)
        if path == "logout":
            stage.sessions.discard(session)
            return Response(status_code=204)
        if path == "commands":
            stage.commands.append(body)
        found = answers(stage.tick, stage.actors, stage.people, path, body)
        if found is None:
            return _refused(404, "unknown", f"there is no {path}")
        return JSONResponse(found)

    _add_live(app, stage)
    return app


def _add_live(app: FastAPI, stage: Stage) -> None:
    @app.websocket("/api/v1/live")
    async def live(socket: WebSocket) -> None:
        if socket.cookies.get(COOKIE) not in stage.sessions:
            await socket.close(4001)
            return
        await socket.accept()
        stage.sockets.add(socket)
        wanted: dict[str, dict[str, Any]] = {}
        reading = asyncio.create_task(_read(socket, wanted))
        try:
            await _write(socket, stage, wanted, reading)
        except (RuntimeError, OSError, WebSocketDisconnect):
            pass
        finally:
            reading.cancel()
            stage.sockets.discard(socket)


async def _read(socket: WebSocket, wanted: dict[str, dict[str, Any]]) -> None:
    with suppress(RuntimeError, WebSocketDisconnect):
        while True:
            message = await socket.receive_json()
            if "subscribe" in message:
                wanted[message["subscribe"]] = message
            else:
                wanted.pop(message["unsubscribe"], None)


async def _write(
    socket: WebSocket,
    stage: Stage,
    wanted: dict[str, dict[str, Any]],
    reading: "asyncio.Task[None]",
) -> None:
    told: set[str] = set()
    beat = 0
    while not reading.done() and socket.cookies.get(COOKIE) in stage.sessions:
        for channel in tuple(wanted):
            if channel == "map":
                if channel not in told:
                    await socket.send_json(
                        {
                            "channel": "map",
                            "reset": True,
                            "entered": entered(stage.actors, stage.people),
                            "left": [],
                            "origin_m": [0.0, 0.0],
                        }
                    )
                await socket.send_bytes(stage.frame(whole=channel not in told or beat % 50 == 0))
            elif channel == "map.layers" and beat % 5 == 0:
                await socket.send_json(layers(stage.tick, stage.actors))
            elif channel == "contacts" and beat % 20 == 0:
                await socket.send_json(contacts(stage.tick))
            elif channel == "series" and beat % 10 == 0:
                await socket.send_json({"channel": "series", "tick": stage.tick, "values": {}})
            elif channel.startswith("actor:"):
                await socket.send_json(actor_message(stage.tick, channel))
            told.add(channel)
        told &= wanted.keys()
        beat += 1
        await asyncio.sleep(FRAME_S)
    with suppress(RuntimeError, WebSocketDisconnect):
        await socket.close(4001)


def _log_in(stage: Stage, path: str, body: dict[str, Any]) -> Response:
    if path == "first":
        if body["token"] != stage.first_token:
            return _refused(401, "wrong_token", "this link has been used, or never was one")
        stage.first_token = None
    elif (body["name"], body["password"]) != (ACCOUNT, PASSWORD):
        return _refused(401, "wrong_password", "no account has this name and password")
    session = f"session-{len(stage.asked)}"
    stage.sessions.add(session)
    response = JSONResponse(answers(stage.tick, stage.actors, stage.people, "me", None))
    response.set_cookie(COOKIE, session, path="/api/v1", httponly=True, samesite="strict")
    return response


def _refused(status: int, code: str, text: str, **arguments: Any) -> Response:
    fault = {"code": code, "text": text, "path": [], "arguments": arguments}
    return JSONResponse({"faults": [fault]}, status)


__all__ = ["ACCOUNT", "PASSWORD", "Stage", "ground", "staged"]
