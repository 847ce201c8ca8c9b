"""A frame that comes whole needs no parser, and nothing comes out of its turn for that."""

import asyncio
import random
from collections.abc import Iterator, Sequence

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from websockets.frames import Frame, Opcode

from esplanade.protocol import encode
from esplanade.protocol.messages import ClientMessage, Move, Ping
from esplanade.server.net.session import Session
from esplanade.server.net.whole_frames import payload_of
from esplanade.server.net.wishes import Wishes
from tests.server.client import joined
from tests.server.conftest import Serving


def framed(opcode: Opcode, payload: bytes, final: bool = True) -> bytes:
    return Frame(opcode, payload, final).serialize(mask=True)


@given(payload=st.binary(max_size=200), final=st.booleans(), opcode=st.sampled_from(Opcode))
def test_only_a_short_whole_binary_frame_is_read(
    payload: bytes, final: bool, opcode: Opcode
) -> None:
    assume(final or opcode in (Opcode.BINARY, Opcode.TEXT, Opcode.CONT))
    chunk = framed(opcode, payload, final)
    read = final and opcode is Opcode.BINARY and len(payload) < 126
    assert payload_of(chunk) == (payload if read else None)


@given(chunk=st.binary(max_size=140), cut=st.integers(1, 10))
def test_no_other_chunk_is_read(chunk: bytes, cut: int) -> None:
    payload = payload_of(chunk)
    assert payload is None or len(payload) == len(chunk) - 6
    assert payload_of(framed(Opcode.BINARY, b"movement")[:-cut]) is None
    assert payload_of(framed(Opcode.BINARY, b"movement") + chunk[:1] * cut) is None or not chunk


def pieces(seed: int, messages: list[bytes]) -> Iterator[bytes]:
    """Chunks of frames: whole, in fragments with a ping between, torn, and several together."""
    chance = random.Random(seed)
    joined_up = b""
    for message in messages:
        way = chance.randrange(5)
        if way == 0:
            cut = chance.randrange(1, len(message))
            frames = framed(Opcode.BINARY, message[:cut], final=False)
            frames += framed(Opcode.PING, b"")
            frames += framed(Opcode.CONT, message[cut:])
        else:
            frames = framed(Opcode.BINARY, message)
        joined_up += frames
        if way == 1:
            continue
        if way == 2:
            cut = chance.randrange(1, len(joined_up))
            yield joined_up[:cut]
            joined_up = joined_up[cut:]
        yield joined_up
        joined_up = b""
    if joined_up:
        yield joined_up


@pytest.mark.parametrize("seed", range(4))
async def test_messages_are_taken_in_their_order_however_they_come(
    serving: Serving, monkeypatch: pytest.MonkeyPatch, seed: int
) -> None:
    taken: list[ClientMessage] = []
    take = Session._take

    def note(session: Session, message: ClientMessage) -> None:
        taken.append(message)
        take(session, message)

    at_once = 0
    take_movement = Session._take_movement

    def count(session: Session, frame: bytes) -> bool:
        nonlocal at_once
        was_taken = take_movement(session, frame)
        at_once += was_taken
        return was_taken

    moved = Wishes.moved

    def note_all(
        wishes: Wishes,
        avatars: Sequence[int],
        numbers: Sequence[int],
        directions: Sequence[float],
        speeds: Sequence[float],
    ) -> None:
        taken.append(Move(seq=numbers[0], direction=directions[0], speed=speeds[0]))
        moved(wishes, avatars, numbers, directions, speeds)

    monkeypatch.setattr(Wishes, "moved", note_all)
    monkeypatch.setattr(Session, "_take", note)
    monkeypatch.setattr(Session, "_take_movement", count)
    sent: list[ClientMessage] = [
        Ping(nonce=k) if k % 7 == 0 else Move(seq=k, direction=0.1 * k, speed=0.5)
        for k in range(60)
    ]
    async with serving(message_rate=1000.0) as server, joined(server.port) as client:
        for chunk in pieces(seed, [encode(message) for message in sent]):
            client.connection.transport.write(chunk)
            await asyncio.sleep(0.0 if len(chunk) % 3 else 0.01)
        await client.wait_for(lambda: taken[-1:] == sent[-1:] and client.ack == 59)
        traffic = server.metrics.traffic
        assert traffic.messages_in == 1 + len(sent)
    missing = [message for message in sent if message not in taken]
    assert taken == [message for message in sent if message in taken]
    # Those that are not told came in one chunk with a later movement.
    assert all(isinstance(message, Move) for message in missing)
    assert len(missing) <= traffic.movements_superseded
    assert at_once > 0


async def test_a_broken_movement_is_refused_as_ever(serving: Serving) -> None:
    broken = encode(Move(seq=1, direction=0.0, speed=1.0)).replace(b"speed", b"spead")
    async with serving() as server, joined(server.port) as client:
        client.connection.transport.write(framed(Opcode.BINARY, broken))
        code, _ = await client.refusal()
        assert code == "invalid"
        assert server.metrics.traffic.messages_in == 2
