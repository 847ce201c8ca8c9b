"""Requests to a server, and commands as such."""

import asyncio
from collections.abc import Mapping
from typing import Any

from esplanade.operators import http
from esplanade.protocol.commands import Answer, Command


class Conversation:
    """Asks one server by one token."""

    def __init__(self, url: str, token: str) -> None:
        self._url = url
        self._token = token

    async def send(self, command: Command | Mapping[str, Any]) -> Answer:
        """Send one command."""
        return Answer.model_validate(await self._ask("/commands", _plain(command)))

    async def send_all(self, *commands: Command | Mapping[str, Any]) -> list[Answer]:
        """Send commands that are carried out in one tick: all of them, or none."""
        answers = await self._ask("/commands", [_plain(command) for command in commands])
        return [Answer.model_validate(answer) for answer in answers]

    async def _ask(self, path: str, body: Any = None, method: str | None = None) -> Any:
        return await asyncio.to_thread(http.ask, self._url, self._token, path, body, method)


def _plain(command: Command | Mapping[str, Any]) -> dict[str, Any]:
    if isinstance(command, Mapping):
        return dict(command)
    return command.model_dump(mode="json")
