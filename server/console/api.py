"""The HTTP interface for operators: what is asked with GET, and commands."""

from collections.abc import Callable, Coroutine, Sequence
from http import HTTPStatus
from typing import Annotated, Any, Final

from fastapi import APIRouter, FastAPI, Query, Request, Response
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from fastapi.routing import APIRoute
from pydantic import BaseModel, Discriminator, Tag
from starlette.exceptions import HTTPException

from esplanade.protocol.commands import NO_NUL, Answer, Command, CommandFault, Commands, full_id
from esplanade.server.accounts.identity import Identity
from esplanade.server.accounts.rights import Right
from esplanade.server.audit.log import MOST_ROWS, Filter
from esplanade.server.console import questions
from esplanade.server.console.console import Console
from esplanade.server.console.gate import Gate, status_of
from esplanade.server.console.people_api import people_router
from esplanade.server.console.refusals import RefusedError
from esplanade.server.store.store import StoreError

PREFIX: Final = "/api/v1"


def _one_or_list(body: object) -> str:
    return "list" if isinstance(body, list) else "one"


OneOrList = Annotated[
    Annotated[Command, Tag("one")] | Annotated[Commands, Tag("list")], Discriminator(_one_or_list)
]


Moment = Annotated[int | None, Query(ge=0, lt=2**62, description="Microseconds since 1970.")]
Word = Annotated[str | None, Query(max_length=200, pattern=NO_NUL)]


class Refusal(BaseModel):
    """Nothing was changed, and why."""

    faults: list[CommandFault]


_REFUSALS: Final[dict[int | str, dict[str, Any]]] = {
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


class _Guarded(APIRoute):
    """A path whose body is not looked at before it is known who sends it."""

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        handle = super().get_route_handler()

        async def guarded(request: Request) -> Response:
            request.state.identity = await _gate(request).identity(request)
            return await handle(request)

        return guarded


router = APIRouter(prefix=PREFIX, route_class=_Guarded, responses=_REFUSALS)


def add_api(app: FastAPI, gate: Gate) -> None:
    """Let an application answer operators."""
    app.state.gate = gate
    app.include_router(router)
    app.include_router(
        people_router(APIRouter(prefix=PREFIX, route_class=_Guarded, responses=_REFUSALS))
    )
    app.add_exception_handler(RefusedError, _refused)
    app.add_exception_handler(RequestValidationError, _invalid)
    app.add_exception_handler(StoreError, _no_store)
    app.add_exception_handler(HTTPException, _unread)


@router.get("/schema")
async def schema(request: Request) -> dict[str, Any]:
    """The schemas of parameters, behaviours and commands, for forms."""
    _may_watch(request)
    return questions.schema()


@router.get("/world")
async def world(request: Request) -> dict[str, Any]:
    """The zone at this moment."""
    return await _asked(request, questions.world)


@router.get("/actors")
async def actors(request: Request) -> dict[str, Any]:
    """All actors at this moment."""
    return await _asked(request, questions.actors)


@router.get("/actors/{actor_id:path}")
async def actor(request: Request, actor_id: str) -> dict[str, Any]:
    """One actor: what it does, what holds it, its parameters and where each comes from."""
    try:
        return await _asked(request, lambda console: questions.actor(console, _id(actor_id)))
    except RefusedError as error:
        if error.faults[0].code != "unknown_actor":
            raise
        return JSONResponse(_told(error), HTTPStatus.NOT_FOUND)  # type: ignore[return-value]


@router.get("/people")
async def people(request: Request) -> dict[str, Any]:
    """Everyone who is connected, at this moment."""
    return await _asked(request, questions.people)


@router.get("/parameters")
async def parameters(request: Request) -> dict[str, Any]:
    """All values that are set, by scope, and the usual ones."""
    return await _asked(request, questions.parameters)


@router.post("/commands")
async def commands(request: Request, body: OneOrList) -> Answer | list[Answer]:
    """Carry out a command, or a list of them in one tick: all of it, or nothing."""
    identity: Identity = request.state.identity
    given: Sequence[Command] = body if isinstance(body, list) else [body]
    try:
        answers = await _gate(request).call(lambda console: console.carry_out(identity, given))
    except RefusedError as error:
        raise error if isinstance(body, list) else _of_the_one(error) from None
    return answers if isinstance(body, list) else answers[0]


@router.get("/audit")
async def audit(
    request: Request,
    since_us: Moment = None,
    until_us: Moment = None,
    account: Word = None,
    command: Word = None,
    target: Word = None,
    after: Annotated[
        str | None, Query(pattern=r"^\d{1,18}-\d{1,18}$", description="`next` of the page before.")
    ] = None,
    limit: Annotated[int, Query(ge=1, le=MOST_ROWS)] = 100,
) -> dict[str, Any]:
    """A page of the audit, the newest row first."""
    _may(request, Right.AUDIT)
    wanted = Filter(
        since_us=since_us, until_us=until_us, account=account, command=command, target=target
    )
    cursor = None
    if after is not None:
        at_us, _, row = after.partition("-")
        cursor = int(at_us), int(row)
    page = await _gate(request).audit.page(wanted, after=cursor, limit=limit)
    rows = [{name: getattr(row, name) for name in _SHOWN} for row in page.rows]
    return {"rows": rows, "next": None if page.next is None else f"{page.next[0]}-{page.next[1]}"}


_SHOWN: Final = (
    *("id", "writer", "seq", "at_us", "tick", "command", "account", "role", "address", "target"),
    *("outcome", "refers_to", "body", "person", "note", "detail", "hash"),
)


def _gate(request: Request) -> Gate:
    gate: Gate = request.app.state.gate
    return gate


def _may(request: Request, right: Right) -> None:
    identity: Identity = request.state.identity
    if right not in identity.rights:
        text = f"this needs the right {right.value}, which you do not have"
        raise RefusedError.of("forbidden", text, right=right.value)


def _may_watch(request: Request) -> None:
    _may(request, Right.WATCH)


async def _asked(request: Request, question: Callable[[Console], dict[str, Any]]) -> dict[str, Any]:
    """The answer to a question about the zone, asked between two ticks."""
    _may_watch(request)

    async def ask(console: Console) -> dict[str, Any]:
        return await console.ask(lambda: question(console))

    return await _gate(request).call(ask)


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


def _told(refusal: RefusedError) -> dict[str, Any]:
    return {"faults": [fault.model_dump(mode="json") for fault in refusal.faults]}


async def _refused(_: Request, error: Exception) -> Response:
    assert isinstance(error, RefusedError)  # noqa: S101 (it is registered for this class)
    status = status_of(error)
    headers = {"WWW-Authenticate": "Bearer"} if status == HTTPStatus.UNAUTHORIZED else None
    return JSONResponse(_told(error), status, headers)


async def _invalid(_: Request, error: Exception) -> Response:
    assert isinstance(error, RequestValidationError)  # noqa: S101
    faults = [
        CommandFault(code="invalid", text=fault["msg"], path=_path(fault["loc"]))
        for fault in error.errors()
    ]
    return JSONResponse(_told(RefusedError(faults)), HTTPStatus.UNPROCESSABLE_ENTITY)


def _path(loc: Sequence[str | int]) -> list[str | int]:
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
    return JSONResponse(_told(refusal), error.status_code, error.headers)


async def _no_store(_: Request, error: Exception) -> Response:
    refusal = RefusedError.of("busy", f"the store cannot be used: {error}")
    return JSONResponse(_told(refusal), HTTPStatus.SERVICE_UNAVAILABLE)
