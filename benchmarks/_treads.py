"""People and actors on a turned flight of stairs, and whether their feet meet its treads."""

from __future__ import annotations

import asyncio
import json
import math
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, Final

import numpy as np
from benchmarks._slide import FRAMES_PER_SECOND, PHASE
from benchmarks._step_log import Floats, Seen
from benchmarks._turned_scenes import Point, Turn

from esplanade import bots
from esplanade.actors.locomotion.body.sizes import BodySizes
from esplanade.actors.locomotion.reference.posing import pose
from esplanade.server.world.step_records import from_records

STEPS: Final = 10
TREAD_M: Final = 0.3
RISE_M: Final = 0.175
WIDTH_M: Final = 2.4
RUN_M: Final = STEPS * TREAD_M
TOP_M: Final = STEPS * RISE_M
SIDE_M: Final = 16.0
WALKERS: Final = 8
ON_TREAD: Final = 0.85
"""Share of a foot, from the heel, that is to lie on its tread."""
KEY: Final = "let me stand where I wish"
_NEAR_M: Final = 0.1


@dataclass(frozen=True)
class Flight:
    """A flight up to a floor, turned about the middle of its foot."""

    turn: Turn

    @classmethod
    def at_angle(cls, degrees: float) -> Flight:
        """A flight that is turned by some degrees, in the middle of the ground."""
        return cls(Turn(degrees, (0.5 * SIDE_M + 0.07, 0.5 * SIDE_M + 0.04)))

    def write(self, path: Path) -> None:
        """Write the scene, with a place at its foot and one upstairs."""
        turn, half = self.turn, 0.5 * WIDTH_M
        scene = {
            "bounds": (0.0, 0.0, SIDE_M, SIDE_M),
            "stairs": [
                {
                    "start": turn.at(0.0),
                    "end": turn.at(RUN_M),
                    "width_m": WIDTH_M,
                    "top_m": TOP_M,
                    "steps": STEPS,
                }
            ],
            "polygons": [
                {
                    "kind": "floor",
                    "height_m": TOP_M,
                    "points": turn.rectangle(RUN_M, -half - 1.0, RUN_M + 3.0, half + 1.0),
                }
            ],
            "spawns": [{"position": turn.at(-2.0), "radius_m": 1.0}],
            "places": [
                {"name": "foot", "position": turn.at(-2.0)},
                {"name": "head", "position": turn.at(RUN_M + 1.5), "z_m": TOP_M},
            ],
        }
        path.write_text(json.dumps(scene), encoding="utf-8")

    def along(self, points: Floats) -> Floats:
        """The distances of points (..., 2 or 3) from its foot along it, metres."""
        direction = np.subtract(self.turn.at(1.0), self.turn.at(0.0))
        return np.asarray((points[..., :2] - self.turn.at(0.0)) @ direction)

    def beside(self, points: Floats) -> Floats:
        """The distances of points (..., 2 or 3) from its middle line, metres."""
        direction = np.subtract(self.turn.at(0.0, 1.0), self.turn.at(0.0))
        return np.abs((points[..., :2] - self.turn.at(0.0)) @ direction)

    def heights(self, along_m: Floats) -> Floats:
        """The heights of the ground, treads and floor at distances along it, metres."""
        return RISE_M * np.clip(np.floor(along_m / TREAD_M) + 1.0, 0.0, STEPS)


@dataclass(frozen=True)
class Treads:
    """Distances in metres, with one number for each observation."""

    off_tread: Floats
    """Heights of footprints on the flight above or below their treads."""
    hanging: Floats
    """Lengths of the parts of feet that hang over edges or stand in risers, beyond the share that
    may, at their footprints."""
    cut: Floats
    """Depths below the ground of the ends of that share of drawn feet; 0 if they are above."""


def judge_treads(everyone: list[Seen], tick_rate: int, flight: Flight) -> Treads:
    """Compare footprints with treads, and drawn feet with the ground."""
    parts = [_judge(seen, tick_rate, flight) for seen in everyone]
    names = [field.name for field in fields(Treads)]
    return Treads(**{name: np.concatenate([getattr(p, name) for p in parts]) for name in names})


def _judge(seen: Seen, tick_rate: int, flight: Flight) -> Treads:
    steps = from_records(seen.steps)
    foot_m = float(BodySizes(np.array([seen.leg_m]), np.array([seen.stature_m])).foot_m[0])
    landing = steps.landing[steps.ticks > 0]
    ahead = np.stack([np.cos(landing[:, 3]), np.sin(landing[:, 3])], axis=1)
    heel = flight.along(landing)
    toes = landing[:, :2] + ON_TREAD * foot_m * ahead
    toe = flight.along(toes)
    on = (np.minimum(heel, toe) > 0.0) & (np.maximum(heel, toe) < RUN_M)
    on &= np.maximum(flight.beside(landing), flight.beside(toes)) < 0.5 * WIDTH_M
    level = flight.heights(0.5 * (heel + toe)[on])
    begin = TREAD_M * (level / RISE_M - 1.0)
    low, high = np.minimum(heel, toe)[on], np.maximum(heel, toe)[on]
    beyond = np.maximum(begin - low, high - begin - TREAD_M)
    frame = tick_rate / FRAMES_PER_SECOND
    ticks = np.arange(seen.heard[0] + PHASE * frame, seen.until, frame)
    rows = np.maximum(np.searchsorted(steps.start, ticks, side="right") - 1, 0)
    gone = (ticks - steps.start[rows]) / np.maximum(steps.ticks[rows], 1)
    shares = np.where(steps.ticks[rows] > 0, np.clip(gone, 0.0, 1.0), 1.0)
    sizes = BodySizes(np.full(len(rows), seen.leg_m), np.full(len(rows), seen.stature_m))
    drawn = pose(steps.take(rows), shares, sizes)
    balls = drawn.ankles + ON_TREAD * (drawn.toes - drawn.ankles)
    feet = np.concatenate([drawn.ankles, balls], axis=1)
    where = flight.along(feet)
    here = (where > -TREAD_M) & (where < RUN_M + TREAD_M)
    here &= flight.beside(feet) < 0.5 * WIDTH_M
    depths = flight.heights(where[here]) - feet[here][:, 2]
    return Treads(np.abs(landing[on, 2] - level), np.maximum(beyond, 0.0), np.maximum(depths, 0.0))


async def walk_up_and_down(url: str, flight: Flight, stop: asyncio.Event) -> None:
    """People who walk up and down side by side, until they are to stop."""
    async with asyncio.TaskGroup() as people:
        for number in range(WALKERS):
            people.create_task(_walk(url, flight, number, stop))


async def _walk(url: str, flight: Flight, number: int, stop: asyncio.Event) -> None:
    across = 0.8 * (2.0 * number / (WALKERS - 1) - 1.0)
    ends = (-1.0 - 0.1 * number, 0.0), (RUN_M + 0.8 + 0.1 * number, TOP_M)
    places = [(*flight.turn.at(along, across), z) for along, z in ends]
    async with bots.connect(url, at=(*places[0][:2], 0), operator=KEY) as bot:
        towards = 1
        await bot.walk_to(*places[towards])
        async for _ in bot.events():
            if stop.is_set():
                return
            if math.dist(bot.position[:2], places[towards][:2]) < _NEAR_M:
                towards = 1 - towards
                await bot.walk_to(*places[towards])


def onlooker_place(flight: Flight) -> Point:
    """Where to stand and look on: beside the flight."""
    return flight.turn.at(0.5 * RUN_M, 4.0)


def millimetres(treads: Treads) -> dict[str, Any]:
    """Percentiles in millimetres, and the share of heels and toes deeper than 1 cm."""
    found: dict[str, Any] = {}
    for field in fields(Treads):
        values = 1e3 * getattr(treads, field.name)
        found[field.name] = {
            "p50": float(np.percentile(values, 50)),
            "p99": float(np.percentile(values, 99)),
            "worst": float(values.max()),
            "count": len(values),
        }
    found["cut over 1 cm, %"] = 100.0 * float((treads.cut > 0.01).mean())
    return found
