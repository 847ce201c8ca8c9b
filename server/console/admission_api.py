"""Invitations to a closed world, and tokens of bots, over HTTP."""

from http import HTTPStatus
from typing import Annotated

from fastapi import APIRouter, Path, Request
from pydantic import BaseModel, Field

from esplanade.protocol.commands import NO_NUL
from esplanade.server.accounts.bots import LONGEST_US
from esplanade.server.accounts.invitations import MOST_USES
from esplanade.server.accounts.rights import Right
from esplanade.server.accounts.tokens import DAY_US
from esplanade.server.console.auth_api import Body, Word
from esplanade.server.console.routing import PREFIX, REFUSALS, Guarded, gate_of, may

router = APIRouter(prefix=PREFIX, route_class=Guarded, responses=REFUSALS)
HOUR_US = DAY_US // 24
Name = Annotated[str, Path(max_length=64)]


class NewInvitation(Body):
    """An invitation; whoever has its link comes in by it, until it is used up or over."""

    label: Annotated[str, Field(max_length=200, pattern=NO_NUL)] | None = None
    uses: Annotated[int, Field(ge=1, le=MOST_USES)] = 1
    expires_hours: Annotated[int, Field(ge=1, le=LONGEST_US // HOUR_US)] = 24


class InvitationFacts(BaseModel):
    """The facts that are kept of an invitation; its link is not."""

    id: str
    label: str | None
    by: str | None
    uses: int
    used: int
    created_us: int
    expires_us: int
    revoked: bool


class AllInvitations(BaseModel):
    """All invitations, the newest first."""

    invitations: list[InvitationFacts]


class MadeInvitation(BaseModel):
    """The link, which is told this once."""

    id: str
    url: str


class NewBot(Body):
    """A bot that comes in by a token, with a rate of its own."""

    name: Word
    message_rate: Annotated[int, Field(ge=1, le=10_000)] = 60
    connections: Annotated[int, Field(ge=1, le=4000)] = 1
    expires_days: Annotated[int, Field(ge=1, le=LONGEST_US // DAY_US)] = 90


class BotFacts(BaseModel):
    """The facts that are kept of a bot; its token is not."""

    name: str
    by: str | None
    message_rate: int
    connections: int
    created_us: int
    expires_us: int


class AllBots(BaseModel):
    """All bots with a token, by name."""

    bots: list[BotFacts]


class MadeBot(BaseModel):
    """The token, which is told this once."""

    token: str


@router.get("/invitations")
async def invitations(request: Request) -> AllInvitations:
    """All invitations."""
    may(request, Right.MODERATE)
    found = await gate_of(request).kept.invitations.list()
    facts = [
        InvitationFacts(
            id=each.id,
            label=each.label,
            by=each.account,
            uses=each.uses,
            used=each.used,
            created_us=each.created_us,
            expires_us=each.expires_us,
            revoked=each.revoked_us is not None,
        )
        for each in found
    ]
    return AllInvitations(invitations=facts)


@router.post("/invitations", status_code=HTTPStatus.CREATED)
async def invite(request: Request, body: NewInvitation) -> MadeInvitation:
    """Make an invitation."""
    by, gate = may(request, Right.MODERATE), gate_of(request)
    url = gate.people_url(request.headers.get("host", ""))
    id_, secret = await gate.kept.invitations.add(
        by, label=body.label, uses=body.uses, lasts_us=body.expires_hours * HOUR_US
    )
    return MadeInvitation(id=id_, url=f"{url}#invitation={secret}")


@router.delete("/invitations/{invitation}", status_code=HTTPStatus.NO_CONTENT)
async def revoke_invitation(request: Request, invitation: Name) -> None:
    """Let nobody else in by an invitation."""
    by = may(request, Right.MODERATE)
    await gate_of(request).kept.invitations.revoke(by, invitation)


@router.get("/bots")
async def bots(request: Request) -> AllBots:
    """All bots that have a token."""
    may(request, Right.ACCOUNTS)
    found = await gate_of(request).kept.bots.list()
    facts = [
        BotFacts(
            name=each.name,
            by=each.account,
            message_rate=each.message_rate,
            connections=each.connections,
            created_us=each.created_us,
            expires_us=each.expires_us,
        )
        for each in found
    ]
    return AllBots(bots=facts)


@router.post("/bots", status_code=HTTPStatus.CREATED)
async def add_bot(request: Request, body: NewBot) -> MadeBot:
    """Make a token of a bot."""
    by = may(request, Right.ACCOUNTS)
    token = await gate_of(request).kept.bots.add(
        by,
        body.name,
        message_rate=body.message_rate,
        connections=body.connections,
        lasts_us=body.expires_days * DAY_US,
    )
    return MadeBot(token=token)


@router.delete("/bots/{name}", status_code=HTTPStatus.NO_CONTENT)
async def remove_bot(request: Request, name: Name) -> None:
    """Remove a bot: its token opens nothing from now on."""
    by = may(request, Right.ACCOUNTS)
    await gate_of(request).kept.bots.remove(by, name)
