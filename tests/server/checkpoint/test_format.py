"""Bytes of checkpoints: what was packed comes back, and nothing else is believed."""

import zlib
from contextlib import suppress
from typing import Any

import msgpack
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.planning.agents.agents import PARAMETERS
from esplanade.server.checkpoint.errors import CheckpointError
from esplanade.server.checkpoint.format import pack, unpack

plain = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**63), 2**63) | st.floats(allow_nan=False)
    | st.text() | st.binary(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text() | st.integers(0, 9), inner),
    max_leaves=20,
)  # fmt: skip


@given(st.dictionaries(st.text(), plain))
def test_plain_data_come_back(parts: dict[str, Any]) -> None:
    assert unpack(pack(parts)) == parts


@pytest.mark.parametrize(
    "array",
    [
        np.zeros((0, 3)),
        np.arange(12, dtype=np.int64).reshape(3, 4)[:, ::2],
        np.array([True, False]),
        np.ones((2, 2), dtype=PARAMETERS),
        np.float64(np.nan) * np.ones(3),
    ],
)
def test_arrays_come_back_as_they_were_and_can_be_written(array: Any) -> None:
    found = unpack(pack({"a": {"b": [array]}}))["a"]["b"][0]
    assert (found.dtype, found.shape) == (array.dtype, array.shape)
    assert found.tobytes() == array.tobytes()
    assert found.flags.writeable


@given(st.binary(max_size=200))
def test_any_bytes_are_refused_or_are_parts(data: bytes) -> None:
    for payload in (data, zlib.compress(data)):
        with suppress(CheckpointError):
            assert isinstance(unpack(payload), dict)


@pytest.mark.parametrize(
    "extension",
    [
        msgpack.ExtType(2, b""),
        msgpack.ExtType(1, b""),
        msgpack.ExtType(1, msgpack.packb(["O", [1]]) + b"\0" * 8),
        msgpack.ExtType(1, msgpack.packb(["<f8", [3]]) + b"\0" * 8),
        msgpack.ExtType(1, msgpack.packb(["<f8", [-1, 5]]) + b"\0" * 8),
        msgpack.ExtType(1, msgpack.packb([[["a", "O"]], [1]]) + b"\0" * 8),
        msgpack.ExtType(1, msgpack.packb([[["a"]], [1]]) + b"\0" * 8),
        msgpack.ExtType(1, msgpack.packb({"a": 1})),
    ],
)
def test_arrays_that_cannot_be_are_refused(extension: msgpack.ExtType) -> None:
    with pytest.raises(CheckpointError, match="cannot be unpacked"):
        unpack(zlib.compress(msgpack.packb({"a": extension})))


def test_what_would_unpack_to_too_much_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("esplanade.server.checkpoint.format.MOST_BYTES", 1000)
    with pytest.raises(CheckpointError, match=r"cannot be unpacked|too large"):
        unpack(pack({"a": b"\0" * 10_000}))


def test_a_payload_that_is_cut_off_is_refused() -> None:
    payload = pack({"a": list(range(1000))})
    for length in range(0, len(payload), 7):
        with pytest.raises(CheckpointError):
            unpack(payload[:length])


def test_what_is_not_plain_is_not_packed() -> None:
    with pytest.raises(TypeError, match="cannot hold a object"):
        pack({"a": object()})
