"""Objects that clients need for long are no longer looked through; garbage goes all the same."""

import gc
import weakref
from collections.abc import Iterator

import pytest

from esplanade.server.net.long_lived import LEAST_GONE, MANY, LongLived


class Connection:
    """Something that refers to itself, as connections do."""

    def __init__(self) -> None:
        self.itself = self


@pytest.fixture(autouse=True)
def _thawed() -> Iterator[None]:
    yield
    gc.unfreeze()


def test_what_has_come_is_not_looked_through() -> None:
    gc.unfreeze()
    long_lived, made = LongLived(), Connection()
    long_lived.between_ticks(MANY - 1, 0, MANY - 1)
    assert any(each is made for each in gc.get_objects())
    long_lived.between_ticks(1, 0, MANY)
    assert not any(each is made for each in gc.get_objects())
    assert gc.get_freeze_count() > 0


def test_those_who_have_gone_are_garbage_in_the_end() -> None:
    long_lived, made = LongLived(), Connection()
    seen = weakref.ref(made)
    long_lived.between_ticks(MANY, 0, 400)
    del made
    gc.collect()
    assert seen() is not None
    long_lived.between_ticks(0, LEAST_GONE, 400)
    assert seen() is not None
    long_lived.between_ticks(0, 100 - LEAST_GONE, 400)
    assert seen() is None
    assert gc.get_freeze_count() > 0
