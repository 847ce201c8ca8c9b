"""Guessing is slowed down by address and by name, longer each time."""

import pytest

from esplanade.server.accounts import lockout
from esplanade.server.accounts.lockout import LockedOutError, Lockout


def wrong(brake: Lockout, times: int, now_s: float, name: str = "ann", address: str = "a") -> None:
    for _ in range(times):
        brake.take(name, address, now_s)


def locked_s(brake: Lockout, now_s: float, name: str = "ann", address: str = "a") -> int:
    with pytest.raises(LockedOutError, match="this one was not looked at: try again in") as raised:
        brake.take(name, address, now_s)
    return raised.value.seconds


def test_five_wrong_in_a_minute_lock_for_a_minute() -> None:
    brake = Lockout()
    wrong(brake, 4, 0.0)
    wrong(brake, 1, 59.0)
    assert locked_s(brake, 59.0) == 60
    assert locked_s(brake, 118.5) == 1
    wrong(brake, 1, 119.0)
    assert (brake.wrong, brake.unread, brake.locks) == (6, 2, 2)  # an address and a name


def test_five_in_more_than_a_minute_lock_nobody() -> None:
    brake = Lockout()
    for count in range(50):
        brake.take("ann", "a", count * 15.1)
    assert brake.locks == 0


def test_an_address_is_locked_whatever_the_name() -> None:
    brake = Lockout()
    for name in "abcde":
        brake.take(name, "a", 0.0)
    assert locked_s(brake, 1.0, name="f") == 59
    brake.take("f", "elsewhere", 1.0)


def test_a_name_is_locked_whatever_the_address() -> None:
    brake = Lockout()
    for address in "abcde":
        brake.take("ann", address, 0.0)
    assert locked_s(brake, 1.0, address="f") == 59
    brake.take("bob", "f", 1.0)


def test_each_lock_lasts_twice_as_long_up_to_an_hour_and_a_quiet_day_ends_that() -> None:
    brake, now_s, lasted = Lockout(), 0.0, []
    for _ in range(8):
        wrong(brake, 5, now_s)
        lasted.append(locked_s(brake, now_s))
        now_s += lasted[-1]
    assert lasted == [60, 120, 240, 480, 960, 1920, 3600, 3600]
    now_s += lockout.QUIET_S + 1
    wrong(brake, 5, now_s)
    assert locked_s(brake, now_s) == 60


def test_many_at_once_are_no_way_around() -> None:
    brake = Lockout()
    wrong(brake, 5, 0.0)  # all of them are being compared, and none has been found wrong yet
    locked_s(brake, 0.0)


def test_right_passwords_do_not_count() -> None:
    brake = Lockout()
    for count in range(50):
        brake.take("ann", "a", float(count))
        brake.forgive("ann", "a", float(count))
    assert (brake.wrong, brake.locks) == (0, 0)


def test_who_knows_one_password_cannot_guess_at_others_without_bound() -> None:
    brake, guesses = Lockout(), 0
    for second in range(60):
        try:
            for count in range(4):
                brake.take(f"victim-{second}-{count}", "a", float(second))
                guesses += 1
            brake.take("mallory", "a", float(second))
            brake.forgive("mallory", "a", float(second))
        except LockedOutError:
            pass
    assert guesses == 5


def test_a_right_password_that_came_as_the_fifth_unlocks() -> None:
    brake = Lockout()
    wrong(brake, 4, 0.0, name="bob")
    brake.take("ann", "a", 1.0)
    brake.forgive("ann", "a", 1.0)
    assert brake.wrong == 4
    brake.take("ann", "a", 2.0)
    assert locked_s(brake, 2.0) == 60


def test_what_is_remembered_is_bounded() -> None:
    brake = Lockout()
    wrong(brake, 5, 0.0)
    for count in range(2 * lockout.REMEMBERED):
        brake.take(f"n{count}", f"a{count}", 1.0)
    assert len(brake._addresses) == len(brake._names) == lockout.REMEMBERED
    brake.take("ann", "a", 2.0)  # its lock was forgotten for the sake of the others
