import pytest
from websockets.frames import Frame, Opcode
from websockets.streams import StreamReader

from esplanade.protocol import VERSION, ByeCode, Kind, decode_server
from esplanade.protocol.messages import Bye, Enter, Entity, Leave, Snapshot, StepBlock, Welcome
from esplanade.server.net import frames
from tests.server.worlds import ROOM


def payload_of(frame: bytes) -> bytes:
    """The payload that the library, as a client, reads from a frame."""
    reader = StreamReader()
    reader.feed_data(frame)
    parser = Frame.parse(reader.read_exact, mask=False, max_size=None)
    try:
        next(parser)
    except StopIteration as done:
        parsed: Frame = done.value
    assert parsed.opcode is Opcode.BINARY
    assert parsed.fin
    return bytes(parsed.data)


@pytest.mark.parametrize("size", [0, 1, 125, 126, 127, 65535, 65536, 100_000])
def test_every_length_is_framed_as_the_library_reads_it(size: int) -> None:
    payload = bytes(range(256)) * (size // 256 + 1)
    assert payload_of(frames.frame(payload[:size])) == payload[:size]


def test_a_snapshot_is_what_the_protocol_says() -> None:
    block = memoryview(bytes(24))
    frame = frames.snapshot(7, 3, block)
    assert decode_server(payload_of(frame)) == Snapshot(tick=7, ack=3, block=bytes(24))


def test_steps_are_what_the_protocol_says() -> None:
    block = memoryview(bytes(228))
    assert decode_server(payload_of(frames.steps(7, block))) == StepBlock(tick=7, block=bytes(228))


def test_hand_packed_messages_are_the_models_messages() -> None:
    entities = [
        Entity(
            id=k,
            kind=Kind.ACTOR,
            name=f"é{k}",
            layer=0,
            x=1.5,
            y=2.0,
            z=0.0,
            heading=0.5,
            radius=0.25,
            leg_m=0.9,
            stature_m=1.72,
            points_at=(1.0, 2.0, 3.0) if k % 2 else None,
        )
        for k in range(40)
    ]
    packed = [frames.entity(entity.model_dump(mode="json")) for entity in entities]
    enter = frames.enter(9, packed)
    assert decode_server(payload_of(enter)) == Enter(tick=9, entities=entities)
    assert enter == frames.message(Enter(tick=9, entities=entities))
    assert frames.leave(9, [1, 2]) == frames.message(Leave(tick=9, ids=[1, 2]))


def test_a_welcome_carries_the_scene_that_was_packed_once() -> None:
    scene = ROOM.model_dump(mode="json")
    welcome = Welcome(
        version=VERSION,
        id=5,
        name="Ann",
        resume="token",
        resumed=False,
        scene=scene,
        tick=1,
        tick_rate=20,
        server_time=0.05,
        resume_seconds=30.0,
        radius=0.25,
        clearance=0.25,
        body_height=1.8,
        step_height=0.6,
        max_speed=3.0,
        walk_speed=1.4,
        origin=(0.0, 0.0),
        doors={"gate": True},
        operator=False,
    )
    frame = frames.Welcomes(scene).frame(welcome.model_copy(update={"scene": {}}))
    assert decode_server(payload_of(frame)) == welcome


def test_any_other_message_is_framed_as_it_is() -> None:
    bye = Bye(reason=ByeCode.SHUTDOWN, text="good night")
    assert decode_server(payload_of(frames.message(bye))) == bye
