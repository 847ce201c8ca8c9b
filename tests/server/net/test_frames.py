import msgpack
import pytest
from websockets.frames import Frame, Opcode
from websockets.streams import StreamReader

from esplanade.protocol import VERSION, ByeCode, Kind, decode_server, entities
from esplanade.protocol.messages import Bye, Enter, Entity, Leave, Welcome
from esplanade.server.net import frames
from esplanade.server.net.welcomes import with_scene
from tests.server.worlds import ROOM


def payloads_of(written: bytes) -> list[bytes]:
    """The payloads that the library, as a client, reads from frames one after the other."""
    reader = StreamReader()
    reader.feed_data(written)
    reader.feed_eof()
    payloads = []
    while reader.buffer:
        parser = Frame.parse(reader.read_exact, mask=False, max_size=None)
        try:
            next(parser)
        except StopIteration as done:
            parsed: Frame = done.value
        assert parsed.opcode is Opcode.BINARY
        assert parsed.fin
        payloads.append(bytes(parsed.data))
    return payloads


def payload_of(frame: bytes) -> bytes:
    """The payload that the library, as a client, reads from a frame."""
    (payload,) = payloads_of(frame)
    return payload


@pytest.mark.parametrize("size", [0, 1, 125, 126, 127, 65535, 65536, 100_000])
def test_every_length_is_framed_as_the_library_reads_it(size: int) -> None:
    payload = bytes(range(256)) * (size // 256 + 1)
    assert payload_of(frames.frame(payload[:size])) == payload[:size]


def packed_entity(entity: Entity) -> bytes:
    constants = entities.Entity(
        entity.id, entity.kind, entity.name, entity.radius, entity.leg_m, entity.stature_m
    )
    return entities.pack_entity(
        entities.pack_constants(constants),
        entity.layer,
        (entity.x, entity.y, entity.z),
        entity.heading,
        entity.points_at,
    )


def test_hand_packed_messages_are_the_models_messages() -> None:
    everyone = [
        Entity(
            id=k,
            kind=Kind.ACTOR,
            name=f"é{k}",
            layer=k * 6,
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
    packed = [packed_entity(entity) for entity in everyone]
    enter = frames.enter(9, packed)
    assert decode_server(payload_of(enter)) == Enter(tick=9, entities=everyone)
    assert enter == frames.message(Enter(tick=9, entities=everyone))
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
    frame = with_scene(welcome.model_copy(update={"scene": {}}), msgpack.packb(scene))
    assert decode_server(payload_of(frame)) == welcome


def test_any_other_message_is_framed_as_it_is() -> None:
    bye = Bye(reason=ByeCode.SHUTDOWN, text="good night")
    assert decode_server(payload_of(frames.message(bye))) == bye
