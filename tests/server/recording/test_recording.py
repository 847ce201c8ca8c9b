"""A recording is a file that others can read, says nothing of people, and costs no tick."""

import json
import resource
import threading
from collections import Counter
from pathlib import Path
from typing import Any, get_args

import pytest
from mcap.reader import make_reader
from mcap.stream_reader import StreamReader

from esplanade.planning import Scene
from esplanade.recordings.writing import WritingError
from esplanade.server.recording import file as module
from esplanade.server.recording.digests import differences, digests
from esplanade.server.recording.errors import ZoneRecordingError
from esplanade.server.recording.head import Built, Head, read_head
from esplanade.server.recording.reader import Recording
from esplanade.server.recording.zone_recording import MOST_SECONDS, ZoneRecording
from esplanade.server.world.inputs import (
    ActorsDerived,
    Batch,
    DoorDerived,
    Input,
    PotentialDerived,
    SetParameters,
    SteerMany,
)
from esplanade.server.world.recorded_inputs import AS_THEY_ARE, IN_OTHER_WORDS
from tests.patience import PATIENCE_S
from tests.server.recording.recorded import hall, inputs_in, record


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("recordings") / "hall.mcap"
    assert record(path) == []
    return path


def messages(path: Path) -> dict[str, list[Any]]:
    found: dict[str, list[Any]] = {}
    with path.open("rb") as file:
        for _, channel, message in make_reader(file, validate_crcs=True).iter_messages():
            is_json = channel.message_encoding == "json"
            told = json.loads(message.data) if is_json else message.data
            found.setdefault(channel.topic, []).append(told)
    return found


def test_every_channel_has_its_schema_and_every_checksum_is_right(recording: Path) -> None:
    with recording.open("rb") as file:
        records = list(StreamReader(file, validate_crcs=True).records)
    kinds = Counter(type(each).__name__ for each in records)
    assert kinds["Attachment"] == 2
    with recording.open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    topics = {each.topic: summary.schemas[each.schema_id] for each in summary.channels.values()}
    assert set(topics) == {"inputs", "digests", "checkpoints", "commands", "events"}
    described = json.loads(topics["inputs"].data)
    kinds_of_inputs = described["properties"]["inputs"]["items"]["items"]["anyOf"]
    assert {"join", "steer_many", "actors_derived"} <= {each["title"] for each in kinds_of_inputs}


def test_it_has_inputs_commands_events_digests_and_states(recording: Path) -> None:
    found = messages(recording)
    ticks = [second["tick"] for second in found["inputs"]]
    assert ticks[0] == 2
    assert [len(second["inputs"]) for second in found["inputs"]][1:-1] == [20] * (len(ticks) - 2)
    (command,) = found["commands"]
    assert command["command"]["values"] == {"radius_m": 0.4, "speed_mps": 1.0}
    assert command["fault"] is None
    kinds = Counter(event["kind"] for event in found["events"])
    assert (kinds["join"], kinds["door"]) == (2, 2)
    assert len(found["digests"]) == len(ticks) + 1
    assert len(found["checkpoints"]) == 2


def test_names_are_hidden_and_chat_is_left_out_unless_asked_for(
    recording: Path, tmp_path: Path
) -> None:
    def said(path: Path) -> tuple[str, list[Any]]:
        found = messages(path)
        given = [tick for second in found["inputs"] for tick in second["inputs"]]
        text = json.dumps(found["inputs"]) + b"".join(found["checkpoints"]).decode("latin-1")
        return text, inputs_in(given, "say")

    text, lines = said(recording)
    assert "Narcissus" not in text
    assert "Echo" not in text
    assert "Person 4" in text
    assert lines == []
    named = tmp_path / "named.mcap"
    record(named, names=True, chat=True)
    text, lines = said(named)
    assert "Ann Narcissus" in text
    assert [line["text"] for line in lines] == ["a secret of Ann's"]
    # Digests do not depend on either.
    assert messages(named)["digests"] == messages(recording)["digests"]


def test_a_full_disk_ends_the_recording_and_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "hall.mcap"
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, hard))
    try:
        (fault,) = record(path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert fault.code == "unwritable"
    assert "File too large" in fault.text
    with Recording(path) as cut:
        seconds = list(cut.seconds())
    assert seconds
    assert cut.is_cut


def test_a_slow_disk_ends_the_recording_before_anything_is_kept_for_long(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    taken, go_on = threading.Event(), threading.Event()
    write = module.RecordingFile.write

    def slow(self: module.RecordingFile, second: Any) -> None:
        taken.set()
        go_on.wait(PATIENCE_S)
        write(self, second)

    monkeypatch.setattr(module.RecordingFile, "write", slow)
    world, faults = hall(), list[Any]()
    head = Head.of(world.zone, Built.of(world.zone, "hall", 3, 0.25))
    recording = ZoneRecording(world.zone, head, tmp_path / "a.mcap", faults.append)
    recording.take(world.frame(), [])
    assert taken.wait(PATIENCE_S)
    ticks = 1
    while not faults and ticks < 20 * (MOST_SECONDS + 5):
        recording.take(world.frame(), [])
        ticks += 1
        assert recording.waiting <= MOST_SECONDS
    assert [fault.code for fault in faults] == ["too_slow"]
    go_on.set()
    recording.close()
    world.population.close()


def test_no_recording_is_written_over(recording: Path) -> None:
    size = recording.stat().st_size
    world = hall()
    head = Head.of(world.zone, Built.of(world.zone, "hall", 3, 0.25))
    with pytest.raises(WritingError, match="File exists"):
        ZoneRecording(world.zone, head, recording, print)
    world.population.close()
    assert recording.stat().st_size == size


def test_every_input_has_a_kind() -> None:
    def kinds(of: Any) -> set[Any]:
        inner = get_args(of)
        return set().union(*map(kinds, inner)) if inner else {of}

    derived = {DoorDerived, PotentialDerived, ActorsDerived, SteerMany, SetParameters, Batch}
    assert kinds(Input) == derived | set(AS_THEY_ARE.values())
    assert len(IN_OTHER_WORDS) == len(derived)


def test_digests_name_parts_and_differences_name_fields() -> None:
    world = hall()
    world.frames(3)
    one = world.zone.save_exactly()
    world.frames(1)
    two = world.zone.save_exactly()
    parts = {name for name, value in digests(one).items() if digests(two)[name] != value}
    assert {"zone", "avatars", "actors"} <= parts
    assert "doors" not in parts
    assert "avatars.positions" in differences(one, two)
    assert digests({**one, "names": {1: "Ann"}}) == digests(one)
    world.population.close()


def test_a_mesh_comes_along_and_is_written_nowhere_but_into_its_folder(tmp_path: Path) -> None:
    world = hall()
    built = Built.of(world.zone, "hall", 3, 0.25)
    world.population.close()
    scene = Scene(bounds=(0.0, 0.0, 4.0, 4.0), mesh=Path("hall.obj"))
    files = Head({}, built, scene, (".obj", b"v 0 0 0")).attachments()
    folder = tmp_path / "read"
    (folder / "mesh").mkdir(parents=True)
    head = read_head({}, files, folder)
    assert head.scene.mesh == folder / "mesh.obj"
    assert head.scene.mesh.read_bytes() == b"v 0 0 0"
    mesh = files.pop("mesh.obj")
    outside = {**files, "mesh/../../out.obj": mesh}
    with pytest.raises(ZoneRecordingError, match=r"mesh\.obj is missing"):
        read_head({}, outside, folder)
    assert sorted(each.name for each in tmp_path.rglob("*")) == ["mesh", "mesh.obj", "read"]
