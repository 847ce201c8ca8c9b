"""Frames are cut into parts, and only whole ones come out again."""

from itertools import chain

import hypothesis.strategies as st
import pytest
from hypothesis import given

from esplanade.server.link import frame_parts
from esplanade.server.link.frame_parts import Assembly, FrameError, FrameKey, parts_of

SMALL = 8


@pytest.fixture(autouse=True)
def small_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(frame_parts, "PART_BYTES", SMALL)


bodies = st.lists(st.binary(max_size=5 * SMALL), min_size=1, max_size=6)


def messages_of(bodies_of_ticks: list[bytes]) -> list[bytes]:
    ticks = enumerate(bodies_of_ticks)
    return list(chain(*(parts_of(FrameKey(9, tick, tick == 0), body) for tick, body in ticks)))


@given(bodies)
def test_what_is_cut_comes_together(told: list[bytes]) -> None:
    assembly = Assembly()
    came = [frame for frame in map(assembly.take, messages_of(told)) if frame is not None]
    assert [body for _, body in came] == told
    assert [key for key, _ in came] == [FrameKey(9, k, k == 0) for k in range(len(told))]


@given(bodies, st.data())
def test_lost_doubled_and_late_parts_make_no_wrong_frame(
    told: list[bytes], data: st.DataObject
) -> None:
    assembly, messages = Assembly(), messages_of(told)
    came = data.draw(st.lists(st.sampled_from(messages), max_size=20))
    for frame in map(assembly.take, came):
        if frame is not None:
            key, body = frame
            assert body == told[key.tick]
            assert key.is_whole == (key.tick == 0)


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda part: part[:10], "at least 20 bytes, not 10"),
        (lambda part: b"XX" + part[2:], "no part of a frame"),
        (lambda part: part[:2] + b"\x07" + part[3:], "version 7, and this program reads 1"),
        (lambda part: part[:16] + b"\x05\x00\x05\x00" + part[20:], "part 5 of 5"),
        (lambda part: part + bytes(SMALL), "cannot be"),
    ],
)
def test_what_is_no_part_is_refused_and_loses_nothing(spoil: object, message: str) -> None:
    first, second = parts_of(FrameKey(9, 4), bytes(range(SMALL + 3)))
    assembly = Assembly()
    assert assembly.take(first) is None
    with pytest.raises(FrameError, match=message):
        assembly.take(spoil(second))  # type: ignore[operator]
    assert assembly.take(second) == (FrameKey(9, 4), bytes(range(SMALL + 3)))


def test_a_frame_that_is_too_large_is_not_cut() -> None:
    with pytest.raises(FrameError, match="more than 64 parts"):
        list(parts_of(FrameKey(1, 1), bytes(64 * SMALL + 1)))
