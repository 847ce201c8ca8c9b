"""Operator keys: wrong ones are counted and slowed, one address at a time."""

import pytest

from esplanade.server.metrics import Metrics
from esplanade.server.net import operator_keys
from esplanade.server.net.operator_keys import (
    PERIOD_S,
    WRONG_KEYS,
    OperatorKeys,
    TooManyKeysError,
)


def test_the_right_key_opens_and_nothing_else_does() -> None:
    keys = OperatorKeys("sesame", Metrics())
    assert keys.opens("sesame", "a", 0.0)
    assert not keys.opens(None, "a", 0.0)
    assert not keys.opens("", "a", 0.0)
    assert not keys.opens("Sesame", "a", 0.0)
    assert not keys.opens("\ud800", "a", 0.0)
    assert not OperatorKeys("", Metrics()).opens("x", "a", 0.0)


def test_after_some_wrong_keys_further_ones_of_the_address_are_not_read() -> None:
    metrics = Metrics()
    keys = OperatorKeys("sesame", metrics)
    for k in range(WRONG_KEYS):
        assert not keys.opens("guess", "a", float(k))
    with pytest.raises(TooManyKeysError, match="try again in 50 s"):
        keys.opens("sesame", "a", 10.0)
    assert not keys.opens(None, "a", 10.0)
    assert keys.opens("sesame", "b", 10.0)
    assert keys.opens("sesame", "a", PERIOD_S + 0.5)
    text = metrics.exposition()
    assert b'esplanade_operator_keys_refused_total{why="wrong"} 5.0' in text
    assert b'esplanade_operator_keys_refused_total{why="unread"} 1.0' in text


def test_addresses_that_are_remembered_are_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(operator_keys, "MAX_ADDRESSES", 3)
    keys = OperatorKeys("sesame", Metrics())
    for address in "abcd":
        for _ in range(WRONG_KEYS):
            keys.opens("guess", address, 0.0)
    assert keys.opens("sesame", "a", 1.0)
    with pytest.raises(TooManyKeysError):
        keys.opens("sesame", "b", 1.0)
