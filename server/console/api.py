"""The HTTP interface for operators: what is asked with GET, and commands."""

from collections.abc import Sequence
from http import HTTPStatus
from typing import Annotated, Any, Final

from fastapi import APIRouter, FastAPI, Request
from fastapi.responses import JSONResponse
from pydantic import Discriminator, Tag
from starlette.routing import Match

from esplanade.protocol.commands import Answer, Command, Commands, full_id
from esplanade.server.accounts.rights import Right
from esplanade.server.console import questions
from esplanade.server.console.accounts_api import router as accounts
from esplanade.server.console.admission_api import router as admission
from esplanade.server.console.audit_api import router as audits
from esplanade.server.console.auth_api import router as auth
from esplanade.server.console.gate import Gate
from esplanade.server.console.live_api import router as live
from esplanade.server.console.live_socket import router as sockets
from esplanade.server.console.moderation_api import router as people
from esplanade.server.console.operated_api import router as kept
from esplanade.server.console.refusals import RefusedError
from esplanade.server.console.routing import (
    PREFIX,
    REFUSALS,
    Guarded,
    add_refusals,
    asked,
    caller,
    gate_of,
    may,
    told,
)
from esplanade.server.console.trace_api import router as traces
from esplanade.server.console.zones_api import router as zones
from esplanade.server.live.names import stand_in


def _one_or_list(body: object) -> str:
    return "list" if isinstance(body, list) else "one"


OneOrList = Annotated[
    Annotated[Command, Tag("one")] | Annotated[Commands, Tag("list")], Discriminator(_one_or_list)
]


router = APIRouter(prefix=PREFIX, route_class=Guarded, responses=REFUSALS)


# Paths of the live views below an actor's go before the actor's own.
OF_ZONE: Final = (live, traces, sockets, zones, router, kept, people)
"""The paths about one zone."""
OF_WORLD: Final = (auth, accounts, admission, audits)
"""The paths about accounts, who may come in, and the audit: they need no zone that runs."""


def add_api(app: FastAPI, gate: Gate, routers: Sequence[APIRouter] = (*OF_ZONE, *OF_WORLD)) -> None:
    """Let an application answer operators."""
    app.state.gate = gate
    for each in routers:
        app.include_router(each)
    add_refusals(app)


def is_about_zone(path: str) -> bool:
    """Whether a path of the interface is about one zone, if none of a zone's name stands in it.

    The list of all zones is about none.
    """
    scope = {"type": "http", "method": "GET", "path": path, "root_path": "", "headers": []}
    routes = [route for each in (*OF_WORLD, zones) for route in each.routes]
    return path.startswith(f"{PREFIX}/") and all(
        route.matches(scope)[0] is Match.NONE for route in routes
    )


@router.get("/schema")
async def schema(request: Request) -> dict[str, Any]:
    """The schemas of parameters, behaviours and commands, for forms."""
    may(request, Right.WATCH)
    return questions.schema()


@router.get("/world")
async def world(request: Request) -> dict[str, Any]:
    """The zone at this moment."""
    return await asked(request, questions.world)


@router.get("/actors")
async def actors(request: Request) -> dict[str, Any]:
    """All actors at this moment."""
    return await asked(request, questions.actors)


@router.get("/actors/{actor_id:path}")
async def actor(request: Request, actor_id: str) -> dict[str, Any]:
    """One actor: what it does, what holds it, its parameters and where each comes from."""
    try:
        return await asked(request, lambda console: questions.actor(console, _id(actor_id)))
    except RefusedError as error:
        if error.faults[0].code != "unknown_actor":
            raise
        return JSONResponse(told(error), HTTPStatus.NOT_FOUND)  # type: ignore[return-value]


@router.get("/people")
async def everyone(request: Request) -> dict[str, Any]:
    """Everyone who is connected, at this moment."""
    found = await asked(request, questions.people)
    views = gate_of(request).live
    if views is not None and not views.sees_names(caller(request)):
        found["people"] = [{**one, "name": stand_in(one["id"])} for one in found["people"]]
    return found


@router.get("/parameters")
async def parameters(request: Request) -> dict[str, Any]:
    """All values that are set, by scope, and the usual ones."""
    return await asked(request, questions.parameters)


@router.post("/commands")
async def commands(request: Request, body: OneOrList) -> Answer | list[Answer]:
    """Carry out a command, or a list of them in one tick: all of it, or nothing."""
    identity = caller(request)
    given: Sequence[Command] = body if isinstance(body, list) else [body]
    gate_of(request).brakes.take(identity, given)
    try:
        answers = await gate_of(request).call(lambda console: console.carry_out(identity, given))
    except RefusedError as error:
        raise error if isinstance(body, list) else _of_the_one(error) from None
    return answers if isinstance(body, list) else answers[0]


def _id(text: str) -> str:
    return str(full_id(text))


def _of_the_one(error: RefusedError) -> RefusedError:
    """The refusal of a command that was sent alone: paths do not begin with its place."""
    return RefusedError(
        [
            fault.model_copy(update={"path": fault.path[1:]}) if fault.path[:1] == [0] else fault
            for fault in error.faults
        ]
    )
