"""Recordings of a small world, made tick by tick without a server, and what damages them."""

import io
import json
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import pytest
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

from esplanade.server.file_thread import Ended
from esplanade.server.recording.container import end_chunk
from esplanade.server.recording.head import Built, Head
from esplanade.server.recording.reader import Recording
from esplanade.server.recording.zone_recording import ZoneRecording
from esplanade.server.world.inputs import (
    Follow,
    Input,
    Join,
    MoveDoor,
    PlanEvery,
    Say,
    SetParameters,
    Steer,
    Still,
)
from tests.server.populated import Populated, spec

ROUND = {"stops": ["east", "west"], "pause_s": 0.3}


def hall() -> Populated:
    return Populated([spec(k, "patrol", behaviour=ROUND) for k in range(1, 4)], outside=True)


def script(ann: int) -> dict[int, list[Input]]:
    """What happens in which tick, to the person Ann and the others."""
    return {
        5: [Join(0, "Ann Narcissus", (3.0, 4.0, 0.0)), Join(1, "Ben Echo", None)],
        12: [Steer(ann, 1, 0.3, 1.0), Say(ann, "a secret of Ann's")],
        20: [SetParameters(1, ("main/a1",), {"radius_m": 0.4, "speed_mps": 1.0})],
        30: [MoveDoor("gate", is_open=False)],
        45: [Follow(ann, 2, ((3.0, 4.0, 0.0), (5.0, 2.0, 0.0)))],
        60: [PlanEvery(2)],
        70: [Still()],
        80: [MoveDoor("gate", is_open=True)],
    }


def record(
    path: Path,
    ticks: int = 250,
    *,
    names: bool = False,
    chat: bool = False,
    ends_in_a_tick: bool = False,
) -> list[Ended]:
    """Record a world for so many ticks; returns the faults that ended it early.

    The recording ends between two ticks, or in the middle of the next one.
    """
    faults: list[Ended] = []
    world = hall()
    built = Built.of(world.zone, "hall", 3, 0.25, names=names, chat=chat)
    recording = ZoneRecording(world.zone, Head.of(world.zone, built), path, faults.append)
    at = script(ann=4)
    with pytest.MonkeyPatch.context() as patch:
        # Without the time that work takes there is no rest after it.
        patch.setattr("esplanade.server.net.ground_work.taken_s", lambda: 0.0)
        for tick in range(1, ticks + 1):
            recording.take(world.frame(*at.get(tick, [])), world.inputs[-1])
    if ends_in_a_tick:
        world.zone.begin([Join(2, "Cid", None)])
    recording.close()
    world.population.close()
    return faults


def rewritten(
    path: Path,
    to: Path,
    *,
    message: Callable[[str, Any], Any] = lambda _, told: told,
    keep: Callable[[str], bool] = lambda _: True,
) -> Path:
    """The same recording with other messages of JSON, and with these attachments only, whose
    checksums are all right."""
    data = path.read_bytes()
    reader = make_reader(io.BytesIO(data))
    with to.open("wb") as file:
        writer = Writer(file, 2**40, CompressionType.ZSTD)
        writer.start(profile="esplanade")
        for metadata in reader.iter_metadata():
            writer.add_metadata(metadata.name, metadata.metadata)
        for each in reader.iter_attachments():
            if keep(each.name):
                writer.add_attachment(0, 0, each.name, each.media_type, each.data)
        topics: dict[str, int] = {}
        time = None
        for schema, channel, found in reader.iter_messages(log_time_order=False):
            assert schema is not None
            if time not in (None, found.log_time):
                end_chunk(writer)
            time = found.log_time
            if channel.topic not in topics:
                number = writer.register_schema(schema.name, schema.encoding, schema.data)
                topics[channel.topic] = writer.register_channel(
                    channel.topic, channel.message_encoding, number
                )
            told = found.data
            if channel.message_encoding == "json":
                told = json.dumps(message(channel.topic, json.loads(told))).encode()
            writer.add_message(topics[channel.topic], found.log_time, told, found.publish_time)
        writer.finish()  # type: ignore[no-untyped-call]
    return to


def inputs_of_file(path: Path) -> list[dict[str, Any]]:
    """All inputs in a recording."""
    with Recording(path) as recording:
        return [
            each for second in recording.seconds() for tick in second.ticks for each in tick.inputs
        ]


def inputs_in(told: Iterable[Iterable[dict[str, Any]]], kind: str) -> list[dict[str, Any]]:
    """The inputs of a kind in the inputs of ticks."""
    return [each for inputs in told for each in inputs if each["kind"] == kind]
