"""Everyone's feet: they follow the bodies in the world with real steps."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Final

import numpy as np
import structlog

from esplanade.actors.locomotion.body.traits import WalkerTraits, traits_of
from esplanade.actors.locomotion.footsteps.course import AHEAD, Course
from esplanade.actors.locomotion.footsteps.ground import Ground
from esplanade.actors.locomotion.footsteps.walkers import Walkers
from esplanade.actors.locomotion.motion.key_poses import Steps
from esplanade.server.world.latest_steps import LatestSteps
from esplanade.server.world.state import Slots, State
from esplanade.server.world.step_records import from_records, to_records

_FEWEST: Final = 0.8
"""Nobody takes fewer steps than these against those of a free walk: legs have an end."""

log = structlog.get_logger(__name__)


class Feet:
    """Begins the steps of a tick, and keeps the latest step of everyone as it is sent."""

    def __init__(
        self, state: State, latest: LatestSteps, ground: Ground, tick_s: float, seed: int
    ) -> None:
        self._state = state
        self._latest = latest
        self._seed = seed
        self._tick = 0
        self._failed = -1
        self._arrivals = np.zeros(state.capacity, dtype=np.int64)
        self._scales = np.ones(state.capacity)
        self._cadences = np.ones(state.capacity)
        _warm_up(ground, tick_s)
        self._walkers = Walkers(state.capacity, ground, tick_s, self._publish)
        self.begun = 0
        """Number of steps so far, those included that were only re-aimed."""
        self.failures = 0
        """Number of ticks in which no steps could be found."""

    @property
    def lost(self) -> int:
        """Number of times that a body was too far from its feet and stood anew."""
        return self._walkers.lost

    def update(self, tick: int) -> None:
        """Begin and re-aim steps after where everyone is and is going; newcomers stand.

        Whoever has grown or shrunk stands anew, too.
        It reads the state and writes the latest steps, and newcomers' legs and statures. Any thread
        may call it while nobody changes the state; most of the time it holds no interpreter lock.
        """
        self._update(tick, still=False)

    def stand_newcomers(self, tick: int) -> None:
        """The same in a tick in which nobody moves: newcomers stand, and no step begins."""
        self._update(tick, still=True)

    def save(self) -> dict[str, Any]:
        """Everyone's feet but their steps, which follow from the records that were sent of them.

        They are copies of arrays in the order of the live slots.
        """
        live = self._state.live()
        return {
            "arrivals": self._arrivals[live],
            "scales": self._scales[live],
            "cadences": self._cadences[live],
            "walkers": self._walkers.save(live),
            "failed": self._failed,
        }

    def load(self, saved: Mapping[str, Any]) -> None:
        """Give everyone who is in the state the feet that were saved; their steps are known.

        Raises
        ------
        ValueError, KeyError, TypeError
            It is not what `save` of these avatars gives.
        """
        live = self._state.live()
        self._arrivals[:], self._scales[:] = 0, 1.0
        self._arrivals[live], self._scales[live] = saved["arrivals"], saved["scales"]
        self._cadences[live] = saved["cadences"]
        steps = from_records(self._latest.records[live])
        self._walkers.load(live, saved["walkers"], steps)
        self._failed = int(saved["failed"])

    def _update(self, tick: int, *, still: bool) -> None:
        self._tick = tick
        state = self._state
        live = state.live()
        new = live[
            (self._arrivals[live] != state.arrivals[live])
            | (self._scales[live] != state.scales[live])
        ]
        of_new = zip(state.ids[new].tolist(), state.scales[new].tolist(), strict=True)
        traits = [scaled(traits_of(self._seed, avatar), scale) for avatar, scale in of_new]
        state.legs_m[new] = [each.leg_m for each in traits]
        state.statures_m[new] = [each.stature_m for each in traits]
        self._cadences[new] = [each.cadence_factor for each in traits]
        try:
            if len(new):
                self._walkers.join(tick, new, traits, self._course(new))
                self._arrivals[new], self._scales[new] = state.arrivals[new], state.scales[new]
            cadences = np.maximum(self._cadences[live] / state.strides[live], _FEWEST)
            self._walkers.set_cadences(live, cadences)
            if not still:
                self._walkers.update(tick, live, self._course(live))
        except Exception:
            # In the next tick everyone stands anew; meanwhile the world goes on.
            if self._failed != tick - 1:
                log.exception("no steps found", tick=tick)
            self._failed = tick
            self.failures += 1
            self._arrivals[:] = 0

    def _course(self, slots: Slots) -> Course:
        return Course(self._state.headings[slots], self._state.ahead[slots])

    def _publish(self, steps: Steps, slots: Slots) -> Steps:
        records = to_records(steps, self._state.ids[slots])
        self._latest.begin(slots, records, self._tick)
        self.begun += len(slots)
        return from_records(records)


def scaled(traits: WalkerTraits, scale: float) -> WalkerTraits:
    """The traits of a body that is so many times as tall."""
    if scale == 1.0:
        return traits
    return replace(traits, leg_m=traits.leg_m * scale, stature_m=traits.stature_m * scale)


def _warm_up(ground: Ground, tick_s: float) -> None:
    """Compile what a tick would have to wait for, by a body that walks, turns and stops."""
    one = Walkers(1, ground, tick_s, lambda steps, _: steps)
    slots, ahead = np.zeros(1, dtype=np.int64), np.zeros((1, AHEAD, 3))
    one.join(0, slots, [traits_of(0, 0)], Course(np.zeros(1), ahead))
    ahead[0, :, 0] = np.linspace(0.0, 1.0, AHEAD)
    for tick in range(1, 12):
        one.update(tick, slots, Course(np.zeros(1), ahead if tick < 5 else -ahead))
