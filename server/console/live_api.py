"""Questions of operators about what was just seen: the map, series, events, heat, and why."""

import asyncio
import json
import time
from http import HTTPStatus
from typing import Annotated, Any, Final, Literal

from fastapi import APIRouter, Query, Request, Response

from esplanade.protocol.commands import NO_NUL, full_id
from esplanade.server.accounts.rights import Right
from esplanade.server.console.refusals import RefusedError
from esplanade.server.console.routing import PREFIX, REFUSALS, Guarded, caller, gate_of, may, told
from esplanade.server.live.live import Live

MOST_STEPS: Final = 10_200
"""Steps of one answer about series."""
MOST_NAMES: Final = 40
WAIT_S: Final = 3.0
"""A tick that has begun is waited for no longer."""
_LOOK_S: Final = 0.03
"""Whether it has come is looked so often."""
_AT_A_TIME: Final = 8
"""Parts of a heat map that are summed up before others have a turn."""

router = APIRouter(prefix=PREFIX, route_class=Guarded, responses=REFUSALS)

Moment = Annotated[int | None, Query(ge=0, lt=2**62, description="Microseconds since 1970.")]
Words = Annotated[str, Query(max_length=2000, pattern=NO_NUL, description="Separated by commas.")]
Word = Annotated[str | None, Query(max_length=200, pattern=NO_NUL)]


@router.get("/map")
async def ground(request: Request) -> dict[str, Any]:
    """The plan of the scene, storey by storey, with the doors as they are."""
    live = live_of(request)

    async def doors(console: Any) -> dict[str, bool]:
        states: dict[str, bool] = console.zone.doors.states()
        return states

    states = await gate_of(request).call(doors)
    plan = live.plan()
    return {**plan, "doors": [{**door, "open": states[door["name"]]} for door in plan["doors"]]}


@router.get("/series/names")
async def series_names(request: Request) -> dict[str, Any]:
    """All figures that are kept over time."""
    return {"series": live_of(request).series.names()}


@router.get("/series")
async def series(
    request: Request,
    names: Words = "",
    actor: Word = None,
    from_us: Moment = None,
    to_us: Moment = None,
    step_s: Literal["1", "10", "60"] = "1",
) -> Response:
    """Values of figures over time, or of one actor, with a mark for each change of operators."""
    live, step = live_of(request), int(step_s)
    last = time.time_ns() // 1000 if to_us is None else to_us
    first = max(last - MOST_STEPS * step * 1_000_000, 0 if from_us is None else from_us)
    values: dict[str, Any] = {}
    if actor is not None:
        avatar = await avatar_of(live, str(full_id(actor)))
        if avatar is None:
            raise unknown_actor(str(full_id(actor)))
        step = 1
        times, values = live.history.told(avatar, first, last)
    else:
        times = []
        for name in _named(live, names):
            times, found = live.series.told([name], first, last, step)
            values |= found
            await asyncio.sleep(0)  # the thread that ticks has a turn
    marks = [mark for mark in live.marks if first <= mark["at_us"] <= last]
    parts = []
    for name, column in values.items():
        parts.append(f"{json.dumps(name)}:{json.dumps(column)}")
        await asyncio.sleep(0)
    head = json.dumps({"step_s": step, "at_us": times, "marks": marks})
    return _json(head[:-1] + ',"values":{' + ",".join(parts) + "}}")


@router.get("/events")
async def events(
    request: Request,
    kind: Words = "",
    who: Word = None,
    from_us: Moment = None,
    limit: Annotated[int, Query(ge=1, le=1000)] = 100,
) -> dict[str, Any]:
    """The latest events, the newest first."""
    live = live_of(request)
    names = live.sees_names(caller(request))
    kinds = [each for each in kind.split(",") if each]
    found = live.events.found(kinds, who, from_us or 0, limit)
    return {"events": [event.told(names=names) for event in found]}


@router.get("/heat")
async def heat(
    request: Request,
    kind: Literal["density", "speed", "waiting", "contacts", "risk"] = "density",
    window_s: Literal["60", "600", "3600"] = "60",
) -> Response:
    """A heat map in cells of half a metre for each storey, over the last time."""
    found = None
    for count, found in enumerate(live_of(request).heat.told(kind, int(window_s))):
        if found is None and count % _AT_A_TIME == 0:
            await asyncio.sleep(0)
    return _json(json.dumps(found))


@router.get("/actors/{actor_id:path}/why")
async def why(request: Request, actor_id: str, from_us: Moment = None) -> Response:
    """The reasons of an actor over the last ten minutes, and who or what held it.

    The minutes are those of the world, in which a pause takes no time; `moments` are ticks with
    the times at which they were, between which time passed evenly.
    """
    live, actor = live_of(request), str(full_id(actor_id))
    avatar = await avatar_of(live, actor)
    if avatar is None:
        return _json(unknown_actor(actor), HTTPStatus.NOT_FOUND)
    names = live.sees_names(caller(request))
    from_tick = 0 if from_us is None else live.moments.tick_at(from_us)
    spans = live.reasons.told(avatar, from_tick, names=names)
    found = {
        "actor": actor,
        "tick": live.map.tick,
        "tick_s": live.zone.tick_s,
        "spans": spans,
        "moments": live.moments.told(spans[0]["from_tick"] if spans else live.map.tick),
    }
    return _json(json.dumps(found))


async def avatar_of(live: Live, actor: str) -> int | None:
    """The avatar of an actor; None if there was none in the tick that had begun at the question.

    That tick is waited for: it reaches the map with a beat.

    Raises
    ------
    RefusedError
        No tick has come.
    """
    tick, until_s = max(1, live.zone.tick), time.monotonic() + WAIT_S
    while (avatar := live.map.avatar_of(actor)) is None and live.map.tick < tick:
        if time.monotonic() > until_s:
            raise RefusedError.of("busy", f"the world has run no tick in {WAIT_S:g} s")
        await asyncio.sleep(_LOOK_S)
    return avatar


def live_of(request: Request) -> Live:
    """The live views of the world, for whoever may watch.

    Raises
    ------
    RefusedError
        The right is missing, or there is no world yet.
    """
    may(request, Right.WATCH)
    live = gate_of(request).live
    if live is None:
        raise RefusedError.of("busy", "the world is not ready")
    return live


def _named(live: Live, names: str) -> list[str]:
    wanted = [each for each in names.split(",") if each] or list(live.series.figures)
    unknown = [each for each in wanted if each not in live.series.figures]
    if unknown:
        text = f"there is no figure {unknown[0]!r}"
        raise RefusedError.of("unknown_figure", text, "query", "names", figure=unknown[0])
    if len(wanted) > MOST_NAMES:
        raise RefusedError.of("too_long", f"give {MOST_NAMES} names at most", "query", "names")
    return wanted


def unknown_actor(actor: str) -> RefusedError:
    return RefusedError.of("unknown_actor", f"there is no actor {actor}", actor=actor)


def _json(body: str | RefusedError, status: int = HTTPStatus.OK) -> Response:
    if isinstance(body, RefusedError):
        body = json.dumps(told(body))
    return Response(body, status, media_type="application/json")
