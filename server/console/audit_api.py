"""The audit over HTTP: its rows page by page, and whether it is as it was written."""

import asyncio
from typing import Annotated, Any, Final

from fastapi import APIRouter, Query, Request
from pydantic import BaseModel

from esplanade.protocol.commands import NO_NUL
from esplanade.server.accounts.rights import Right
from esplanade.server.audit.log import MOST_ROWS, Filter
from esplanade.server.audit.verifying import verify
from esplanade.server.console.refusals import RefusedError
from esplanade.server.console.routing import PREFIX, REFUSALS, Guarded, gate_of, may

router = APIRouter(prefix=PREFIX, route_class=Guarded, responses=REFUSALS)
_VERIFYING: Final = asyncio.Semaphore(1)

Moment = Annotated[int | None, Query(ge=0, lt=2**62, description="Microseconds since 1970.")]
Word = Annotated[str | None, Query(max_length=200, pattern=NO_NUL)]


class ChainFacts(BaseModel):
    """The chain of one writer."""

    writer: str
    rows: int
    forgotten: int
    hash: str


class ChainFault(BaseModel):
    """The first row of a chain that is not as it was written."""

    writer: str
    seq: int
    text: str


class Verified(BaseModel):
    """The faults in the chains of all writers; with none all of it is as it was written."""

    chains: list[ChainFacts]
    faults: list[ChainFault]


@router.get("/audit/verify")
async def verified(request: Request) -> Verified:
    """Follow the chains of the audit from the first row; one at a time."""
    may(request, Right.AUDIT)
    if _VERIFYING.locked():
        raise RefusedError.of("busy", "the audit is being verified already")
    async with _VERIFYING:
        chains = await verify(gate_of(request).kept.store)
    return Verified(
        chains=[
            ChainFacts(writer=each.writer, rows=each.rows, forgotten=each.forgotten, hash=each.head)
            for each in chains
        ],
        faults=[
            ChainFault(writer=each.writer, seq=each.fault.seq, text=str(each.fault))
            for each in chains
            if each.fault is not None
        ],
    )


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
    may(request, Right.AUDIT)
    wanted = Filter(
        since_us=since_us, until_us=until_us, account=account, command=command, target=target
    )
    cursor = None
    if after is not None:
        at_us, _, row = after.partition("-")
        cursor = int(at_us), int(row)
    page = await gate_of(request).audit.page(wanted, after=cursor, limit=limit)
    rows = [{name: getattr(row, name) for name in _SHOWN} for row in page.rows]
    return {"rows": rows, "next": None if page.next is None else f"{page.next[0]}-{page.next[1]}"}


_SHOWN: Final = (
    *("id", "writer", "seq", "at_us", "tick", "command", "account", "role", "address", "target"),
    *("outcome", "refers_to", "body", "person", "note", "detail", "hash"),
)
