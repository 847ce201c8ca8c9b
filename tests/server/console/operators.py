"""Operators for tests: real servers, real tokens, requests as a script sends them."""

import asyncio
import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from esplanade.server.accounts.identity import MACHINE
from esplanade.server.app import Running
from tests.server.http import get


@dataclass
class Operator:
    """Asks a server by a token; each request gives the status and the body.

    With a zone, all requests are about that one.
    """

    port: int
    token: str
    zone: str = ""

    async def get(self, path: str) -> tuple[int, Any]:
        return await self.request("GET", path)

    async def send(self, commands: Any) -> tuple[int, Any]:
        headers = {"X-Esplanade": "1", "Content-Type": "application/json"}
        return await self.request("POST", "/commands", headers, json.dumps(commands).encode())

    async def request(
        self, method: str, path: str, headers: Mapping[str, str] | None = None, body: bytes = b""
    ) -> tuple[int, Any]:
        fields = {"Authorization": f"Bearer {self.token}", **(headers or {})}
        at = f"/api/v1/zones/{self.zone}{path}" if self.zone else f"/api/v1{path}"
        answer = await get(self.port, at, fields, method, body)
        return answer.status, json.loads(answer.body)

    async def values(self, actor: str) -> dict[str, Any]:
        status, found = await self.get(f"/actors/{actor}")
        assert status == 200, found
        return {name: source["value"] for name, source in found["parameters"].items()}


async def operator(server: Running, name: str, role: str) -> Operator:
    """A new account of that role, and its token, once consoles know who is in the world.

    A world that is paused from its beginning is not waited for.
    """
    for _ in range(50):
        if server.live.map.tick > 0:
            break
        await asyncio.sleep(0.02)
    await server.kept.directory.add(MACHINE, name, role, None)
    token = await server.kept.tokens.add(MACHINE, name, "script")
    return Operator(server.private_port, token)
