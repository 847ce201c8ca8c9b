"""Copies of a zone in the database: which one is entered, and which ones are claimed."""

from collections.abc import Iterator

import pytest
from sqlalchemy import Connection

from esplanade.server.cluster import copy_rows, ownership, seats
from esplanade.server.cluster.ownership import LEASE_US
from esplanade.server.copies import Copies
from esplanade.server.store.engines import writing_engine
from esplanade.server.store.location import Location
from esplanade.server.store.upgrading import upgrade

NOW_US = 4_000_000_000_000_000
"""Later than any database server has started."""
HALLS = Copies(("hall", "hall-2"), most_people=2)
ZONES = ("hall", "hall-2", "yard")


@pytest.fixture
def connection(location: Location) -> Iterator[Connection]:
    engine = writing_engine(location, durable=False, zone="main")
    upgrade(engine, location)
    with engine.begin() as made:
        for zone in ZONES:
            assert ownership.add_zone(made, zone)
        yield made
    engine.dispose()


def claim(connection: Connection, host: str, now_us: int = NOW_US) -> str | None:
    claimed = copy_rows.claim(connection, host, ZONES, [HALLS], now=now_us)
    return None if claimed is None else claimed.zone


def seat(connection: Connection, zone: str, number: int) -> None:
    for k in range(number):
        seats.take(connection, zone, f"{zone} {k}", "east", b"")


def entered(connection: Connection, wished: str | None = None) -> str | None:
    return copy_rows.entered(connection, HALLS, wished, now=NOW_US + 1)


def test_a_copy_is_claimed_once_the_zone_is_full_enough(connection: Connection) -> None:
    assert [claim(connection, host) for host in ("ash", "birch", "cedar")] == ["hall", "yard", None]
    assert not copy_rows.is_wanted(connection, HALLS, "hall-2")
    assert entered(connection, "hall-2") == "hall"  # nobody owns the copy
    seat(connection, "hall", 2)
    assert entered(connection) is None
    assert copy_rows.is_wanted(connection, HALLS, "hall-2")
    assert claim(connection, "cedar") == "hall-2"
    assert entered(connection) == "hall-2"
    seat(connection, "hall-2", 2)
    assert entered(connection) is None


def test_zones_with_people_are_claimed_before_a_copy_without(connection: Connection) -> None:
    seat(connection, "hall", 2)
    later_us = NOW_US + LEASE_US + 1
    assert {claim(connection, "ash"), claim(connection, "birch")} == {"hall", "yard"}
    # All are without an owner, and the copy has been for longest.
    order = [claim(connection, host, later_us) for host in ("cedar", "dogwood", "elm")]
    assert set(order[:2]) == {"hall", "yard"}
    assert order[2] == "hall-2"


def test_a_copy_with_people_is_claimed_whatever_room_there_is_elsewhere(
    connection: Connection,
) -> None:
    seat(connection, "hall-2", 1)
    assert {claim(connection, host) for host in ("ash", "birch", "cedar")} == set(ZONES)


def test_while_no_copy_has_an_owner_newcomers_wait_for_the_first(connection: Connection) -> None:
    assert entered(connection) == "hall"
