"""A gateway takes seats for a crowd that comes at once, and refuses none of it for its number."""

import asyncio

import pytest

from esplanade.server.cluster.person_record import PersonRecord
from esplanade.server.gateway import cluster_seats
from esplanade.server.gateway.cluster_seats import ClusterSeats
from esplanade.server.store.sql_store import SqlStore
from esplanade.server.store.writing import WAITING

CROWD = WAITING + 150
"""More than may wait for the store."""
KEEP_US = 600_000_000


async def test_a_crowd_that_comes_back_at_once_is_refused_nothing(
    store: SqlStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cluster_seats, "ANSWER_S", 120.0)
    desk, record = ClusterSeats(store, "east"), PersonRecord(address="192.0.2.7")
    names = [[(f"Member {k}", f"member {k}")] for k in range(CROWD)]
    taken = await asyncio.gather(*(desk.take("yard", name, record) for name in names))
    most_waited = 0

    async def back(token: str) -> int:
        nonlocal most_waited
        found = await desk.resume(token, KEEP_US)
        most_waited = max(most_waited, store.waiting)
        assert found is not None
        return found[0].person

    came_back = await asyncio.gather(*(back(token) for _, token in taken))
    assert list(came_back) == [seat.person for seat, _ in taken]
    assert store.refused == 0
    # A gateway has more to write, and finds room for it meanwhile.
    assert most_waited <= cluster_seats.TOGETHER
