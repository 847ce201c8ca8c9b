"""Consoles for tests: real sockets on real servers, that subscribe and keep what they are sent."""

import asyncio
import json
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import Any

import numpy as np
from websockets.asyncio.client import ClientConnection, connect

from esplanade.protocol.snapshot import RECORD, Records
from tests.patience import PATIENCE_S


class LiveConsole:
    """One socket: what it was told, by channel, and the map as a page would draw it."""

    def __init__(self, socket: ClientConnection) -> None:
        self.socket = socket
        self.told: list[dict[str, Any]] = []
        self.frames: list[tuple[bool, int, Records]] = []
        """(key, tick, records) of each binary frame."""
        self.entities: dict[int, dict[str, Any]] = {}
        self.records: dict[int, tuple[Any, ...]] = {}

    async def send(self, **message: Any) -> None:
        await self.socket.send(json.dumps(message))

    async def subscribe(self, channel: str, **arguments: Any) -> None:
        await self.send(subscribe=channel, **arguments)

    async def settled(self) -> None:
        """Wait until the server has taken in all that was sent: it refuses what comes last."""
        await self.send(subscribe="nothing")
        await self.next("nothing")

    async def until(self, done: Callable[[], Any]) -> Any:
        """Read messages until something holds; returns what that was."""
        async with asyncio.timeout(PATIENCE_S):
            while not (found := done()):
                self._take(await self.socket.recv())
        return found

    async def next(self, channel: str, **fields: Any) -> dict[str, Any]:
        """The next message of a channel, from now on, that has these fields."""
        seen = len(self.told)

        def found() -> list[dict[str, Any]]:
            return [
                each
                for each in self.told[seen:]
                if each["channel"] == channel and fields.items() <= each.items()
            ]

        return (await self.until(found))[0]

    async def event(self, kind: str, **fields: Any) -> dict[str, Any]:
        """The first event of a kind that has these fields, of all that were told or will be."""

        def found() -> list[dict[str, Any]]:
            return [
                event
                for message in self.told
                if message["channel"] == "events"
                for event in message.get("events", [])
                if event["kind"] == kind and fields.items() <= event.items()
            ]

        return (await self.until(found))[0]

    def _take(self, message: str | bytes) -> None:
        if isinstance(message, str):
            told = json.loads(message)
            self.told.append(told)
            if told["channel"] == "map" and "faults" not in told:
                if told["reset"]:
                    self.entities, self.records = {}, {}
                self.entities |= {each["id"]: each for each in told["entered"]}
                for gone in told["left"]:
                    self.entities.pop(gone, None)
                    self.records.pop(gone, None)
            return
        kind, key, _, tick, count = np.frombuffer(
            message[:12], [("", "u1"), ("", "u1"), ("", "<u2"), ("", "<u4"), ("", "<u4")]
        )[0].tolist()
        assert kind == 1
        records = np.frombuffer(message[12:], RECORD)
        assert len(records) == count
        self.frames.append((bool(key), tick, records))
        self.records |= {record[0]: record for record in records.tolist()}


@asynccontextmanager
async def live_console(
    port: int, token: str, path: str = "", **options: Any
) -> AsyncIterator[LiveConsole]:
    """A console with an open socket; the path is that of a zone."""
    async with connect(
        f"ws://127.0.0.1:{port}{path}/api/v1/live",
        additional_headers={"Authorization": f"Bearer {token}", **options.pop("headers", {})},
        compression=None,
        **options,
    ) as socket:
        yield LiveConsole(socket)
