"""The zones of a world, for operators who go from one to another."""

from fastapi import APIRouter, Request
from pydantic import BaseModel

from esplanade.server.accounts.rights import Right
from esplanade.server.console.console import Console
from esplanade.server.console.gate import ZoneFacts
from esplanade.server.console.routing import PREFIX, REFUSALS, Guarded, gate_of, may

router = APIRouter(prefix=PREFIX, route_class=Guarded, responses=REFUSALS)


class Zones(BaseModel):
    """The zones of the world, and the one that the path is about."""

    here: str
    zones: list[ZoneFacts]
    """That which newcomers enter is the first."""


@router.get("/zones")
async def zones(request: Request) -> Zones:
    """All zones of the world, with the people and actors in each at this moment."""
    identity = may(request, Right.WATCH)
    gate = gate_of(request)
    if gate.elsewhere is not None:
        return Zones(here=gate.name, zones=await gate.elsewhere(identity))

    async def count(_: Console) -> list[ZoneFacts]:
        found = []
        for name, operated in gate.at(None).zones.items():
            world = operated.console.zone
            people, actors = world.count()
            found.append(ZoneFacts(name=name, scene=world.scene.name, people=people, actors=actors))
        return found

    return Zones(here=gate.name, zones=await gate.call(count))
