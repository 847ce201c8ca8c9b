"""The format of the server's log: structlog, with the libraries' own lines in the same form."""

import logging
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from io import UnsupportedOperation
from typing import Final

import structlog

from esplanade.server.log_writer import LogWriter
from esplanade.server.settings import ServerSettings

_PROCESSORS: Final[list[structlog.typing.Processor]] = []
"""Those that every logger goes by. Loggers hold on to the list of their first line, so that it is
one list for good."""
STDERR: Final = 2
"""The process's standard error, where Python's own is no file."""


@contextmanager
def written(settings: ServerSettings) -> Iterator[LogWriter]:
    """Send all log lines to standard error, for people or as JSON; at the end all are written.

    No thread that logs ever waits for standard error. Lines that nobody reads are given up at the
    end after a bounded time.
    """
    formatter = _formatter(settings)
    writer = LogWriter(_descriptor(), lambda count: _dropped(formatter, count))
    root = logging.getLogger()
    handlers, level = root.handlers, root.level
    root.handlers = [_Queueing(writer, formatter)]
    root.setLevel(settings.log_level.upper())
    # The library tells of every handshake that a port scanner breaks off.
    logging.getLogger("esplanade.server.websockets").setLevel(logging.ERROR)
    logging.captureWarnings(capture=True)
    try:
        yield writer
    finally:
        writer.close()
        logging.captureWarnings(capture=False)
        root.handlers, root.level = handlers, level


class _Queueing(logging.Handler):
    """Formats a record where it was made, and leaves the line to the writer."""

    def __init__(self, writer: LogWriter, formatter: logging.Formatter) -> None:
        super().__init__()
        self._writer = writer
        self.setFormatter(formatter)

    def emit(self, record: logging.LogRecord) -> None:
        try:
            line = self.format(record)
        except Exception:  # noqa: BLE001 (it must not end whoever logged it)
            line = f"a line of {record.name} cannot be formatted: {record.msg!r:.200}"
        self._writer.put(line)


def _descriptor() -> int:
    try:
        return sys.stderr.fileno()
    except (AttributeError, UnsupportedOperation):
        return STDERR


def _dropped(formatter: logging.Formatter, count: int) -> str:
    text = "%d lines of the log were dropped, because nobody read them in time"
    record = logging.LogRecord(__name__, logging.WARNING, "", 0, text, (count,), None)
    return formatter.format(record)


def _formatter(settings: ServerSettings) -> logging.Formatter:
    shared: list[structlog.typing.Processor] = [
        structlog.stdlib.add_log_level,
        structlog.stdlib.add_logger_name,
        structlog.processors.TimeStamper(fmt="iso", utc=True),
    ]
    renderer: structlog.typing.Processor
    if settings.log_format == "json":
        shared.append(structlog.processors.format_exc_info)
        renderer = structlog.processors.JSONRenderer()
    else:
        renderer = structlog.dev.ConsoleRenderer(
            colors=os.isatty(_descriptor()),
            pad_event_to=0,
            # The richer ones print local variables, resume tokens among them.
            exception_formatter=structlog.dev.plain_traceback,
        )
    _PROCESSORS[:] = [*shared, structlog.stdlib.ProcessorFormatter.wrap_for_formatter]
    structlog.configure(
        processors=_PROCESSORS,
        wrapper_class=structlog.stdlib.BoundLogger,
        logger_factory=structlog.stdlib.LoggerFactory(),
        cache_logger_on_first_use=True,
    )
    return structlog.stdlib.ProcessorFormatter(
        foreign_pre_chain=shared,
        processors=[structlog.stdlib.ProcessorFormatter.remove_processors_meta, renderer],
    )
