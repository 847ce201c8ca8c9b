"""Worlds with operators, for their page."""

from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager
from typing import Any

from esplanade.server.accounts.identity import MACHINE
from esplanade.server.app import Running
from tests.browser.console.stage_answers import PASSWORD
from tests.browser.worlds import built, served
from tests.server.console.operators import Operator


@asynccontextmanager
async def operated(roles: Mapping[str, str], **changes: Any) -> AsyncIterator[Running]:
    """A running world with operators, by their names; all have the same password."""
    built("console.html")
    async with served(**changes) as server:
        for name, role in roles.items():
            await server.kept.directory.add(MACHINE, name, role, PASSWORD)
        yield server


async def script_of(server: Running, name: str, about: str) -> Operator:
    """A script of an operator, which is not the page."""
    token = await server.kept.tokens.add(MACHINE, name, about)
    return Operator(server.private_port, token)
