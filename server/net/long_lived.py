"""Objects that live for long are kept out of the search for garbage while the world runs.

Python looks through all objects for cycles of garbage now and then. With a thousand people that
holds up a tick by 0.1 s, and finds nothing: what a connection needs lives as long as it does.
"""

import gc
from typing import Final

MANY: Final = 64
"""After so many comings what has come is kept out of the search."""
LEAST_GONE: Final = 64
"""After so many goings, and no fewer than a quarter of those who are there, all is looked through
once: what a connection leaves refers to itself. So no more memory waits than they take."""


class LongLived:
    """Counts comings and goings of the process's clients; the objects of each are some hundreds."""

    def __init__(self) -> None:
        self._came = 0
        self._gone = 0

    def between_ticks(self, came: int, gone: int, people: int) -> None:
        """Note how many came and went in a tick, and how many people are there."""
        self._came += came
        self._gone += gone
        if self._gone >= max(LEAST_GONE, people // 4):
            gc.unfreeze()
            gc.collect()
            self._gone, self._came = 0, MANY
        if self._came >= MANY:
            gc.freeze()
            self._came = 0
