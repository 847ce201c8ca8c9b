"""Mutes: people whom nobody hears for a time, by their avatars' ids."""

import math
from collections.abc import Callable, Mapping
from typing import Any, Final

MOST_MUTES: Final = 4096
"""Of more people who are muted, the mute that ends first is forgotten."""


class Mutes:
    """Until when each person is muted. A mute outlives a lost connection."""

    def __init__(self, clock_us: Callable[[], int]) -> None:
        self._clock_us = clock_us
        self._until_us: dict[int, int] = {}

    def left_s(self, person: int) -> float:
        """For how many seconds a person is muted yet."""
        until_us = self._until_us.get(person)
        return 0.0 if until_us is None else max(0.0, (until_us - self._clock_us()) / 1e6)

    def put(self, person: int, seconds: float) -> None:
        """Mute a person for a time; 0 ends it."""
        now_us = self._clock_us()
        self._until_us.pop(person, None)
        if seconds > 0.0:
            held = {who: end for who, end in self._until_us.items() if end > now_us}
            if len(held) >= MOST_MUTES:
                del held[min(held, key=held.__getitem__)]
            self._until_us = {**held, person: now_us + round(seconds * 1e6)}

    def save(self) -> dict[int, float]:
        """For how many seconds each person is muted yet, by the avatar."""
        now_us = self._clock_us()
        return {who: (end - now_us) / 1e6 for who, end in self._until_us.items() if end > now_us}

    def load(self, saved: Mapping[Any, Any]) -> None:
        """Go on from what was saved: time counts only while the world runs.

        Raises
        ------
        ValueError, TypeError
            It is not what `save` gives.
        """
        now_us = self._clock_us()
        if len(saved) > MOST_MUTES or not all(map(math.isfinite, saved.values())):
            raise ValueError("these are no mutes")
        self._until_us = {int(who): now_us + round(left_s * 1e6) for who, left_s in saved.items()}
