"""Forgets a person in recordings: the files are written anew without the name and the chat."""

import json
import os
import re
import struct
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import compress
from pathlib import Path
from typing import IO, Any, Final

from mcap.exceptions import EndOfFile, McapError
from mcap.records import Attachment, Channel, Chunk, DataEnd, McapRecord, Message, Metadata, Schema
from mcap.stream_reader import StreamReader, breakup_chunk

from esplanade.server.checkpoint.format import packed, parts_of
from esplanade.server.live.names import stand_in
from esplanade.server.recording.container import (
    ABOUT,
    CHECKPOINTS,
    EVENTS,
    INPUTS,
    SETTINGS,
    WRITTEN_BY,
    begun_writer,
    end_chunk,
    to_json,
)
from esplanade.server.recording.errors import ZoneRecordingError
from esplanade.server.recording.folder import is_being_written, recordings_in

NAMES: Final = "names"
"""The part of a state with the names of avatars, as in `esplanade.server.world.exact_state`."""
NAMELESS: Final = "Person"
"""The name of somebody who comes in."""


def forget_in_recordings(folder: Path, person: str) -> int:
    """Forget a person in all recordings of a folder; returns how many were written anew.

    The name gives way to a stand-in, what the person said and lines with the name in them are left
    out. Nothing that is computed depends on either, so that the recordings still verify.

    Raises
    ------
    ZoneRecordingError
        A recording is damaged, cannot be written, or is being written just now. Those before it are
        done, and it is as it was.
    """
    return sum(_forget_in(path, person) for path in recordings_in(folder))


@dataclass
class _Person:
    """All that a recording says of a person by a name."""

    name: str
    avatars: set[int] = field(default_factory=set)
    found: bool = False
    """Whether there is anything to forget."""

    def __post_init__(self) -> None:
        self._in_text = re.compile(rf"(?<!\w){re.escape(self.name)}(?!\w)", re.IGNORECASE)

    def learn(self, topics: Mapping[int, str], messages: list[Message]) -> None:
        """Learn from a second which avatars were those of the person."""
        joins: dict[int, list[dict[str, Any]]] = {}
        came: dict[int, list[int]] = {}
        for message in messages:
            topic = topics[message.channel_id]
            if topic == INPUTS:
                told = json.loads(message.data)
                for tick, inputs in enumerate(told["inputs"], start=told["tick"]):
                    joins[tick] = [each for each in inputs if each["kind"] == "join"]
                    self.found |= any(each["name"] == self.name for each in joins[tick])
                    said = [each for each in inputs if each["kind"] == "say"]
                    self.found |= any(self._names(each) for each in said)
            elif topic == EVENTS:
                told = json.loads(message.data)
                if told["kind"] == "join":
                    came.setdefault(told["tick"], []).append(told["who"])
            elif topic == CHECKPOINTS:
                names = parts_of(message.data)[NAMES]
                self.avatars |= {avatar for avatar, name in names.items() if name == self.name}
        for tick, those in joins.items():
            ids, mine = came.get(tick, []), [each["name"] == self.name for each in those]
            if len(ids) == len(those) and all(each["id"] is None for each in those):
                self.avatars |= set(compress(ids, mine))
            elif any(mine):
                # Not all came in, or somebody has come back: anyone of them may be the person.
                self.avatars |= set(ids)

    def without(self, topic: str, data: bytes) -> bytes:
        """A message that says nothing of the person."""
        if topic == CHECKPOINTS:
            state = parts_of(data)
            names = {
                avatar: stand_in(avatar) if name == self.name else name
                for avatar, name in state[NAMES].items()
            }
            return packed({**state, NAMES: names})
        if topic != INPUTS:
            return data
        told = json.loads(data)
        told["inputs"] = [
            [self._hidden(each) for each in inputs if not self._is_line(each)]
            for inputs in told["inputs"]
        ]
        return to_json(told)

    def _hidden(self, item: dict[str, Any]) -> dict[str, Any]:
        if item["kind"] == "join" and item["name"] == self.name:
            return {**item, "name": NAMELESS}
        return item

    def _is_line(self, item: Mapping[str, Any]) -> bool:
        return item["kind"] == "say" and (item["id"] in self.avatars or self._names(item))

    def _names(self, line: Mapping[str, Any]) -> bool:
        return self._in_text.search(line["text"]) is not None


def _forget_in(path: Path, name: str) -> int:
    person = _Person(name)
    try:
        topics: dict[int, str] = {}
        for record in _records(path):
            if isinstance(record, Attachment) and record.name == SETTINGS:
                settings = json.loads(record.data)
                if not (settings["names"] or settings["chat"]):
                    return 0
            elif isinstance(record, Chunk):
                person.learn(topics, _messages(record, topics))
        if not (person.found or person.avatars):
            return 0
        if is_being_written(path):
            raise ZoneRecordingError(f"{path}: it is being written; end the recording first")
        new = path.with_suffix(".rewritten")
        try:
            with new.open("wb") as file:
                _write_anew(path, file, person)
                file.flush()
                os.fsync(file.fileno())
            state = path.stat()
            os.utime(new, ns=(state.st_atime_ns, state.st_mtime_ns))
            new.replace(path)
        finally:
            new.unlink(missing_ok=True)
    except OSError as error:
        raise ZoneRecordingError(f"{path}: {error.strerror or error}") from None
    except (McapError, struct.error, ValueError, KeyError, TypeError, StopIteration) as error:
        raise ZoneRecordingError(f"{path}: {type(error).__name__}: {error}") from None
    return 1


def _write_anew(path: Path, file: IO[bytes], person: _Person) -> None:
    """Write all records of a recording, second by second, without the person."""
    topics: dict[int, str] = {}
    numbers: dict[int, int] = {}
    schemas: dict[int, int] = {}
    records = _records(path)
    about = next(each for each in records if isinstance(each, Metadata) and each.name == ABOUT)
    writer = begun_writer(file, about.metadata[WRITTEN_BY])
    writer.add_metadata(about.name, about.metadata)
    for record in records:
        if isinstance(record, Metadata):
            writer.add_metadata(record.name, record.metadata)
        elif isinstance(record, Attachment):
            writer.add_attachment(0, 0, record.name, record.media_type, record.data)
        elif isinstance(record, Chunk):
            for each in breakup_chunk(record, validate_crc=True):
                if isinstance(each, Schema) and each.id not in schemas:
                    schemas[each.id] = writer.register_schema(each.name, each.encoding, each.data)
                elif isinstance(each, Channel) and each.id not in numbers:
                    topics[each.id] = each.topic
                    numbers[each.id] = writer.register_channel(
                        each.topic, each.message_encoding, schemas[each.schema_id]
                    )
                elif isinstance(each, Message):
                    data = person.without(topics[each.channel_id], each.data)
                    number = numbers[each.channel_id]
                    writer.add_message(number, each.log_time, data, each.publish_time)
            end_chunk(writer)
    writer.finish()  # type: ignore[no-untyped-call]


def _messages(chunk: Chunk, topics: dict[int, str]) -> list[Message]:
    found = []
    for record in breakup_chunk(chunk, validate_crc=True):
        if isinstance(record, Channel):
            topics[record.id] = record.topic
        elif isinstance(record, Message):
            found.append(record)
    return found


def _records(path: Path) -> Iterator[McapRecord]:
    """The records of a file up to the end of its data, or to where it is cut off."""
    with path.open("rb") as file:
        records = iter(StreamReader(file, emit_chunks=True).records)
        while True:
            try:
                record = next(records)
            except (EndOfFile, struct.error, StopIteration):
                return
            if isinstance(record, DataEnd):
                return
            yield record
