"""Compiles the kernels that ticks of actors call, without a zone, for another process.

Its types are told by empty arrays; a test holds them against those of a real zone. Were they ever
others, kernels would be compiled in vain and a start take longer: nothing else.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numba import typeof, types
from numpy.typing import DTypeLike, NDArray

from esplanade.planning.agents import _tick_kernels as kernels
from esplanade.planning.agents import _trace_kernels as traces
from esplanade.planning.agents._reservation_kernels import Reservations
from esplanade.planning.agents._task_kernels import World
from esplanade.planning.agents.agent_table import AgentTable
from esplanade.planning.agents.agents import Decisions
from esplanade.planning.agents.rules import RuleModel
from esplanade.planning.agents.search import compass_moves, make_workspace
from esplanade.planning.compiled.handle import hold_for
from esplanade.planning.compiled.jit import compile_for
from esplanade.planning.grid._grid_kernels import MEASURES, GridArrays, KindArrays
from esplanade.planning.ground._barrier_kernels import LISTED
from esplanade.planning.ground._geometry_kernels import BARRIER, BarrierIndex
from esplanade.planning.ground.layered import PLACE, LayeredArrays
from esplanade.planning.people._prediction_kernels import Prediction
from esplanade.planning.people._risk_kernels import RadialTables, RiskArrays


def _array(dimensions: int, kind: DTypeLike = np.float64) -> NDArray[Any]:
    return np.zeros((1,) * dimensions, dtype=kind)


def _type(value: object) -> types.Type:
    kind: types.Type = typeof(value)  # type: ignore[no-untyped-call]
    return kind


def _ground() -> tuple[GridArrays, BarrierIndex]:
    integers, floats = _array(1, np.int64), _array(1, np.float32)
    links = _array(2, np.int32)
    box = 0.0, 0.0, 1.0, 1.0
    layered = LayeredArrays(
        _array(3, np.int32), floats, floats, links, _array(1, PLACE), floats, *box, 0.25, 1, 1
    )
    kinds = KindArrays(
        _array(2, np.int8),
        _array(2, np.uint8),
        _array(2, np.int32),
        _array(1, LISTED),
        _array(1, BARRIER),
        _array(1, MEASURES),
    )
    grid = GridArrays(layered, _array(2, np.float32), _array(2, np.bool_), False, kinds)
    return grid, BarrierIndex(_array(1, BARRIER), integers, integers, 0.0, 0.0, 1.0, 1.0, 1, 1)


def _risk() -> RiskArrays:
    tables = RadialTables(_array(4, np.float32), _array(1), 1.0, 1.0)
    index = _array(2, np.int64)
    return RiskArrays(tables, _array(3), index, index, index, 0.0, 0.0, 1.0, 1.0, 1, 1)


def _reservations() -> Reservations:
    flags, index = _array(1, np.bool_), _array(2, np.int64)
    return Reservations(
        RuleModel().row,
        _array(3),
        _array(2),
        _array(1),
        _array(1, np.int64),
        _array(2),
        flags,
        flags,
        index,
        index,
        0.0,
        0.0,
        1.0,
        1.0,
        1.0,
        1,
        1,
    )


def zone() -> kernels.Zone:
    """A zone that means nothing, of the types of any other."""
    grid, barriers = _ground()
    integers, places, flags = _array(1, np.int64), _array(2), _array(1, np.bool_)
    decisions = Decisions(_array(3), places, integers, integers, integers, flags, flags)
    return kernels.Zone(
        World(grid, _risk(), _reservations(), RuleModel().row, 0.4, 0.25),
        barriers,
        _array(3, np.float32),
        _array(2, np.float32),
        compass_moves(),
        AgentTable(1).agents,
        flags,
        _array(1),
        places,
        integers,
        decisions,
        places,
        integers,
        1.0,
        1,
    )


def signatures() -> list[tuple[Callable[..., object], tuple[types.Type, ...]]]:
    """Every kernel of a tick that Python calls, with the types that it is called for."""
    held, memory = hold_for(_type(zone())), hold_for(_type(make_workspace(1, 1)))
    people = _type(Prediction(_array(3), _array(3), _array(2), _array(2), _array(2)))
    number, count = types.float64, types.int64
    return [
        (kernels.plan_and_step, (held, memory, count, people, number)),
        (kernels.decide_some, (held, people, number, count, count, memory)),
        (kernels.settle_all, (held, people, number)),
        (kernels.index_future, (held, people, count, count)),
        (kernels.put_in_order, (held, number)),
        (kernels.take_steps, (held, number)),
        (kernels.has_room, (held, memory, count)),
        (traces.price_paths, (held, count, number, _type(_array(3)), _type(_array(2)))),
        (
            traces.risk_slices,
            (
                *(held, people, _type(_risk()), count, count),
                *(_type(_array(1, np.int64)), _type(_array(2)), _type(_array(2))),
            ),
        ),
    ]


def compile_all() -> None:
    """Compile them all."""
    for kernel, kinds in signatures():
        compile_for(kernel, *kinds)
