"""Brakes on operators: so many commands a minute, and so many a second, for each account."""

import math
from collections import OrderedDict, deque
from collections.abc import Callable, Sequence
from time import monotonic
from typing import Final

from esplanade.protocol.commands import Command
from esplanade.server.accounts.identity import Identity
from esplanade.server.console.refusals import RefusedError

MINUTE_S: Final = 60.0
AT_ONCE: Final = 12
"""Within a second there may be the twelfth part of what there may be in a minute."""
CHECKS: Final = 20
"""Dry runs, and values of a slider that is dragged, within a second, at least."""
STREAM_GAP_S: Final = 2.0
"""Values of a slider that come within this time of each other count as one command."""
REMEMBERED: Final = 1024
"""Accounts whose latest commands are remembered; the one that was quiet longest goes first."""


class Window:
    """The times of the latest takes, `most` of them within `seconds`."""

    __slots__ = ("_seconds", "_times")

    def __init__(self, most: int, seconds: float) -> None:
        self._times: deque[float] = deque(maxlen=most)
        self._seconds = seconds

    def wait_s(self, now_s: float) -> float:
        """The time until there is room for one more."""
        full = len(self._times) == self._times.maxlen
        return max(0.0, self._times[0] + self._seconds - now_s) if full else 0.0

    def take(self, now_s: float) -> None:
        self._times.append(now_s)


class _Account:
    def __init__(self, a_minute: int) -> None:
        a_second = max(1, a_minute // AT_ONCE)
        self.commands = Window(a_minute, MINUTE_S), Window(a_second, 1.0)
        self.checks = (Window(max(CHECKS, a_second), 1.0),)
        self.stream: tuple[object, ...] = ()
        self.stream_s = -math.inf


class Brakes:
    """Counts commands by account. It is to be called from one thread.

    A list counts as one command, since it is one change in one tick. Dry runs count apart, as does
    a slider that is dragged, but for its first value.
    """

    def __init__(self, a_minute: int, clock_s: Callable[[], float] = monotonic) -> None:
        self._a_minute = a_minute
        self._clock_s = clock_s
        self._accounts: OrderedDict[str | None, _Account] = OrderedDict()
        self.refused = 0
        """Commands, or lists of them, that came too soon."""

    def take(self, by: Identity, commands: Sequence[Command]) -> None:
        """Count commands that are about to be carried out.

        Raises
        ------
        RefusedError
            They come too soon; nothing is counted.
        """
        now_s = self._clock_s()
        account = self._accounts.setdefault(by.account, _Account(self._a_minute))
        self._accounts.move_to_end(by.account)
        if len(self._accounts) > REMEMBERED:
            self._accounts.popitem(last=False)
        stream = _stream_of(commands)
        goes_on = stream == account.stream and now_s - account.stream_s <= STREAM_GAP_S
        light = commands[0].dry_run or (stream is not None and goes_on)
        windows = account.checks if light else account.commands
        wait_s = max(window.wait_s(now_s) for window in windows)
        if wait_s > 0.0:
            self.refused += 1
            seconds = math.ceil(wait_s)
            text = f"you send commands too fast; try again in {seconds} s"
            raise RefusedError.of("too_many", text, seconds=seconds)
        for window in windows:
            window.take(now_s)
        if stream is not None:
            account.stream, account.stream_s = stream, now_s


def _stream_of(commands: Sequence[Command]) -> tuple[object, ...] | None:
    """The parameters that a dragged slider changes; None for other commands."""
    command = commands[0]
    if len(commands) > 1 or command.dry_run or not getattr(command, "stream", False):
        return None
    return command.op, getattr(command, "scope", None), *sorted(getattr(command, "values", ()))
