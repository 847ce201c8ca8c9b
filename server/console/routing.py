"""The shared parts of the routers of the private port: callers, their rights, and refusals."""

from collections.abc import Callable, Coroutine
from http import HTTPStatus
from typing import Any, Final

from fastapi import FastAPI, Request, Response
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from fastapi.routing import APIRoute
from pydantic import BaseModel
from starlette.exceptions import HTTPException
from starlette.requests import HTTPConnection

from esplanade.protocol.commands import CommandFault
from esplanade.server.accounts.identity import AccountError, Identity
from esplanade.server.accounts.lockout import LockedOutError
from esplanade.server.accounts.rights import Right
from esplanade.server.console.console import Console
from esplanade.server.console.gate import Gate, status_of
from esplanade.server.console.refusals import RefusedError
from esplanade.server.console.zone_paths import zone_of
from esplanade.server.store.store import StoreError

PREFIX: Final = "/api/v1"


class Refusal(BaseModel):
    """Nothing was changed, and why."""

    faults: list[CommandFault]


REFUSALS: Final[dict[int | str, dict[str, Any]]] = {
    status: {"model": Refusal, "description": text}
    for status, text in {
        400: "The body cannot be read, or a header that may come once has come more than once.",
        401: "There is no token and no session, or it opens nothing.",
        403: "The right is missing, or the header X-Esplanade, or a page of others asks.",
        404: "There is no such thing.",
        409: "Somebody has changed the same since; both values are told.",
        413: "The body is too long.",
        422: "Something in it cannot be; the path of each fault says where.",
        429: "Too many came in too short a time.",
        503: "Too much waits, or the world is not ready.",
        504: "The world has not answered; it may still do it.",
    }.items()
}


class Guarded(APIRoute):
    """A path whose body is not looked at before it is known who sends it."""

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        handle = super().get_route_handler()

        async def guarded(request: Request) -> Response:
            request.state.identity = await gate_of(request).callers.identity(request)
            return await handle(request)

        return guarded


class Open(APIRoute):
    """A path that changes something and by which strangers come in; pages of others do not."""

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        handle = super().get_route_handler()

        async def opened(request: Request) -> Response:
            request.state.address = gate_of(request).callers.check_stranger(request)
            return await handle(request)

        return opened


def gate_of(request: HTTPConnection) -> Gate:
    """The gate to the zone that a request is about.

    Raises
    ------
    RefusedError
        There is no such zone.
    """
    gate: Gate = request.app.state.gate
    return gate.at(zone_of(request.scope))


def caller(request: Request) -> Identity:
    """The identity of whoever has sent a request to a guarded path."""
    identity: Identity = request.state.identity
    return identity


def may(request: Request, right: Right) -> Identity:
    """The identity of whoever has sent a request, if they have the right that it needs.

    Raises
    ------
    RefusedError
        They have not.
    """
    identity = caller(request)
    if right not in identity.rights:
        text = f"this needs the right {right.value}, which you do not have"
        raise RefusedError.of("forbidden", text, right=right.value)
    return identity


async def asked(
    request: Request, question: Callable[[Console], dict[str, Any]], right: Right = Right.WATCH
) -> dict[str, Any]:
    """The answer to a question about the zone, asked between two ticks; it needs a right.

    Raises
    ------
    RefusedError
        The right is missing, or too much waits.
    """
    may(request, right)

    async def ask(console: Console) -> dict[str, Any]:
        return await console.ask(lambda: question(console))

    return await gate_of(request).call(ask)


def told(refusal: RefusedError) -> dict[str, Any]:
    """A refusal as the body of an answer."""
    return {"faults": [fault.model_dump(mode="json") for fault in refusal.faults]}


def add_refusals(app: FastAPI) -> None:
    """Let an application answer what is refused, in one form."""
    app.add_exception_handler(RefusedError, _refused)
    app.add_exception_handler(AccountError, _of_accounts)
    app.add_exception_handler(LockedOutError, _locked)
    app.add_exception_handler(RequestValidationError, _invalid)
    app.add_exception_handler(StoreError, _no_store)
    app.add_exception_handler(HTTPException, _unread)


def answer_to(refusal: RefusedError) -> JSONResponse:
    """The answer to a request that was refused."""
    status = status_of(refusal)
    headers = {}
    if status == HTTPStatus.UNAUTHORIZED and refusal.faults[0].code == "unauthorized":
        headers["WWW-Authenticate"] = "Bearer"
    if status == HTTPStatus.TOO_MANY_REQUESTS:
        headers["Retry-After"] = str(refusal.faults[0].arguments.get("seconds", 1))
    return JSONResponse(told(refusal), status, headers)


async def _refused(_: Request, error: Exception) -> Response:
    assert isinstance(error, RefusedError)  # noqa: S101 (it is registered for this class)
    return answer_to(error)


async def _of_accounts(_: Request, error: Exception) -> Response:
    assert isinstance(error, AccountError)  # noqa: S101
    return answer_to(RefusedError.of(error.code, str(error), **error.arguments))


async def _locked(_: Request, error: Exception) -> Response:
    assert isinstance(error, LockedOutError)  # noqa: S101
    return answer_to(RefusedError.of("locked", str(error), seconds=error.seconds))


async def _invalid(_: Request, error: Exception) -> Response:
    assert isinstance(error, RequestValidationError)  # noqa: S101
    faults = [
        CommandFault(code="invalid", text=fault["msg"], path=_path(fault["loc"]))
        for fault in error.errors()
    ]
    return JSONResponse(told(RefusedError(faults)), HTTPStatus.UNPROCESSABLE_ENTITY)


def _path(loc: tuple[str | int, ...]) -> list[str | int]:
    """Return the place of a fault, without the words that pydantic adds for kinds it has tried."""
    if loc[:1] != ("body",) or len(loc) < 2:
        return list(loc)
    _, kind, *rest = loc
    if kind == "list":
        return [*rest[:1], *rest[2:]]
    return rest[1:] if kind == "one" else [kind, *rest]


async def _unread(_: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)  # noqa: S101
    refusal = RefusedError.of("invalid", str(error.detail))
    return JSONResponse(told(refusal), error.status_code, error.headers)


async def _no_store(_: Request, error: Exception) -> Response:
    refusal = RefusedError.of("busy", f"the store cannot be used: {error}")
    return JSONResponse(told(refusal), HTTPStatus.SERVICE_UNAVAILABLE)
