"""The pace of a world: how fast its time runs, whether it stands, and single ticks meanwhile."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Final

LEAST_FACTOR: Final = 0.1
MOST_FACTOR: Final = 4.0
MOST_STEPS: Final = 100
"""No more ticks are run one after the other in a world that stands."""
MEASURED_S: Final = 2.0
"""The rate that is reached is measured over this time."""
SHORT_OF: Final = 0.9
"""A world whose rate is below this part of its factor does not reach it."""


@dataclass(frozen=True)
class PaceState:
    """The pace at a moment."""

    factor: float
    """Seconds of the world in a second that are wanted while it runs."""
    paused: bool
    rate: float
    """Seconds of the world in a second, as they are: 0 while it stands."""

    @property
    def reached(self) -> bool:
        """Whether the machine keeps up with the factor."""
        return self.paused or self.rate >= SHORT_OF * self.factor


class Pace:
    """Wishes of operators, and what comes of them. Whoever runs the ticks asks it when each is due.

    It changes when ticks are run and never what happens in one, so that a replay need not know it.
    """

    def __init__(self) -> None:
        self.state = PaceState(1.0, paused=False, rate=1.0)
        self.steps = 0
        """Ticks that are still to be run while the world stands."""
        self.stood_s = 0.0
        """Time for which the world has stood so far, seconds."""
        self.changed: list[Callable[[PaceState, float], None]] = []
        """Called after each change, one of the measured rate among them, with the time."""
        self._since: tuple[float, int] | None = None
        self._stands_since: float | None = None

    @property
    def stands(self) -> bool:
        """Whether no tick is due at all."""
        return self.state.paused and not self.steps

    def change(
        self, now: float, *, factor: float | None = None, paused: bool | None = None
    ) -> None:
        """Let the world run at another factor, or stand, or run again."""
        factor = self.state.factor if factor is None else factor
        paused = self.state.paused if paused is None else paused
        if not LEAST_FACTOR <= factor <= MOST_FACTOR:
            raise ValueError(f"the factor must lie in {LEAST_FACTOR} to {MOST_FACTOR}")
        if paused != self.state.paused:
            self.steps = 0
        before, self.state = self.state, PaceState(factor, paused, 0.0 if paused else factor)
        self._since = None
        self._note_standing(now)
        if (before.factor, before.paused) != (factor, paused):
            self._tell(now)

    def step(self, ticks: int) -> None:
        """Run some ticks, beside those that are still to be run, in a world that stands."""
        if not self.state.paused:
            raise ValueError("only a world that is paused goes on tick by tick")
        self.steps = min(MOST_STEPS, self.steps + ticks)

    def ticked(self, now: float, tick: int, tick_s: float) -> None:
        """Count a tick that has just been run, and measure the rate that is reached."""
        if self.state.paused:
            self.steps = max(0, self.steps - 1)
            if not self.steps:
                self._tell(now)
            return
        if self._since is None:
            self._since = now, tick
            return
        since, first = self._since
        if now - since < MEASURED_S:
            return
        rate = min((tick - first) * tick_s / (now - since), self.state.factor)
        if rate >= 0.97 * self.state.factor:
            rate = self.state.factor
        self._since = now, tick
        if abs(rate - self.state.rate) > 0.05 * self.state.factor:
            self.state = replace(self.state, rate=rate)
            self._tell(now)

    def save(self) -> dict[str, Any]:
        """The state that outlives the process."""
        return {"factor": self.state.factor, "paused": self.state.paused}

    def load(self, saved: Mapping[str, Any], now: float) -> None:
        """Go on at the pace that was saved."""
        self.change(now, factor=float(saved["factor"]), paused=bool(saved["paused"]))

    def standing_s(self, now: float) -> float:
        """Time for which the world has stood until now, seconds."""
        since = self._stands_since
        return self.stood_s + (0.0 if since is None else now - since)

    def _note_standing(self, now: float) -> None:
        if self.state.paused and self._stands_since is None:
            self._stands_since = now
        elif not self.state.paused and self._stands_since is not None:
            self.stood_s += now - self._stands_since
            self._stands_since = None

    def _tell(self, now: float) -> None:
        for listener in self.changed:
            listener(self.state, now)
