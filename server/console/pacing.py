"""Carries out what operators want of the pace of a world."""

from collections.abc import Mapping
from typing import Any

import structlog

from esplanade.server.console.state import FACTOR, PAUSED, STEPPED
from esplanade.server.world.pace import Pace

log = structlog.get_logger(__name__)


def change_pace(pace: Pace, facts: Mapping[str, Any], now: float) -> None:
    """Make these facts about the pace true; call it between two ticks, or while one is planned."""
    if not facts:
        return
    if FACTOR in facts or PAUSED in facts:
        pace.change(now, factor=facts.get(FACTOR), paused=facts.get(PAUSED))
        log.info("pace", factor=pace.state.factor, paused=pace.state.paused)
    if STEPPED in facts:
        pace.step(facts[STEPPED])


def told(pace: Pace) -> dict[str, Any]:
    """The pace for programs. What is wanted is not `reached` where the machine is too slow."""
    state = pace.state
    return {
        "factor": state.factor,
        "paused": state.paused,
        "rate": round(state.rate, 3),
        "reached": state.reached,
        "steps": pace.steps,
    }
