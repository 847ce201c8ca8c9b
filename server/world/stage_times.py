"""The fixed order of a tick, and how long each of its stages took."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final

STAGES: Final = ("drain", "people", "actors", "contacts", "steps", "interest", "encode")
"""What a world does in a tick, in this order; whoever runs it adds `write` at the end."""


class StageTimes:
    """Seconds that the stages of the latest tick took. For watching only; nothing reads them back.

    The clock comes from outside: a world has no wall clock of its own.
    """

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self.seconds: dict[str, float] = {}

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        start = self._clock()
        try:
            yield
        finally:
            self.seconds[name] = self._clock() - start
