"""Whether the audit is as it was written, over HTTP."""

import asyncio
from typing import Final

from fastapi import APIRouter, Request
from pydantic import BaseModel

from esplanade.server.accounts.rights import Right
from esplanade.server.audit.verifying import verify
from esplanade.server.console.refusals import RefusedError
from esplanade.server.console.routing import PREFIX, REFUSALS, Guarded, gate_of, may

router = APIRouter(prefix=PREFIX, route_class=Guarded, responses=REFUSALS)
_VERIFYING: Final = asyncio.Semaphore(1)


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
