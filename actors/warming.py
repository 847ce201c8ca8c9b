"""Has ready beforehand what ticks of actors call: kernels are compiled, tables of risk are made."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from esplanade.actors.navigator import Navigator
from esplanade.actors.parameter_records import RADII_M
from esplanade.planning import Body, Polygon, Potential, Scene
from esplanade.planning.people.risk import RADIUS_STEP_M


def tables_ahead(navigator: Navigator) -> list[Callable[[], None]]:
    """Work that makes, in any thread, what actors of other radii will need to know of risk.

    A table takes several times as long as all else that another body needs.
    """
    least, most = (round(limit / RADIUS_STEP_M) for limit in RADII_M)
    return [
        partial(navigator.prepare_contacts, [Body(radius_m=round(k * RADIUS_STEP_M, 2))])
        for k in range(least, most + 1)
    ]


def warm_up(tick_s: float, ready_to_plan: Callable[[], None]) -> None:
    """Run a small zone, which is not all level: on level ground some kernels are not called.

    Few actors and many are planned for by different ones. `ready_to_plan` waits until the kernels
    that plan have been compiled elsewhere.
    """
    step = Polygon(points=((4.5, 4.5), (5.5, 4.5), (5.5, 5.5), (4.5, 5.5)), height_m=0.3)
    walls = [((3.0, 0.0), (3.0, 2.0))]
    scene = Scene.open_space((0.0, 0.0, 6.0, 6.0), walls=walls, polygons=[step])
    navigator = Navigator(scene, tick_s)
    navigator.grid.walk([(1.0, 1.0)], [0], [(0.1, 0.0)], 0.2)
    navigator.grid.nearest_free((3.0, 1.0), 0.0, 0.25)
    navigator.grid.with_heights(np.ones((1, 2, 2)), np.zeros(1, dtype=np.int64))
    potential = Potential(navigator.grid, (5.0, 1.0), 0, 0.25)
    potential.direction([(1.0, 1.0)], [0])
    potential.distance([(1.0, 1.0)], [0])
    Potential(navigator.grid, (5.0, 1.0), 0, 0.25, body=Body(edge_cells=2))
    navigator.observe({"p": (3.0, 5.05)})
    navigator.tick()
    navigator.tracing.wanted = True
    ready_to_plan()
    navigator.add_actor("a", (1.0, 1.0), (5.0, 1.0))
    navigator.add_actor("b", (5.0, 1.0), (1.0, 1.0))
    for k in range(40):
        navigator.observe({"p": (3.0, 5.0 - 0.05 * k)})
        navigator.tick()
        if k == 30:
            for n in range(10):
                navigator.add_actor(n, (0.5 + 0.5 * n, 3.5), (1.0, 1.0))
    navigator.trace("a")
    navigator.close()
