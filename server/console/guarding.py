"""Paths of the operators' interface that are not looked at before it is known who asks."""

from collections.abc import Callable, Coroutine
from typing import Any, Final

from fastapi import Request, Response
from fastapi.routing import APIRoute
from pydantic import BaseModel

from esplanade.protocol.commands import CommandFault
from esplanade.server.accounts.identity import Identity
from esplanade.server.accounts.rights import Right
from esplanade.server.console.gate import Gate
from esplanade.server.console.refusals import RefusedError


class Refusal(BaseModel):
    """Nothing was changed, and why."""

    faults: list[CommandFault]


REFUSALS: Final[dict[int | str, dict[str, Any]]] = {
    status: {"model": Refusal, "description": text}
    for status, text in {
        401: "There is no token, or it opens nothing.",
        403: "The token does not have the right, or the header X-Esplanade is missing.",
        404: "There is no such thing.",
        409: "Somebody has changed the same since; both values are told.",
        422: "Something in it cannot be; the path of each fault says where.",
        503: "Too much waits, or the world is not ready.",
    }.items()
}


class Guarded(APIRoute):
    """A path whose body is not looked at before it is known who sends it."""

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        handle = super().get_route_handler()

        async def guarded(request: Request) -> Response:
            request.state.identity = await gate_of(request).identity(request)
            return await handle(request)

        return guarded


def gate_of(request: Request) -> Gate:
    """The gate of the application that was asked."""
    gate: Gate = request.app.state.gate
    return gate


def check_right(request: Request, right: Right) -> None:
    """Raise RefusedError unless the caller has that right."""
    identity: Identity = request.state.identity
    if right not in identity.rights:
        text = f"this needs the right {right.value}, which you do not have"
        raise RefusedError.of("forbidden", text, right=right.value)


def may_watch(request: Request) -> None:
    """Raise RefusedError unless the caller may see the world."""
    check_right(request, Right.WATCH)
