"""The store as restarts need it, in SQLite and in PostgreSQL."""

import asyncio
from pathlib import Path
from typing import Any

import pytest

from esplanade.server.accounts.identity import MACHINE
from esplanade.server.audit.log import AuditLog
from esplanade.server.checkpoint.errors import CheckpointError
from esplanade.server.checkpoint.format import FORMAT, digest, pack
from esplanade.server.checkpoint.ids import BLOCK, reserve
from esplanade.server.checkpoint.restoring import restored
from esplanade.server.checkpoint.rows import (
    KeptCheckpoint,
    KeptSeat,
    add_seat,
    change_seat,
    read_seats,
    remove_seat,
    write_checkpoint,
)
from esplanade.server.checkpoint.scene import SceneKey
from esplanade.server.checkpoint.seat_keeper import SeatKeeper
from esplanade.server.operating.forgetting import forget
from esplanade.server.store.backup import read_backup, write_backup
from esplanade.server.store.location import Location
from esplanade.server.store.sql_store import SqlStore, open_store

SCENE = SceneKey.of("room", "{}", None)
ANN = KeptSeat(7, "Ann", "192.0.2.1", (b"\1" * 32,), (1.0, 2.0, 0.0))
BEN = KeptSeat(8, "Ben", "192.0.2.2", (b"\2" * 32, b"\3" * 32), (3.0, 4.5, 6.25))


def kept(parts: dict[str, Any], **changes: Any) -> KeptCheckpoint:
    payload = pack(parts)
    values: dict[str, Any] = {
        "made_us": 1,
        "tick": 40,
        "scene": SCENE.digest,
        "scene_name": SCENE.name,
        "format": FORMAT,
        "digest": digest(payload),
        "payload": payload,
    }
    return KeptCheckpoint(**{**values, **changes})


async def put(store: SqlStore, checkpoint: KeptCheckpoint, *seats: KeptSeat) -> None:
    def write(connection: Any) -> None:
        write_checkpoint(connection, store.zone, checkpoint)
        for seat in seats:
            add_seat(connection, store.zone, seat)

    await store.write(write)


async def test_a_new_world_has_no_past(store: SqlStore) -> None:
    found = await restored(store, SCENE, fresh=False)
    assert (found.parts, found.seats, found.tick) == (None, [], 0)
    assert found.ids == (1, 1 + BLOCK)


async def test_the_newest_checkpoint_counts(store: SqlStore) -> None:
    await put(store, kept({"zone": 1}), ANN, BEN)
    await put(store, kept({"zone": 2}, tick=60))
    found = await restored(store, SCENE, fresh=False)
    assert (found.parts, found.tick) == ({"zone": 2}, 60)
    assert found.seats == [ANN, BEN]


async def test_no_number_is_given_away_twice(store: SqlStore) -> None:
    blocks = await asyncio.gather(
        *(store.write(lambda connection: reserve(connection, store.zone)) for _ in range(5))
    )
    blocks.append((await restored(store, SCENE, fresh=True)).ids)
    assert [block.first for block in sorted(blocks)] == [1 + k * BLOCK for k in range(6)]


async def test_a_fresh_world_has_no_past_but_new_numbers(store: SqlStore) -> None:
    await put(store, kept({"zone": 1}), ANN)
    first = await restored(store, SCENE, fresh=False)
    found = await restored(store, SCENE, fresh=True)
    assert (found.parts, found.seats) == (None, [])
    assert found.ids.first == first.ids.end
    assert (await restored(store, SCENE, fresh=False)).parts is None


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"scene": "0", "scene_name": "hall"}, "is of the scene 'hall', and this is 'room'"),
        ({"scene": "0"}, "is of another state of the scene 'room'"),
        ({"format": "esplanade checkpoint 9"}, "is of the format 'esplanade checkpoint 9'"),
        ({"digest": "0"}, "is damaged, its digest is another"),
        ({"payload": b"no", "digest": digest(b"no")}, "cannot be read: it cannot be unpacked"),
    ],
)
async def test_what_does_not_fit_is_refused_and_stays(
    store: SqlStore, changes: dict[str, Any], why: str
) -> None:
    await put(store, kept({"zone": 1}, **changes), ANN)
    for _ in range(2):
        with pytest.raises(CheckpointError, match=why) as raised:
            await restored(store, SCENE, fresh=False)
        assert "--fresh" in str(raised.value)
        assert str(store.location) in str(raised.value)
    assert (await restored(store, SCENE, fresh=True)).parts is None


async def test_a_copy_has_checkpoint_and_seats(store: SqlStore, tmp_path: Path) -> None:
    await put(store, kept({"zone": [1, b"\0\xff"]}), ANN, BEN)
    await store.write(lambda connection: reserve(connection, store.zone))
    copy = tmp_path / "copy.zip"
    counts = await store.read(lambda connection: write_backup(connection, copy))
    assert (counts["checkpoints"], counts["seats"], counts["reserved"]) == (1, 2, 1)
    location = Location.of(tmp_path / "elsewhere")
    async with open_store(location) as other:
        await asyncio.to_thread(read_backup, other.engine, location, copy)
        found = await restored(other, SCENE, fresh=False)
    assert (found.parts, found.seats) == ({"zone": [1, b"\0\xff"]}, [ANN, BEN])
    assert found.ids.first == 1 + BLOCK


async def test_a_person_is_forgotten_in_seats(store: SqlStore) -> None:
    await put(store, kept({}), ANN, BEN)
    counts = await forget(store, AuditLog(store, "server"), MACHINE, "Ann")
    assert counts["seats"] == 1
    found = await restored(store, SCENE, fresh=False)
    assert found.seats == [BEN]
    keeper = SeatKeeper(store)
    assert not await keeper.change(ANN.avatar, "", ())
    assert await keeper.change(BEN.avatar, "192.0.2.3", (b"\4" * 32,))


async def test_seats_are_written_in_their_order(store: SqlStore) -> None:
    keeper = SeatKeeper(store)
    added = [keeper.add(ANN), keeper.add(BEN)]
    keeper.confirm(BEN.avatar, "here", BEN.digests[1:])
    keeper.remove(ANN.avatar)
    assert await asyncio.gather(*added) == [True, True]
    await keeper.stop()
    seats = await store.read(lambda connection: read_seats(connection, store.zone))
    assert [(seat.avatar, seat.address, seat.digests) for seat in seats] == [
        (8, "here", (b"\3" * 32,))
    ]
    keeper.remove(BEN.avatar)  # the server ends: people keep their seats
    assert not await keeper.add(ANN)
    assert len(await store.read(lambda connection: read_seats(connection, store.zone))) == 1


async def test_who_cannot_be_kept_is_told_and_a_removal_is_tried_again(
    store: SqlStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("esplanade.server.checkpoint.seat_keeper.PAUSE_S", 0.01)
    await store.write(lambda connection: add_seat(connection, store.zone, ANN))
    keeper = SeatKeeper(store)
    twice = keeper.add(ANN)  # there is a row of this avatar already
    keeper.remove(ANN.avatar)
    assert not await twice
    await keeper.add(BEN)  # changes are made in their order
    await keeper.stop()
    assert await store.read(lambda connection: read_seats(connection, store.zone)) == [BEN]


async def test_a_seat_that_is_gone_is_not_changed(store: SqlStore) -> None:
    def work(connection: Any) -> tuple[bool, bool]:
        add_seat(connection, store.zone, ANN)
        first = change_seat(connection, store.zone, ANN.avatar, "x", [])
        remove_seat(connection, store.zone, ANN.avatar)
        return first, change_seat(connection, store.zone, ANN.avatar, "x", [])

    assert await store.write(work) == (True, False)
