"""Reads a recording second by second, and names what is wrong with it and where."""

import json
import struct
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from types import TracebackType
from typing import IO, Any, Final, NamedTuple, Self

import zstandard
from mcap.exceptions import EndOfFile, McapError
from mcap.records import Attachment, Channel, Chunk, DataEnd, McapRecord, Message, Metadata
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
    """A file that is open; `seconds` reads it once from its beginning."""

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
        self._first: Chunk | None = None
        try:
            self.head: Head = self._read_head()
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

    def seconds(self) -> Iterator[RecordedSecond]:
        """All seconds in their order, the first of which has a state.

        Raises
        ------
        ZoneRecordingError
            The file is damaged; the message says where.
        """
        chunk = self._first
        last: int | None = None
        while chunk is not None:
            second = self._second(chunk)
            if last is not None and second.ticks and second.ticks[0].tick != last + 1:
                raise self._fault(f"tick {second.ticks[0].tick} comes after tick {last}")
            if last is None and second.state is None:
                raise self._fault("the state that it begins with is missing")
            last = second.last_tick
            yield second
            chunk = next((each for each in self._records if isinstance(each, Chunk)), None)

    def _close(self) -> None:
        self._file.close()
        self._folder.cleanup()

    def _read(self) -> Iterator[McapRecord]:
        """The records of the file up to the end of its data, or to where it is cut off."""
        reader = StreamReader(self._file, emit_chunks=True, record_size_limit=_MOST_BYTES)
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

    def _read_head(self) -> Head:
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
                self._first = record
                break
        if about is None:
            raise ZoneRecordingError(f"{self.path}: this is no recording of Esplanade")
        if about.get("format") != FORMAT:
            raise ZoneRecordingError(
                f"{self.path}: it is of the format {about.get('format')!r}, and this program reads "
                f"{FORMAT!r}"
            )
        if self._first is None:
            raise ZoneRecordingError(f"{self.path}: there is nothing in it but its head")
        try:
            return read_head(about, files, Path(self._folder.name))
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
