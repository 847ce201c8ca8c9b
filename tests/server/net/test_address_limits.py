import pytest

from esplanade.server.net.address_limits import (
    MAX_REMEMBERED,
    WINDOW_S,
    AddressBounds,
    AddressLimits,
)
from esplanade.server.settings import ServerSettings

BOUNDS = AddressBounds(sockets=3, connects=5, joins=2, frames=8)


def test_open_connections_of_an_address_are_bounded() -> None:
    limits = AddressLimits(BOUNDS)
    assert [limits.connect("a", 0.0) for _ in range(4)] == [None] * 3 + ["address_sockets"]
    assert limits.connect("b", 0.0) is None
    limits.disconnect("a")
    assert limits.connect("a", 0.0) is None


def test_new_connections_of_an_address_are_bounded_in_time() -> None:
    limits = AddressLimits(BOUNDS)
    for _ in range(5):
        assert limits.connect("a", 0.0) is None
        limits.disconnect("a")
    assert limits.connect("a", 0.0) == "address_connects"
    assert limits.connect("b", 0.0) is None
    assert limits.connect("a", WINDOW_S / 5) is None
    assert limits.connect("a", WINDOW_S / 5) == "address_connects"


def test_joins_of_an_address_are_bounded_in_time() -> None:
    limits = AddressLimits(BOUNDS)
    assert [limits.join("a", 0.0) for _ in range(3)] == [None, None, "address_joins"]
    assert limits.join("b", 0.0) is None
    assert limits.join("a", WINDOW_S) is None


def test_frames_of_an_address_wait_for_each_other() -> None:
    limits = AddressLimits(BOUNDS)
    assert limits.delay("a", 6, 0.0) == 0.0  # two are the burst; the others are borrowed
    assert limits.delay("a", 1, 0.0) == pytest.approx(5 / 8)
    assert limits.delay("b", 1, 0.0) == 0.0
    assert limits.delay("a", 1, 5 / 8) == 0.0
    assert limits.delay("a", 1, 5 / 8) > 0.0


def test_this_machine_has_no_limits_but_its_other_loopback_addresses_do() -> None:
    limits = AddressLimits(BOUNDS)
    for key in ("127.0.0.1", "::1"):
        assert {limits.connect(key, 0.0) for _ in range(1000)} == {None}
        assert {limits.join(key, 0.0) for _ in range(1000)} == {None}
        assert {limits.delay(key, 100, 0.0) for _ in range(1000)} == {0.0}
        limits.disconnect(key)
    assert {limits.connect("127.0.0.2", 0.0) for _ in range(10)} == {None, "address_sockets"}


def test_a_crowd_of_addresses_is_not_remembered_for_ever() -> None:
    limits = AddressLimits(BOUNDS)
    assert limits.connect("busy", 0.0) is None
    for number in range(2 * MAX_REMEMBERED):
        assert limits.connect(str(number), 0.0) is None
        limits.disconnect(str(number))
    assert len(limits._idle) == MAX_REMEMBERED
    assert len(limits) == 1
    # An address with a connection is never forgotten.
    assert [limits.connect("busy", 0.0) for _ in range(3)] == [None, None, "address_sockets"]


def test_defaults_admit_a_classroom_behind_one_address() -> None:
    """Sixty people open the page in the same second: each has a WebSocket and fetches files."""
    limits = AddressLimits(AddressBounds.of(ServerSettings()))
    people, files = 60, 4
    for _ in range(people * (files + 1)):
        assert limits.connect("192.0.2.7", 0.0) is None
    for _ in range(people):
        assert limits.join("192.0.2.7", 0.0) is None


def test_frames_are_paid_for_in_advance_only_while_there_is_plenty() -> None:
    limits = AddressLimits(AddressBounds(sockets=3, connects=5, joins=2, frames=64))
    assert limits.connect("a", 0.0) is None
    assert limits.prepay("a", 8, 0.0)
    assert not limits.prepay("a", 1, 0.0)
    assert limits.delay("a", 8, 0.0) == 0.0
    assert limits.delay("a", 1, 0.0) > 0.0
    limits.pay_back("a", 8, 0.0)
    assert limits.delay("a", 8, 0.0) == 0.0
    assert limits.prepay("127.0.0.1", 1000, 0.0)
    limits.pay_back("127.0.0.1", 1000, 0.0)
