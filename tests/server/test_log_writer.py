"""Lines of the log go to pipes that are read, read late, or never."""

import os
import threading
from collections.abc import Iterator
from contextlib import suppress
from time import monotonic

import pytest

from esplanade.server import log_writer
from esplanade.server.log_writer import CHUNK_BYTES, LogWriter
from tests.patience import PATIENCE_S

Pipe = tuple[int, int]


@pytest.fixture
def pipe() -> Iterator[Pipe]:
    reader, writer = os.pipe()
    yield reader, writer
    for end in (reader, writer):
        with suppress(OSError):
            os.close(end)


def notice(count: int) -> str:
    return f"dropped {count}"


def read_all(reader: int) -> list[str]:
    """Everything up to the end of a pipe that nobody else may write to any more."""
    with os.fdopen(reader, "rb") as stream:
        return stream.read().decode().splitlines()


def end_of(writer: LogWriter, pipe: Pipe) -> None:
    """Let a thread end that was given up, before another file gets the number of its pipe."""
    os.close(pipe[0])
    writer._thread.join(PATIENCE_S)
    assert not writer._thread.is_alive()


def test_every_line_is_written_in_order_before_the_writer_is_closed(pipe: Pipe) -> None:
    reader, end = pipe
    lines = [f"{number} " + "x" * (number % 9000) for number in range(3000)]
    found: list[str] = []
    reading = threading.Thread(target=lambda: found.extend(read_all(reader)))
    reading.start()
    writer = LogWriter(end, notice)
    for line in lines[:1500]:
        writer.put(line)
    while len(writer._lines) > 100:  # more bytes than may wait, but not at once
        pass
    for line in lines[1500:2000]:
        writer.put(line)
    writer.close()
    os.close(end)
    reading.join(PATIENCE_S)
    assert writer.dropped == 0
    assert found == lines[:2000]


def test_lines_that_nobody_reads_are_dropped_and_counted(
    pipe: Pipe, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(log_writer, "MAX_LINES", 50)
    reader, end = pipe
    writer = LogWriter(end, notice)
    for number in range(300):
        writer.put(f"{number} ".ljust(CHUNK_BYTES))
    assert 0 < writer.dropped <= 300 - 50
    dropped = writer.dropped
    found: list[str] = []
    reading = threading.Thread(target=lambda: found.extend(read_all(reader)))
    reading.start()
    writer.close()
    os.close(end)
    reading.join(PATIENCE_S)
    # The lines of the time before are all there, and where others are missing it is told.
    assert [line.split()[0] for line in found[:-1]] == [str(n) for n in range(300 - dropped)]
    assert found[-1] == f"dropped {dropped}"


def test_the_bytes_that_wait_are_bounded(pipe: Pipe, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(log_writer, "MAX_BYTES", 100_000)
    monkeypatch.setattr(log_writer, "STUCK_S", 0.0)
    writer = LogWriter(pipe[1], notice)
    for _ in range(100):
        writer.put("x" * 50_000)
        assert writer._bytes <= 100_000
    assert writer.dropped > 90
    writer.close()
    end_of(writer, pipe)


def test_a_pipe_that_nobody_reads_holds_no_end_up(
    pipe: Pipe, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(log_writer, "STUCK_S", 0.2)
    writer = LogWriter(pipe[1], notice)
    for _ in range(100):
        writer.put("x" * CHUNK_BYTES)
    began = monotonic()
    writer.close()
    assert writer._thread.is_alive()
    assert monotonic() - began < PATIENCE_S
    end_of(writer, pipe)


def test_a_reader_that_is_gone_ends_nothing(pipe: Pipe) -> None:
    reader, end = pipe
    os.close(reader)
    writer = LogWriter(end, notice)
    writer.put("unheard")
    writer.put("unheard too")
    writer.close()
    assert not writer._thread.is_alive()
    assert writer.dropped >= 2


def test_a_pipe_that_does_not_block_loses_nothing(pipe: Pipe) -> None:
    reader, end = pipe
    os.set_blocking(end, False)
    writer = LogWriter(end, notice)
    lines = [str(number).ljust(1000) for number in range(500)]
    for line in lines:
        writer.put(line)
    found: list[str] = []
    reading = threading.Thread(target=lambda: found.extend(read_all(reader)))
    reading.start()
    writer.close()
    os.close(end)
    reading.join(PATIENCE_S)
    assert found == lines
