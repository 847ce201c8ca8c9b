"""Layers of the map: planned ways, goals, and the circles in which people are expected."""

import json
from collections.abc import Hashable
from typing import Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from esplanade.planning import Prediction
from esplanade.server.live.map_feed import MapFeed
from esplanade.server.live.subscriptions import LayersWish
from esplanade.server.live.tap import Probe
from esplanade.server.world.zone import Zone

Floats = npt.NDArray[np.float64]
PROBE: Final = "layers"
NEAR_M: Final = 8.0
"""Circles of people further than this from an actor are left out, if actors are named."""
SIGMAS: Final = 2.0


class Layers(NamedTuple):
    """The plans of actors at a tick."""

    ids: tuple[Hashable, ...]
    ways: Floats
    """(A, K, 3) m."""
    goals: Floats
    """(A, 3) m, nan without one."""
    people: Prediction
    slice_s: float


def layers_probe(every: int) -> Probe:
    """Let the zone be asked for the layers, every so many ticks."""
    return Probe(_layers, every)


def _layers(zone: Zone) -> Layers:
    table, people = zone.agents, zone.predicted()
    return Layers(
        tuple(table),
        table.agents.planned.copy(),
        table.trips.wanted.copy(),
        people._replace(
            means=people.means.copy(), heights=people.heights.copy(), sigmas=people.sigmas.copy()
        ),
        zone.slice_s,
    )


def told(layers: Layers, wish: LayersWish, feed: MapFeed) -> str:
    """The message of a subscription to layers."""
    chosen = None if wish.actors is None else set(wish.actors)
    rows = [k for k, who in enumerate(layers.ids) if chosen is None or who in chosen]
    message: dict[str, Any] = {"channel": "map.layers", "tick": feed.tick}
    if wish.ways:
        ways = layers.ways.round(2)
        message["ways"] = {str(layers.ids[k]): ways[k].tolist() for k in rows}
    if wish.goals:
        going = [k for k in rows if not np.isnan(layers.goals[k, 0])]
        message["goals"] = {str(layers.ids[k]): layers.goals[k].round(2).tolist() for k in going}
    if wish.circles:
        circles = _circles(layers)
        if chosen is None:
            message["circles"] = {"": circles.reshape(-1, 5).tolist()}
        else:
            message["circles"] = {
                str(layers.ids[k]): circles[
                    np.hypot(*(circles[:, 0, :2] - layers.ways[k, 0, :2]).T) <= NEAR_M
                ]
                .reshape(-1, 5)
                .tolist()
                for k in rows
            }
    return json.dumps(message)


def _circles(layers: Layers) -> Floats:
    """Circles of all people, float64 (P, K, 5): x, y, z, radius of two deviations m, seconds."""
    people = layers.people
    slices = people.means.shape[1]
    times = np.broadcast_to(np.arange(slices) * layers.slice_s, people.heights.shape)
    stacked = np.dstack([people.means, people.heights, SIGMAS * people.sigmas, times])
    rounded: Floats = stacked.astype(np.float64).round(2)
    return rounded
