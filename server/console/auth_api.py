"""Logging in and out over HTTP, the first account, another password, and passes to a seat."""

from http import HTTPStatus
from typing import Annotated

from fastapi import APIRouter, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from esplanade.server.accounts.identity import AccountError, Identity
from esplanade.server.accounts.one_time import PASS_US
from esplanade.server.accounts.rights import Right, as_text
from esplanade.server.accounts.sessions import LASTS_US, WrongPasswordError
from esplanade.server.console.callers import COOKIE, session_cookies
from esplanade.server.console.refusals import RefusedError
from esplanade.server.console.routing import (
    PREFIX,
    REFUSALS,
    Guarded,
    Open,
    caller,
    gate_of,
    may,
)

router = APIRouter(prefix=PREFIX, responses=REFUSALS)
strangers = APIRouter(route_class=Open)
guarded = APIRouter(route_class=Guarded)
Word = Annotated[str, Field(max_length=64)]
Password = Annotated[str, Field(max_length=1024)]
"""Longer than any that can be had, so that the refusal is that of a password, in its words."""


class Body(BaseModel):
    """Base of what is sent: nothing unknown, no other type."""

    model_config = ConfigDict(extra="forbid", strict=True)


class LogIn(Body):
    """Name and password of an account."""

    name: Word
    password: Password


class First(LogIn):
    """The first account, with the token of the link in the server's log."""

    token: Word


class OtherPassword(Body):
    """The password until now, and the one from now on."""

    old: Password
    new: Password


class Me(BaseModel):
    """The caller, and the rights of the caller."""

    account: str | None
    role: str
    rights: list[str]
    via: str = Field(description="`session` or `token`.")


class Pass(BaseModel):
    """A link by which an operator walks in; it is good once, and not for long."""

    url: str
    seconds: int


@strangers.post("/login")
async def log_in(request: Request, body: LogIn, response: Response) -> Me:
    """Begin a session; its token is in the cookie `esplanade_session`."""
    address: str = request.state.address
    return await _begin(request, response, body.name, body.password, address)


@strangers.post("/first")
async def first(request: Request, body: First, response: Response) -> Me:
    """Make the first account, an admin, with the token of the link that the server has logged."""
    address: str = request.state.address
    await gate_of(request).kept.one_time.add_first(body.token, body.name, body.password, address)
    return await _begin(request, response, body.name, body.password, address)


@router.get("/me")
async def me(request: Request) -> Me:
    """The caller; without token and session, whether there is an account at all yet."""
    gate = gate_of(request)
    try:
        return _told(await gate.callers.identity(request))
    except RefusedError as error:
        if error.faults[0].code != "unauthorized":
            raise
        text = error.faults[0].text
        is_first = await gate.kept.one_time.is_first()
        raise RefusedError.of("unauthorized", text, first=is_first) from None


@guarded.post("/logout", status_code=HTTPStatus.NO_CONTENT)
async def log_out(request: Request, response: Response) -> None:
    """End the session that asks."""
    identity, gate = _of_session(request), gate_of(request)
    await gate.kept.sessions.log_out(identity, session_cookies(request)[0])
    response.delete_cookie(
        COOKIE, PREFIX, secure=gate.secure_cookies, httponly=True, samesite="strict"
    )


@guarded.post("/password", status_code=HTTPStatus.NO_CONTENT)
async def password(request: Request, body: OtherPassword, response: Response) -> None:
    """Give oneself another password; all other sessions of the account end."""
    identity, gate = _of_session(request), gate_of(request)
    name, address = identity.account or "", identity.address or ""
    try:
        await gate.kept.sessions.confirm(name, body.old, address)
    except WrongPasswordError:
        text = "this is not your password until now"
        raise RefusedError.of("wrong_old_password", text, "old") from None
    await gate.kept.directory.set_password(identity, name, body.new)
    await _begin(request, response, name, body.new, address)


@guarded.post("/passes")
async def passes(request: Request) -> Pass:
    """A link by which the one who asks walks in as a person with an operator's rights."""
    may(request, Right.WATCH)
    gate, identity = gate_of(request), _of_session(request)
    token = await gate.kept.one_time.seat_pass(identity)
    return Pass(
        url=f"{gate.people_url(request.headers.get('host', ''))}#pass={token}",
        seconds=PASS_US // 10**6,
    )


router.include_router(strangers)
router.include_router(guarded)


def _of_session(request: Request) -> Identity:
    """The one who asks, if they have logged in.

    Raises
    ------
    RefusedError
        They have come by a token, which may have fewer rights than its account.
    """
    identity = caller(request)
    if identity.via != "session":
        raise RefusedError.of("session_needed", "only who has logged in may do this")
    return identity


async def _begin(request: Request, response: Response, name: str, given: str, address: str) -> Me:
    gate = gate_of(request)
    token = await gate.kept.sessions.log_in(name, given, address)
    identity = await gate.kept.sessions.identity(token, address)
    if identity is None:
        raise AccountError("the session has ended already")
    response.set_cookie(
        COOKIE,
        token,
        max_age=LASTS_US // 10**6,
        path=PREFIX,
        secure=gate.secure_cookies,
        httponly=True,
        samesite="strict",
    )
    response.headers["Cache-Control"] = "no-store"
    return _told(identity)


def _told(identity: Identity) -> Me:
    return Me(
        account=identity.account,
        role=identity.role,
        rights=as_text(identity.rights).split(),
        via=identity.via.partition(" ")[0],
    )
