"""The search in buckets beside the obvious search, which is its plain twin."""

import numpy as np
import pytest

from esplanade.protocol.snapshot import pack_records
from esplanade.protocol.steps import STEP
from esplanade.server.world.avatars import STOREY_WEIGHT, Avatars
from esplanade.server.world.buckets import sort_into_buckets
from esplanade.server.world.compiled._bucket_kernels import ORDER_BITS, find_nearest
from esplanade.server.world.frame import Entered, Events, Frame
from esplanade.server.world.state import PERSON


def crowd(places_m: np.ndarray) -> Avatars:
    """Avatars 1, 2, ... at these places, (N, 3)."""
    count = len(places_m)
    ids, zeros = np.arange(1, count + 1), np.zeros(count)
    records = pack_records(
        ids, ids * 0, ids * 0, places_m[:, :2], places_m[:, 2], zeros, zeros, (0.0, 0.0)
    )
    entered = [Entered(int(one), PERSON, "p", (b"", b"")) for one in ids]
    steps = np.zeros(0, dtype=STEP)
    frame = Frame(1, count, 0, [], entered, [], [], [], {}, records, steps, Events())
    avatars = Avatars((0.0, 0.0))
    avatars.add(entered)
    avatars.update(frame)
    return avatars


def nearest(places_m: np.ndarray, one: int, wanted: int, reach_m: float) -> list[int]:
    """Ids of the nearest: by squared distance in whole cm, of equals the older."""
    cm = np.rint(100.0 * places_m).astype(int) * [1, 1, STOREY_WEIGHT]
    apart2 = ((cm - cm[one - 1]) ** 2).sum(axis=1)
    order = sorted((d, k + 1) for k, d in enumerate(apart2.tolist()) if d <= (100 * reach_m) ** 2)
    return [who for _, who in order[:wanted]]


def found(avatars: Avatars, one: int, wanted: int, reach_m: float) -> list[int]:
    buckets = sort_into_buckets(avatars)
    keys = np.empty(len(buckets.in_order), dtype=np.int64)
    count = find_nearest(buckets, avatars.row(one), wanted, 100.0 * reach_m, keys)
    rows = buckets.in_order[keys[:count] & ((1 << ORDER_BITS) - 1)]
    ids: list[int] = avatars.ids[rows].tolist()
    return ids


CROWDS = {
    "a square": lambda random, n: random.uniform(0.0, 40.0, (n, 3)) * [1, 1, 0],
    "floors": lambda random, n: random.uniform(0.0, 20.0, (n, 3)) * [1, 1, 0.5],
    "a line": lambda random, n: random.uniform(0.0, 300.0, (n, 3)) * [1, 0, 0],
    "one spot": lambda _, n: np.full((n, 3), 5.0),
    "whole metres": lambda random, n: random.integers(0, 12, (n, 3)) * [1.0, 1, 0],
    "a heap and one far off": lambda random, n: np.vstack(
        [random.uniform(0.0, 2.0, (n - 1, 3)), [600.0, 600.0, 0.0]]
    ),
}


@pytest.mark.parametrize("reach_m", [0.0, 1.0, 8.0, 1000.0])
@pytest.mark.parametrize("shape", CROWDS)
def test_the_nearest_are_those_of_the_obvious_search(shape: str, reach_m: float) -> None:
    random = np.random.default_rng(3)
    for count in (1, 7, 150):
        places_m = CROWDS[shape](random, count)
        avatars = crowd(places_m)
        for one in {1, count // 2 + 1, count}:
            for wanted in (1, 10, 101):
                expected = nearest(places_m, one, wanted, reach_m)
                assert found(avatars, one, wanted, reach_m) == expected


def test_the_table_grows_and_rows_are_used_again() -> None:
    avatars = crowd(np.zeros((200, 3)))
    assert sorted(avatars.ids[avatars.in_order].tolist()) == list(range(1, 201))
    row = avatars.row(17)
    avatars.remove([17, 999])
    assert 17 not in avatars
    assert 17 not in avatars.ids[avatars.in_order]
    avatars.add([Entered(500, PERSON, "late", (b"", b""))])
    assert avatars.row(500) == row
    assert avatars.name(500) == "late"
    assert all(ticks[row] == 0 for ticks in avatars.changes)
