"""Batches and answers go over the network and come out as they were; anything else is refused."""

from contextlib import suppress
from dataclasses import replace

import hypothesis.strategies as st
import msgpack
import numpy as np
import pytest
from hypothesis import given

from esplanade.protocol.looks import Look
from esplanade.protocol.messages import Report, WalkTo
from esplanade.server.link.answers import (
    MOST_BYTES,
    Answer,
    AnswerError,
    decode_answers,
    encode_answers,
)
from esplanade.server.link.batches import (
    MOVEMENT,
    Batch,
    BatchError,
    decode_batch,
    encode_batch,
)


def full_batch() -> Batch:
    """A batch with something of everything."""
    movements = np.array([(7, 2, 41, 0.5, 1.25), (8, 1, 3, -3.0, 0.0)], dtype=MOVEMENT)
    return Batch(
        "east-1",
        12,
        2**41,
        movements,
        [(7, 2), (8, 1)],
        [(9, 1, True), (10, 4, False)],
        [(11, 3, WalkTo(seq=5, x=1.0, y=-2.5, z=0.0, strict=True))],
        [(7, 2, "good day")],
        [(7, 2, 2**31), (8, 1, None)],
        [(8, 1, "gate", True)],
        [(12, 1)],
        [(7, 2, [8, 9]), (8, 1, [])],
        [(7, 2, Report(id=8, line=2**40, text="is rude")), (8, 1, Report(id=9, text="?"))],
        [(7, 2, True)],
        [(8, 1, 3)],
        [(7, 2, Look(1, 2, 3, 4, 5, 171))],
    )


def test_a_batch_comes_out_as_it_was() -> None:
    batch = full_batch()
    again = decode_batch(encode_batch(batch))
    assert again.movements.tobytes() == batch.movements.tobytes()
    for name in Batch.__dataclass_fields__.keys() - {"movements"}:
        assert getattr(again, name) == getattr(batch, name), name


def test_older_programs_read_batches_without_anything_of_newer_ones() -> None:
    older = replace(full_batch(), reports=[], presences=[], gestures=[], looks=[])
    assert msgpack.unpackb(encode_batch(older)[24 + older.movements.nbytes :])[9:] == []
    newer = encode_batch(full_batch())
    rest = msgpack.unpackb(newer[24 + older.movements.nbytes :])
    rest[9]["of a later version"] = [1]
    assert decode_batch(newer[: 24 + older.movements.nbytes] + msgpack.packb(rest)).gestures


def test_an_empty_batch_is_small() -> None:
    assert len(encode_batch(Batch("east", 1, 1))) < 50


@given(place=st.integers(0, 400), value=st.integers(0, 255))
def test_a_changed_byte_makes_a_batch_or_a_named_fault(place: int, value: int) -> None:
    packed = bytearray(encode_batch(full_batch()))
    packed[place % len(packed)] = value
    with suppress(BatchError):
        assert isinstance(decode_batch(bytes(packed)), Batch)


@pytest.mark.parametrize(
    ("packed", "told"),
    [
        (b"", "a batch has 24"),
        (b"XX" + bytes(40), "no batch"),
        (b"EB\x09" + bytes(40), "version 9"),
        (b"EB\x01\0\xff\0\0\0" + bytes(40), "255 movements do not fit"),
    ],
)
def test_what_is_no_batch_is_told_of(packed: bytes, told: str) -> None:
    with pytest.raises(BatchError, match=told):
        decode_batch(packed)


def test_a_movement_without_an_end_is_refused() -> None:
    movements = np.array([(7, 2, 41, np.inf, 1.0)], dtype=MOVEMENT)
    with pytest.raises(BatchError, match="not finite"):
        decode_batch(encode_batch(Batch("east", 1, 1, movements)))


def test_answers_come_out_as_they_were_in_messages_of_bounded_size() -> None:
    answers = [Answer(k, 1, bytes(MOST_BYTES // 3)) for k in range(7)] + [Answer(9, 2, b"")]
    messages = encode_answers("yard", answers)
    assert len(messages) > 2
    assert max(map(len, messages)) < 1024 * 1024
    read = [decode_answers(message) for message in messages]
    assert {zone for zone, _ in read} == {"yard"}
    assert [answer for _, part in read for answer in part] == answers
    assert encode_answers("yard", []) == []


@pytest.mark.parametrize("packed", [b"", b"\xc1", msgpack.packb([2, "yard", []]), b"\x93\x01"])
def test_what_is_no_answer_is_told_of(packed: bytes) -> None:
    with pytest.raises(AnswerError):
        decode_answers(packed)
