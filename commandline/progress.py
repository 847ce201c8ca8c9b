"""Progress of a command that works: bars, or one line that changes."""

import time
from types import TracebackType
from typing import Final, Self

from rich.console import Console
from rich.live import Live
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    TaskProgressColumn,
    TextColumn,
    TimeRemainingColumn,
)
from rich.text import Text

PLAIN_EVERY_S: Final = 5.0

_ESTIMATE_OVER_S: Final = 300.0
"""Some parts take longer than others: the time that is left is estimated over many."""


def progress(*, share: bool = False, time_left: bool = False) -> Progress:
    """A bar on the error output, gone when all is done; with a share of the whole, or a count."""
    columns: list[ProgressColumn] = [
        TextColumn("{task.description}"),
        BarColumn(),
        TaskProgressColumn() if share else MofNCompleteColumn(),
    ]
    if time_left:
        columns.append(TimeRemainingColumn())
    return Progress(
        *columns,
        console=Console(stderr=True),
        transient=True,
        speed_estimate_period=_ESTIMATE_OVER_S,
    )


class StatusLine:
    """Shows the newest line: live on a terminal, else as a plain line every few seconds."""

    def __init__(self, console: Console) -> None:
        self._console = console
        self._live = Live(console=console, auto_refresh=False) if console.is_terminal else None
        self._printed_s = time.monotonic()

    def __enter__(self) -> Self:
        if self._live is not None:
            self._live.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._live is not None:
            self._live.stop()

    def show(self, line: str) -> None:
        now_s = time.monotonic()
        if self._live is not None:
            self._live.update(Text(line), refresh=True)
        elif now_s - self._printed_s >= PLAIN_EVERY_S:
            self._printed_s = now_s
            self._console.print(line, highlight=False, soft_wrap=True)
