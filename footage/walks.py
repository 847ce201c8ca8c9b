"""The walks that are filmed: the places of a body at every tick, in a scene of its own."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from esplanade.planning import Polygon, Scene, Stairs
from esplanade.planning.compiled.arrays import Floats

TICK_S: Final = 0.05
"""Duration of a tick, as the server has it."""
_RISE_M: Final = 0.17
_TREAD_M: Final = 0.29
_TREADS: Final = 6
_FLIGHT_FROM_M: Final = 1.6
"""Distance from the beginning of the walk to that of the stairs."""
_LANDING_M: Final = 1.3


@dataclass(frozen=True)
class Walk:
    """The path of one body."""

    name: str
    caption: str
    scene: Scene
    places: Floats
    """(T, 2), metres: its places at the ticks."""
    headings: Floats
    """(T,), radians: the headings that it has while it stands."""
    planned: bool
    """Whether its path is known ahead, as an actor's is; else it is guessed from its velocity."""
    view: tuple[float, float]
    """Azimuth and elevation of the camera, degrees."""
    spans_s: tuple[tuple[float, float], ...]
    """Spans of time that strips show, seconds; each has a row."""


def walks() -> dict[str, Walk]:
    """All walks by name."""
    return {walk.name: walk for walk in (_flat(), _run(), _curve(), _stairs(), _start_stop())}


def _flat() -> Walk:
    places = _along(np.array([[0.0, 0.0], [5.6, 0.0]]), 1.3)
    return _walk(
        "flat",
        "level ground, 1.3 m/s",
        _ground(),
        _with_rests(places),
        view=(-78.0, 9.0),
        spans_s=((0.4, 1.6), (2.2, 3.4), (4.2, 5.4)),
    )


def _run() -> Walk:
    places = _along(np.array([[0.0, 0.0], [9.0, 0.0]]), 2.6, ramp_s=1.0)
    return _walk(
        "run",
        "from standing to a run at 2.6 m/s and back",
        _ground(),
        _with_rests(places),
        view=(-78.0, 9.0),
        spans_s=((0.4, 1.6), (2.0, 3.2), (3.8, 5.0)),
    )


def _curve() -> Walk:
    turn = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 60)
    first = np.stack([1.2 + 1.3 * np.cos(turn), 1.3 + 1.3 * np.sin(turn)], axis=1)
    second = np.stack([1.2 - 1.0 * np.cos(turn), 3.6 + 1.0 * np.sin(turn)], axis=1)
    line = np.concatenate(([[-0.6, 0.0]], first, second, [[3.2, 4.6]]))
    places = _with_rests(_along(line, 1.1))
    return _walk(
        "curve",
        "bends of 1.3 m and 1.0 m, 1.1 m/s",
        _ground(),
        places,
        view=(-62.0, 34.0),
        spans_s=((3.0, 5.0), (7.0, 9.0)),
    )


def _stairs() -> Walk:
    run, top = _TREADS * _TREAD_M, _TREADS * _RISE_M
    head = _FLIGHT_FROM_M + run
    far = head + _LANDING_M
    flights = [
        Stairs(start=(start, 0.0), end=(end, 0.0), width_m=1.2, top_m=top, steps=_TREADS)
        for start, end in ((_FLIGHT_FROM_M, head), (far + run, far))
    ]
    landing = Polygon(
        points=((head, -0.6), (far, -0.6), (far, 0.6), (head, 0.6)), height_m=top, kind="floor"
    )
    scene = _ground(stairs=tuple(flights), polygons=(landing,))
    places = _along(np.array([[0.0, 0.0], [far + run + _FLIGHT_FROM_M, 0.0]]), 0.75)
    caption = f"{_TREADS} steps of {_RISE_M * 100:.0f} cm up and down, 0.75 m/s"
    return _walk(
        "stairs",
        caption,
        scene,
        _with_rests(places),
        view=(-76.0, 14.0),
        spans_s=((2.4, 5.6), (6.8, 10.0)),
    )


def _start_stop() -> Walk:
    go = _along(np.array([[0.0, 0.0], [2.3, 0.0]]), 1.4, ramp_s=0.15)
    aside = _along(np.array([[2.3, 0.0], [2.3, 0.0], [3.0, 1.6]]), 1.2, ramp_s=0.15)
    back = _along(np.array([[3.0, 1.6], [1.2, 1.6]]), 1.0, ramp_s=0.15)
    rest_ticks = round(1.2 / TICK_S)
    parts = [go, np.repeat(go[-1:], rest_ticks, axis=0), aside]
    parts += [np.repeat(aside[-1:], rest_ticks, axis=0), back]
    places = _with_rests(np.concatenate(parts))
    caption = "sudden stops and starts, ways that nobody foresees"
    return _walk(
        "start-stop",
        caption,
        _ground(),
        places,
        planned=False,
        view=(-65.0, 24.0),
        spans_s=((1.4, 3.0), (3.2, 4.8), (6.0, 7.6)),
    )


def _ground(stairs: tuple[Stairs, ...] = (), polygons: tuple[Polygon, ...] = ()) -> Scene:
    return Scene(bounds=(-20.0, -20.0, 26.0, 26.0), stairs=stairs, polygons=polygons)


def _walk(
    name: str,
    caption: str,
    scene: Scene,
    places: Floats,
    *,
    planned: bool = True,
    view: tuple[float, float],
    spans_s: tuple[tuple[float, float], ...],
) -> Walk:
    return Walk(name, caption, scene, places, _headings(places), planned, view, spans_s)


def _along(line: Floats, speed_mps: float, ramp_s: float = 0.6) -> Floats:
    """Places (T, 2) at ticks along a line (P, 2), metres; speed changes evenly at its ends."""
    lengths = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))))
    whole = lengths[-1]
    seconds = whole / speed_mps + ramp_s
    t = np.arange(0.0, seconds + TICK_S, TICK_S)
    speeding = np.clip(t, 0.0, ramp_s) ** 2 / (2.0 * ramp_s) + np.maximum(t - ramp_s, 0.0)
    slowing = np.maximum(t - (seconds - ramp_s), 0.0) ** 2 / (2.0 * ramp_s)
    travelled = np.minimum(speed_mps * (speeding - slowing), whole)
    travelled[t >= seconds] = whole
    return np.stack([np.interp(travelled, lengths, axis) for axis in line.T], axis=1)


def _with_rests(places: Floats, begin_s: float = 0.4, end_s: float = 1.2) -> Floats:
    """Places (T, 2) with times of rest put before and after."""
    before = np.repeat(places[:1], round(begin_s / TICK_S), axis=0)
    after = np.repeat(places[-1:], round(end_s / TICK_S), axis=0)
    return np.concatenate((before, places, after))


def _headings(places: Floats) -> Floats:
    """Headings (T,) of a body that keeps facing where it last went."""
    moved = np.diff(places, axis=0, append=places[-1:])
    going = np.hypot(moved[:, 0], moved[:, 1]) > 1e-4
    directions = np.arctan2(moved[:, 1], moved[:, 0])
    latest = np.maximum.accumulate(np.where(going, np.arange(len(places)), -1))
    first = int(np.argmax(going))
    return np.asarray(directions[np.where(latest < 0, first, latest)])
