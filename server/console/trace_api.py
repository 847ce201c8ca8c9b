"""The question of operators how an actor has just decided."""

import asyncio
import json
from collections import OrderedDict
from time import monotonic
from typing import Any, Final

from fastapi import APIRouter, Request, Response
from fastapi.responses import JSONResponse

from esplanade.protocol.commands import full_id
from esplanade.server.accounts.identity import Identity
from esplanade.server.console.brakes import REMEMBERED, Window
from esplanade.server.console.live_api import avatar_of, live_of, unknown_actor
from esplanade.server.console.refusals import RefusedError
from esplanade.server.console.routing import PREFIX, REFUSALS, Guarded, caller, told
from esplanade.server.live.live import Live
from esplanade.server.live.told_traces import told_trace
from esplanade.server.live.traces import TooManyError

A_SECOND: Final = 2
"""Traces that an account may ask for in a second."""
WAIT_S: Final = 3.0
"""A world that has no time for a trace in so long is too busy for it."""

router = APIRouter(prefix=PREFIX, route_class=Guarded, responses=REFUSALS)


class TraceBrakes:
    """Counts the traces that each account asks for."""

    def __init__(self) -> None:
        self._accounts: OrderedDict[tuple[str | None, str], Window] = OrderedDict()

    def take(self, by: Identity) -> None:
        """Count a trace that is about to be asked for.

        Raises
        ------
        RefusedError
            It comes too soon; it is not counted.
        """
        now_s, who = monotonic(), (by.account, by.via)
        window = self._accounts.setdefault(who, Window(A_SECOND, 1.0))
        self._accounts.move_to_end(who)
        if len(self._accounts) > REMEMBERED:
            self._accounts.popitem(last=False)
        if window.wait_s(now_s) > 0.0:
            text = f"{A_SECOND} traces a second are possible; try again in 1 s"
            raise RefusedError.of("too_many", text, seconds=1)
        window.take(now_s)


@router.get("/actors/{actor_id:path}/trace")
async def trace(request: Request, actor_id: str) -> Response:
    """The last decision of an actor, made once more: its search, its paths and what they cost."""
    live, actor = live_of(request), str(full_id(actor_id))
    avatar = await avatar_of(live, actor)
    if avatar is None:
        return JSONResponse(told(unknown_actor(actor)), 404)
    _brakes_of(request).take(caller(request))
    body = await _traced(live, actor, avatar, names=live.sees_names(caller(request)))
    return Response(json.dumps(body), media_type="application/json")


async def _traced(live: Live, actor: str, avatar: int, *, names: bool) -> dict[str, Any]:
    try:
        answer = live.tap.traces.ask(avatar)
    except TooManyError:
        raise RefusedError.of("busy", "too many traces wait for their turn") from None
    try:
        traced = await asyncio.wait_for(asyncio.wrap_future(answer), WAIT_S)
    except TimeoutError:
        text = f"the world has had no time for a trace in {WAIT_S:g} s"
        raise RefusedError.of("busy", text) from None
    if traced is None:
        text = (
            "nothing is known of the last decision: actors came or went since, or the world was "
            "paused before anybody looked; let it take a step"
        )
        raise RefusedError.of("not_kept", text, actor=actor)
    blocker = live.reasons.told_blocker(traced.blocker, names=names)
    return {**told_trace(actor, traced, live.zone.slice_s), "blocker": blocker}


def _brakes_of(request: Request) -> TraceBrakes:
    state = request.app.state
    if not hasattr(state, "trace_brakes"):
        state.trace_brakes = TraceBrakes()
    brakes: TraceBrakes = state.trace_brakes
    return brakes
