"""HTTP paths about what operators have made: presets, groups, schedules, the history of changes."""

from typing import Annotated, Any

from fastapi import APIRouter, Path, Query, Request

from esplanade.protocol.commands import NO_NUL
from esplanade.protocol.commands.presets import PRESET
from esplanade.server.console import history
from esplanade.server.console.console import Console
from esplanade.server.console.routing import PREFIX, REFUSALS, Guarded, asked

router = APIRouter(prefix=PREFIX, route_class=Guarded, responses=REFUSALS)


@router.get("/presets")
async def presets(request: Request) -> dict[str, Any]:
    """All presets, those that came along with the server and those that were saved."""
    return dict(await asked(request, _presets))


@router.get("/presets/{name}")
async def preset(
    request: Request,
    name: Annotated[str, Path(pattern=f"^{PRESET}$")],
    version: Annotated[int | None, Query(ge=1, lt=2**31)] = None,
) -> dict[str, Any]:
    """A preset: the version that holds, or another."""
    return dict(await asked(request, lambda c: _plain(c.state.presets.found(name, version))))


@router.get("/groups")
async def groups(request: Request) -> dict[str, Any]:
    """The groups that have a purpose, and those by tags, with their actors."""
    return dict(await asked(request, _groups))


@router.get("/schedules")
async def schedules(request: Request) -> dict[str, Any]:
    """The schedules, the guards, and the figures that conditions may name."""
    return dict(await asked(request, _schedules))


@router.get("/changes")
async def changes(
    request: Request,
    after: Annotated[
        int | None, Query(ge=1, lt=2**62, description="`next` of the page before.")
    ] = None,
    limit: Annotated[int, Query(ge=1, le=history.MOST_CHANGES)] = 50,
) -> dict[str, Any]:
    """The changes that are remembered, the newest first."""
    return dict(await asked(request, lambda c: history.changes(c, after, limit)))


@router.get("/diff")
async def diff(
    request: Request,
    columns: Annotated[
        str,
        Query(
            max_length=800,
            pattern=NO_NUL,
            description="Up to eight, separated by commas: `default`, `preset:NAME`, "
            "`preset:NAME@VERSION`, `world`, `group:NAME`, `actor:ID`, each of the last three "
            "also as it was right after a change, `world@12`; or `change:12`, the scope of a "
            "change right after it.",
        ),
    ] = "default,world",
) -> dict[str, Any]:
    """All parameters in columns side by side."""
    wanted = [column.strip() for column in columns.split(",")]
    return dict(await asked(request, lambda c: history.diff(c, wanted)))


def _presets(console: Console) -> dict[str, Any]:
    return {"presets": [preset.plain() for preset in console.state.presets.all()]}


def _plain(preset: Any) -> dict[str, Any]:
    return dict(preset.plain())


def _groups(console: Console) -> dict[str, Any]:
    tags: dict[str, list[str]] = {}
    for spec in console.zone.actors.values():
        for tag in spec.tags:
            tags.setdefault(tag, []).append(spec.id)
    found: list[dict[str, Any]] = [
        {"group": group, "purpose": group.partition(":")[0], "actors": actors}
        for group, actors in sorted(console.state.groups.members().items())
    ]
    found += [
        {"group": tag, "purpose": None, "actors": actors} for tag, actors in sorted(tags.items())
    ]
    return {"groups": found}


def _schedules(console: Console) -> dict[str, Any]:
    return {
        "tick": console.zone.tick,
        "schedules": [
            {name: value for name, value in each.plain().items() if name != "rights"}
            for each in console.state.schedules
        ],
        "guards": [
            {name: value for name, value in each.plain().items() if name != "rights"}
            for each in console.scheduler.guards
        ],
        "figures": [figure.plain() for figure in console.figures],
    }
