from typing import Any, cast

import numba

from esplanade.server.net import _frame_kernels
from esplanade.server.net.packing import Packing
from esplanade.server.rehearsal import rehearse
from esplanade.server.world import _bucket_kernels, _interest_kernels, _snapshot_kernels
from esplanade.server.world.inputs import Leave, Steer
from tests.server.worlds import FIELD, TICK_S, Trial, rules

MODULES = (_bucket_kernels, _interest_kernels, _snapshot_kernels, _frame_kernels)


def compiled() -> dict[str, int]:
    """The kernels that are compiled for calls from Python, and for how many kinds of arguments."""
    return {
        name: len(cast(Any, one).signatures)
        for module in MODULES
        for name, one in vars(module).items()
        if hasattr(one, "signatures") and one.signatures
    }


def test_no_tick_waits_for_a_kernel_after_the_rehearsal() -> None:
    if numba.config.DISABLE_JIT:  # type: ignore[attr-defined]
        return
    rehearse(rules(), TICK_S)
    before = compiled()
    assert {"look", "drop_gone", "settle_all", "choose", "gather", "measure", "pack"} <= set(before)
    trial = Trial(scene=FIELD)
    everyone = trial.join(*((50.0 + k, 50.0) for k in range(20)))
    for _ in range(20):
        news = trial.tick(*(Steer(one, 1, 0.0, 1.0) for one in everyone))
        Packing().pack(news.snapshots)
    Packing().pack(trial.tick(Leave(everyone[0])).snapshots)
    assert compiled() == before


def test_tables_grow_with_viewers_and_what_each_sees_not_with_the_zone() -> None:
    """A table of everyone by everyone would take 400 MB."""
    trial = Trial(scene=FIELD, max_people=10_000, view_limit=100)
    trial.join(*((50.0 + k, 50.0) for k in range(20)))
    views = trial.audience._interest.views
    assert sum(one.nbytes for one in views) < 20 * 2 * 101 * 16
