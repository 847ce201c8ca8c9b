"""A browser's side of the private port for tests: a cookie, a page's origin, JSON."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from esplanade.server.accounts.identity import MACHINE
from esplanade.server.app import Running
from tests.server.http import Answer, get

PASSWORD = "correct horse battery"


@dataclass
class Browser:
    """Sends what a page of the private port would, and keeps the cookie."""

    port: int
    host: str = ""
    cookie: str = ""
    headers: dict[str, str] = field(default_factory=dict)

    async def send(
        self, method: str, path: str, body: Any = None, **headers: str | None
    ) -> tuple[int, Any]:
        answer = await self.raw(method, path, body, headers)
        return answer.status, json.loads(answer.body) if answer.body else None

    async def raw(
        self,
        method: str,
        path: str,
        body: Any = None,
        headers: Mapping[str, str | None] | None = None,
    ) -> Answer:
        host = self.host or f"localhost:{self.port}"
        fields: dict[str, str | None] = {
            "Host": host,
            "Origin": None if method == "GET" else f"http://{host}",
            "Cookie": f"esplanade_session={self.cookie}" if self.cookie else None,
            "X-Esplanade": None if method == "GET" else "1",
            "Content-Type": None if body is None else "application/json",
            **self.headers,
            **{name.replace("_", "-"): value for name, value in (headers or {}).items()},
        }
        given = {name: value for name, value in fields.items() if value is not None}
        data = b"" if body is None else json.dumps(body).encode()
        answer = await get(self.port, f"/api/v1{path}", given, method, data)
        set_cookie = answer.headers.get("set-cookie", "")
        if set_cookie.startswith("esplanade_session="):
            self.cookie = set_cookie.partition(";")[0].partition("=")[2].strip('"')
        return answer

    async def log_in(self, name: str, password: str = PASSWORD) -> tuple[int, Any]:
        return await self.send("POST", "/login", {"name": name, "password": password})


async def logged_in(server: Running, name: str, role: str) -> Browser:
    """A new account of that role, logged in."""
    await server.kept.directory.add(MACHINE, name, role, PASSWORD)
    browser = Browser(server.private_port)
    status, body = await browser.log_in(name)
    assert status == 200, body
    return browser


def codes(body: Any) -> list[str]:
    """The codes of the faults in an answer."""
    return [fault["code"] for fault in body["faults"]]
