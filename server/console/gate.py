"""The gate between operators' requests and the zone: who asks, and the way to the zone's loop."""

import asyncio
from collections.abc import Callable, Coroutine
from http import HTTPStatus
from typing import Any, Final, TypeVar

from fastapi import Request

from esplanade.server.accounts.identity import Identity
from esplanade.server.accounts.tokens import Tokens
from esplanade.server.audit.log import AuditLog
from esplanade.server.console.console import Console
from esplanade.server.console.refusals import RefusedError

Result = TypeVar("Result")
HEADER: Final = "X-Esplanade"
"""Pages of others cannot send this header: requests that change something must have it."""
SAFE: Final = frozenset({"GET", "HEAD", "OPTIONS"})
MOST_UNDER_WAY: Final = 64
"""Requests that may wait for the zone at once; more are refused."""
_SCHEME: Final = "bearer "


class Gate:
    """Lets requests of the private port's thread through to the console in the zone's loop."""

    def __init__(self, tokens: Tokens, audit: AuditLog, zone: asyncio.AbstractEventLoop) -> None:
        self.audit = audit
        self.console: Console | None = None
        """None until the world is built, and again when it ends."""
        self._tokens = tokens
        self._zone = zone
        self.under_way = 0
        """Requests that wait for the zone."""

    async def identity(self, request: Request) -> Identity:
        """Return the identity of the caller, by the token in `Authorization`.

        Raises
        ------
        RefusedError
            There is no token, or it opens nothing; or the header against forged requests is
            missing.
        StoreError
            It cannot be looked up.
        """
        given = request.headers.get("authorization", "")
        if not given.lower().startswith(_SCHEME):
            text = "send a token of yours: Authorization: Bearer esplanade_…"
            raise RefusedError.of("unauthorized", text)
        address = request.client.host if request.client else None
        identity = await self._tokens.identity(given[len(_SCHEME) :].strip(), address)
        if identity is None:
            raise RefusedError.of("unauthorized", "this token opens nothing, or no longer does")
        if request.method not in SAFE and not request.headers.get(HEADER):
            text = f"a request that changes something needs the header {HEADER}: 1"
            raise RefusedError.of("header_missing", text)
        return identity

    async def call(self, work: Callable[[Console], Coroutine[Any, Any, Result]]) -> Result:
        """Do some work on the zone's loop, and return its result.

        It goes on there when the request is broken off: a command is done wholly or not at all.

        Raises
        ------
        RefusedError
            There is no world yet, or too many requests wait.
        """
        console = self.console
        if console is None:
            raise RefusedError.of("busy", "the world is not ready")
        if self.under_way >= MOST_UNDER_WAY:
            raise RefusedError.of("busy", f"{MOST_UNDER_WAY} requests wait already")
        self.under_way += 1
        running = asyncio.wrap_future(asyncio.run_coroutine_threadsafe(work(console), self._zone))
        running.add_done_callback(self._ended)
        return await asyncio.shield(running)

    def _ended(self, running: "asyncio.Future[Any]") -> None:
        self.under_way -= 1
        if not running.cancelled():
            running.exception()  # whoever asked may be gone


STATUS: Final = {
    "unauthorized": HTTPStatus.UNAUTHORIZED,
    "forbidden": HTTPStatus.FORBIDDEN,
    "header_missing": HTTPStatus.FORBIDDEN,
    "conflict": HTTPStatus.CONFLICT,
    "taken": HTTPStatus.CONFLICT,
    "superseded": HTTPStatus.CONFLICT,
    "unknown_change": HTTPStatus.NOT_FOUND,
    "unknown_preset": HTTPStatus.NOT_FOUND,
    "unknown_schedule": HTTPStatus.NOT_FOUND,
    "busy": HTTPStatus.SERVICE_UNAVAILABLE,
    "not_known": HTTPStatus.GATEWAY_TIMEOUT,
    "failed": HTTPStatus.INTERNAL_SERVER_ERROR,
}
"""The HTTP status for the code of a refusal's first fault; all others are 422."""


def status_of(refusal: RefusedError) -> int:
    """The status of the answer to a refused request."""
    code = refusal.faults[0].code
    return int(STATUS.get(code, HTTPStatus.UNPROCESSABLE_ENTITY))
