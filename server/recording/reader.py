"""Reads a recording second by second, and names what is wrong with it and where."""

import json
import struct
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from tempfile import TemporaryDirectory
from types import TracebackType
from typing import IO, Any, Final, NamedTuple, Self

import zstandard
from mcap.exceptions import EndOfFile, McapError
from mcap.reader import SeekingReader
from mcap.records import (
    Attachment,
    Channel,
    Chunk,
    ChunkIndex,
    DataEnd,
    McapRecord,
    Message,
    Metadata,
)
from mcap.stream_reader import CRCValidationError, StreamReader, breakup_chunk

from esplanade.server.checkpoint.errors import CheckpointError
from esplanade.server.checkpoint.format import digest, parts_of
from esplanade.server.recording.container import ABOUT, CHECKPOINTS, DIGESTS, INPUTS
from esplanade.server.recording.errors import ZoneRecordingError
from esplanade.server.recording.head import FORMAT, Head, digest_name, read_head

_MOST_BYTES: Final = 2**30
"""A record that says it is larger is taken for damage."""


class RecordedTick(NamedTuple):
    """A tick of a recording."""

    tick: int
    inputs: list[dict[str, Any]]
    check: int


@dataclass
class RecordedSecond:
    """Ticks of a recording, and all that it knows of the state after the last of them."""

    ticks: list[RecordedTick] = field(default_factory=list)
    last_tick: int = 0
    digests: dict[str, str] | None = None
    state: dict[str, Any] | None = None
    """The exact state, in one of ten seconds."""


class Recording:
    """A file that is open; `seconds` reads it once, from its beginning or a state in it."""

    def __init__(self, path: Path) -> None:
        """Open the file and read its head.

        Raises
        ------
        ZoneRecordingError
            It cannot be read, is no recording, or its head is damaged.
        """
        self.path = path
        try:
            self._file: IO[bytes] = path.open("rb")
        except OSError as error:
            raise ZoneRecordingError(f"{path}: {error.strerror or error}") from None
        self._folder = TemporaryDirectory(prefix="esplanade-")
        self.is_cut = False
        """Whether the file is cut off: the server did not end in good order."""
        self._size = path.stat().st_size
        self._topics: dict[int, str] = {}
        self._records = self._read()
        try:
            self.head, self._first = self._read_head()
        except ZoneRecordingError:
            self._close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._close()

    @property
    def share_read(self) -> float:
        """The share of the file that was read so far."""
        return self._file.tell() / max(1, self._size)

    @cached_property
    def first_tick(self) -> int:
        """The tick after which the recording begins.

        Raises
        ------
        ZoneRecordingError
            That second is damaged.
        """
        return self._second(self._first).last_tick

    @cached_property
    def last_tick(self) -> int | None:
        """The last tick, by the index of the file; None where that is cut off."""
        return None if self._index is None else self._tick_at(self._index[-1].message_end_time)

    def seconds(self, from_tick: int = 0) -> Iterator[RecordedSecond]:
        """All seconds in their order, from the latest state that is not after a tick.

        The first one has that state, and no ticks: they are what led to it. The index of the file
        says where it is; a file that is cut off has none, and is read from its beginning.

        Raises
        ------
        ZoneRecordingError
            The file is damaged; the message says where.
        """
        waiting: RecordedSecond | None = None
        later: list[RecordedSecond] = []
        for second in self._all(self._nearest(from_tick)):
            if second.last_tick <= from_tick and second.state is not None:
                waiting, later = second, []
            elif waiting is not None and second.last_tick <= from_tick:
                later.append(second)
            else:
                if waiting is not None:
                    yield replace(waiting, ticks=[])
                    yield from later
                    waiting, later = None, []
                yield second
        if waiting is not None:
            yield replace(waiting, ticks=[])
            yield from later

    @cached_property
    def _index(self) -> list[ChunkIndex] | None:
        """Where the seconds are, in their order; None where the file is cut off."""
        before = self._file.tell()
        try:
            self._file.seek(0)
            summary = SeekingReader(self._file, record_size_limit=_MOST_BYTES).get_summary()
        except (McapError, struct.error, ValueError, OverflowError, OSError):
            summary = None
        finally:
            self._file.seek(before)
        found = [] if summary is None else summary.chunk_indexes
        return sorted(found, key=lambda each: each.chunk_start_offset) or None

    def _tick_at(self, world_ns: int) -> int:
        return round(world_ns / 1e9 / self.head.built.tick_s)

    def _nearest(self, tick: int) -> Chunk | None:
        """The second with the latest state that is not after a tick, with all that follow it."""
        if tick <= self.first_tick or self._index is None:
            return self._first
        states = {number for number, topic in self._topics.items() if topic == CHECKPOINTS}
        found = [
            each.chunk_start_offset
            for each in self._index
            if states & each.message_index_offsets.keys()
            and self._tick_at(each.message_end_time) <= tick
        ]
        if len(found) <= 1:
            return self._first
        self._file.seek(found[-1])
        self._records = self._read(skip_magic=True)
        return self._next()

    def _next(self) -> Chunk | None:
        return next((each for each in self._records if isinstance(each, Chunk)), None)

    def _all(self, chunk: Chunk | None) -> Iterator[RecordedSecond]:
        last: int | None = None
        while chunk is not None:
            second = self._second(chunk)
            if last is not None and second.ticks and second.ticks[0].tick != last + 1:
                raise self._fault(f"tick {second.ticks[0].tick} comes after tick {last}")
            if last is None and second.state is None:
                raise self._fault("the state that it begins with is missing")
            last = second.last_tick
            yield second
            chunk = self._next()

    def _close(self) -> None:
        self._file.close()
        self._folder.cleanup()

    def _read(self, *, skip_magic: bool = False) -> Iterator[McapRecord]:
        """The records of the file up to the end of its data, or to where it is cut off."""
        reader = StreamReader(
            self._file, skip_magic, emit_chunks=True, record_size_limit=_MOST_BYTES
        )
        records = iter(reader.records)
        while True:
            try:
                record = next(records)
            except (EndOfFile, struct.error, StopIteration):
                self.is_cut = True
                return
            except (McapError, ValueError, OverflowError, MemoryError) as error:
                raise self._fault(str(error)) from None
            if isinstance(record, DataEnd):
                return
            yield record

    def _read_head(self) -> tuple[Head, Chunk]:
        """The head of the recording, and its first second."""
        first: Chunk | None = None
        about: Mapping[str, str] | None = None
        files: dict[str, bytes] = {}
        for record in self._records:
            if isinstance(record, Metadata) and record.name == ABOUT:
                about = record.metadata
            elif isinstance(record, Attachment):
                files[record.name] = record.data
                if about is not None and about.get(digest_name(record.name)) != digest(record.data):
                    raise self._fault(f"the attachment {record.name} is damaged")
            elif isinstance(record, Chunk):
                first = record
                break
        if about is None:
            raise ZoneRecordingError(f"{self.path}: this is no recording of Esplanade")
        if about.get("format") != FORMAT:
            raise ZoneRecordingError(
                f"{self.path}: it is of the format {about.get('format')!r}, and this program reads "
                f"{FORMAT!r}"
            )
        if first is None:
            raise ZoneRecordingError(f"{self.path}: there is nothing in it but its head")
        try:
            return read_head(about, files, Path(self._folder.name)), first
        except ZoneRecordingError as error:
            raise ZoneRecordingError(f"{self.path}: {error}") from None

    def _second(self, chunk: Chunk) -> RecordedSecond:
        try:
            records = breakup_chunk(chunk, validate_crc=True)
        except CRCValidationError:
            raise self._damaged(chunk, "its checksum is another") from None
        except (McapError, zstandard.ZstdError, struct.error, ValueError) as error:
            raise self._damaged(chunk, str(error)) from None
        second = RecordedSecond()
        for record in records:
            if isinstance(record, Channel):
                self._topics[record.id] = record.topic
            elif isinstance(record, Message):
                try:
                    self._add(second, self._topics.get(record.channel_id), record.data)
                except (ValueError, KeyError, TypeError, CheckpointError) as error:
                    raise self._damaged(chunk, f"{type(error).__name__}: {error}") from None
        return second

    def _add(self, second: RecordedSecond, topic: str | None, data: bytes) -> None:
        if topic == INPUTS:
            told = json.loads(data)
            for number, (inputs, check) in enumerate(
                zip(told["inputs"], told["checks"], strict=True)
            ):
                second.ticks.append(RecordedTick(told["tick"] + number, inputs, check))
        elif topic == DIGESTS:
            told = json.loads(data)
            second.last_tick, second.digests = int(told["tick"]), told["parts"]
        elif topic == CHECKPOINTS:
            second.state = parts_of(data)

    def _damaged(self, chunk: Chunk, why: str) -> ZoneRecordingError:
        at_s = chunk.message_start_time / 1e9
        return self._fault(f"the second of the world that ends at {at_s:.2f} s is damaged: {why}")

    def _fault(self, why: str) -> ZoneRecordingError:
        return ZoneRecordingError(f"{self.path}: {why}")
