"""The fixed order of a tick, and how long each of its stages took."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final

STAGES: Final = ("drain", "people", "actors", "contacts", "steps", "interest", "encode")
"""The stages of a world's tick in their order; the ticker adds `write` at the end."""


class StageTimes:
    """Seconds that the stages of the latest tick took. They are for metrics only.

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
