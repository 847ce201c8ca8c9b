"""An actor that goes from zone to zone is in one of them, whichever checkpoints are the newest."""

from functools import partial
from typing import Any

import pytest
from sqlalchemy import Connection

from esplanade.server.cluster import ownership, travellers
from esplanade.server.cluster.ownership import NotOwnerError
from esplanade.server.cluster.tenure import Claim
from esplanade.server.cluster.travellers import TravellerRow
from esplanade.server.store.sql_store import SqlStore

ANN = "yard/actor-1"
SENT = TravellerRow(ANN, "yard", "hall", "{}", "[]", has_left=False, has_come=False)


@pytest.fixture
async def yard(store: SqlStore) -> Claim:
    """The owner of the yard."""

    def claim(connection: Connection) -> Claim:
        for zone in ("yard", "hall"):
            ownership.add_zone(connection, zone)
        made = ownership.claim(connection, "ash", ["yard"], now=4_000_000_000_000_000)
        assert made is not None
        return made

    return await store.write(claim)


async def send(store: SqlStore, owner: Claim, zone: str = "hall") -> bool:
    return await store.write(
        partial(travellers.send, owner=owner, zone=zone, actor=ANN, spec="{}", parameters="[]")
    )


async def settle(
    store: SqlStore, zone: str, *, left: tuple[str, ...] = (), came: tuple[str, ...] = ()
) -> None:
    await store.write(partial(travellers.settle, zone=zone, left=left, came=came))


async def rows(store: SqlStore, zone: str) -> list[Any]:
    return await store.read(partial(travellers.travellers_of, zone=zone))


async def test_a_row_stays_until_both_checkpoints_know(store: SqlStore, yard: Claim) -> None:
    assert await send(store, yard)
    assert await rows(store, "yard") == await rows(store, "hall") == [SENT]
    assert await rows(store, "roof") == []
    await settle(store, "yard")  # a checkpoint from before the actor was there, or went
    await settle(store, "hall")  # and one from before it came
    await settle(store, "hall", left=(ANN,))  # that is another one, of the same id
    assert await rows(store, "hall") == [SENT]
    await settle(store, "hall", came=(ANN,))
    (row,) = await rows(store, "yard")
    assert (row.has_left, row.has_come) == (False, True)
    await settle(store, "yard", left=(ANN,))
    assert await rows(store, "yard") == []


async def test_an_actor_is_on_one_way_at_once(store: SqlStore, yard: Claim) -> None:
    assert await send(store, yard)
    assert not await send(store, yard, "roof")
    assert await rows(store, "hall") == [SENT]


async def test_whoever_has_lost_the_zone_lets_nobody_go(store: SqlStore, yard: Claim) -> None:
    await store.write(partial(ownership.fence, zone="yard"))
    with pytest.raises(NotOwnerError):
        await send(store, yard)
    assert await rows(store, "hall") == []
