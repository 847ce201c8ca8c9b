"""The fixed order of a tick, and how long each of its stages took."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final

STAGES: Final = ("drain", "people", "actors", "contacts", "steps", "interest", "encode")
"""The stages of a tick in their order. The zone's are up to `steps`, and quantising in `encode`;
the audience's are `interest` and `encode`; the ticker adds `write` at the end."""


class StageTimes:
    """Seconds that the stages of the latest tick took. They are for metrics only.

    The clock comes from outside: a world has no wall clock of its own.
    """

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self.seconds: dict[str, float] = {}

    def begin(self) -> None:
        """A new tick begins."""
        self.seconds = {}

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Add the time that passes within to that stage."""
        start = self._clock()
        try:
            yield
        finally:
            self.seconds[name] = self.seconds.get(name, 0.0) + self._clock() - start
