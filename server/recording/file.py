"""The file of a recording: MCAP, a chunk a second, so that a cut file is whole up to the last."""

from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, Final, Self

from esplanade.recordings.writing import WritingError
from esplanade.server.checkpoint.format import digest, packed
from esplanade.server.recording.channels import channels
from esplanade.server.recording.container import (
    ABOUT,
    CHECKPOINTS,
    COMMANDS,
    DIGESTS,
    EVENTS,
    INPUTS,
    WRITTEN_BY,
    begun_writer,
    end_chunk,
    to_json,
)
from esplanade.server.recording.digests import digests
from esplanade.server.recording.folder import mark_as_written
from esplanade.server.recording.happened import Happened
from esplanade.server.recording.head import Head, digest_name
from esplanade.server.recording.hiding import inputs_of, state_of
from esplanade.server.recording.seconds import Second, Tick, check_of
from esplanade.server.world.inputs import ActorCommand, Batch, Input, OneActorCommand
from esplanade.server.world.recorded_inputs import recorded

CHECKPOINT_EVERY_S: Final = 10
MOST_COMMANDS: Final = 4096
"""Commands whose outcome is not known yet; of more, the oldest is forgotten."""


class RecordingFile:
    """A file that seconds are written to, in one thread."""

    def __init__(self, path: Path, head: Head, before: Self | None = None) -> None:
        """Make the file, and write its head; it may go on where another one ended before.

        Raises
        ------
        WritingError
            It cannot be written, or is there already.
        """
        self.path = path
        self._built = head.built
        self.happened: Happened = Happened() if before is None else before.happened
        self.commands: dict[int, ActorCommand] = {} if before is None else before.commands
        """Those whose outcome is not known yet."""
        self.seconds = 0
        """Seconds that were written."""
        self.size = 0
        """Bytes that were written."""
        try:
            self._file = path.open("xb")
            mark_as_written(self._file)
            self._writer = begun_writer(self._file, head.about[WRITTEN_BY])
            files = head.attachments()
            sums = {digest_name(name): digest(data) for name, data in files.items()}
            self._writer.add_metadata(ABOUT, {**head.about, **sums})
            for name, data in files.items():
                kind = "application/json" if name.endswith(".json") else "application/octet-stream"
                self._writer.add_attachment(0, 0, name, kind, data)
            self._topics = {
                topic: self._writer.register_channel(
                    topic,
                    channel.encoding,
                    self._writer.register_schema(
                        channel.schema,
                        "" if channel.described is None else "jsonschema",
                        b"" if channel.described is None else to_json(channel.described),
                    ),
                )
                for topic, channel in channels().items()
            }
            self._file.flush()
        except OSError as error:
            raise self._fault(error) from None

    def write(self, second: Second) -> None:
        """Write a second, and hand it over to the system.

        Raises
        ------
        WritingError
            The file cannot be written any more.
        """
        hidden = {"names": self._built.names, "chat": self._built.chat}
        if second.ticks:
            plain = [
                [recorded(each) for each in inputs_of(tick, **hidden)] for tick in second.ticks
            ]
            checks = [check_of(tick.frame) for tick in second.ticks]
            first = second.ticks[0].frame.tick
            told = {"tick": first, "inputs": plain, "checks": checks}
            self._add(INPUTS, second, to_json(told))
        for tick in second.ticks:
            self._tell(tick, second)
        parts = digests(second.state)
        self._add(DIGESTS, second, to_json({"tick": second.last_tick, "parts": parts}))
        if self.seconds % CHECKPOINT_EVERY_S == 0:
            state = state_of(second.state, names=self._built.names)
            self._add(CHECKPOINTS, second, packed(state))
        self.seconds += 1
        try:
            end_chunk(self._writer)
            self._file.flush()
            self.size = self._file.tell()
        except OSError as error:
            raise self._fault(error) from None

    def close(self) -> None:
        """Complete the file with its index.

        Raises
        ------
        WritingError
            It cannot be completed; all seconds that were written can be read.
        """
        try:
            self._writer.finish()  # type: ignore[no-untyped-call]
            self._file.flush()
        except OSError as error:
            raise self._fault(error) from None
        finally:
            self.drop()

    def drop(self) -> None:
        """Leave the file as far as it came: there is nothing more to be written into it."""
        with suppress(OSError):
            self._file.close()

    def _tell(self, tick: Tick, second: Second) -> None:
        for event in self.happened.events(tick):
            self._add(EVENTS, second, to_json(event))
        self._remember(tick.inputs)
        for outcome in tick.frame.outcomes:
            command = self.commands.pop(outcome.command, None)
            fault: Mapping[str, Any] | None = None
            if outcome.fault is not None:
                fault = {"code": outcome.fault.code.value, "text": outcome.fault.text}
            told = {
                "tick": tick.frame.tick,
                "number": outcome.command,
                "command": None if command is None else recorded(command),
                "fault": fault,
            }
            self._add(COMMANDS, second, to_json(told))

    def _remember(self, inputs: Iterable[Input]) -> None:
        for item in inputs:
            if isinstance(item, OneActorCommand | Batch):
                self.commands[item.command] = item
        while len(self.commands) > MOST_COMMANDS:
            self.commands.pop(next(iter(self.commands)))

    def _add(self, topic: str, second: Second, data: bytes) -> None:
        world_ns = round(second.last_tick * self._built.tick_s * 1e9)
        self._writer.add_message(self._topics[topic], world_ns, data, second.at_ns)

    def _fault(self, error: OSError) -> WritingError:
        return WritingError(f"{self.path}: {error.strerror or error}")
