"""Recorded people who react to actors, to each other and to walls."""

from collections.abc import Collection, Sequence
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from esplanade.pedestrians.compiled import _step_kernels as kernels
from esplanade.pedestrians.compiled.records import State, Surroundings
from esplanade.pedestrians.model import SocialForce
from esplanade.pedestrians.paths import checked_walls, joined_paths, walls_passed

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

PERSON_RADIUS_M: Final = 0.25
"""The model was fitted to people; wider bodies count as nearer by the difference."""
GREATEST_REACTION: Final = 10.0
_ACTOR_NUMBERS: Final = 5


class ReactingCrowd:
    """A recorded crowd, ready to be walked once more among actors.

    Everyone follows the recorded path at its recorded timing, by a social force model that says
    how far to differ from the recording: a person's acceleration is the recorded one, plus what
    the model's forces are now beyond what they were in the recording. So the recording
    itself stays as it is as long as nobody comes near, bit for bit, and each difference from it is
    the actors' doing, also that of people who make room for people who make room.

    Parameters
    ----------
    trajectories : N arrays (n, 2), metres
        Where each person is at every tick.
    first_ticks : (N,)
        The tick of each person's first place.
    tick_s : seconds
    walls : (M, 4) or (M, 2, 2), metres
        Nobody crosses a wall that the own recorded path does not cross.
    reaction : dimensionless, 0 to `GREATEST_REACTION`
        Scales every evasion; at 0 the crowd is the recording.
    seed :
        Draws each person's strength of evasion.
    """

    def __init__(
        self,
        trajectories: Sequence[ArrayLike],
        first_ticks: Sequence[int],
        tick_s: float,
        *,
        walls: ArrayLike = (),
        model: SocialForce | None = None,
        reaction: float = 1.0,
        seed: int = 0,
    ) -> None:
        if not 0.0 <= reaction <= GREATEST_REACTION:
            raise ValueError(f"reaction: {reaction} is not from 0 to {GREATEST_REACTION:g}")
        if not tick_s > 0.0:
            raise ValueError(f"tick_s: {tick_s} is not greater than 0")
        self.model = model or SocialForce()
        self.paths = joined_paths(trajectories, first_ticks)
        self.last = self.paths.first + np.diff(self.paths.begins) - 1
        """The last tick of each person, int64 (N,)."""
        self.walls = checked_walls(walls)
        self.passes = walls_passed(self.paths, self.walls)
        drawn = np.random.default_rng(seed).standard_normal(len(self.paths.first))
        each = np.maximum(0.0, 1.0 + self.model.strength_spread * drawn)
        self.strengths_mps2 = reaction * self.model.strength_mps2 * each
        """The strength of everyone's evasions, float64 (N,)."""
        self.numbers = self.model.numbers(tick_s)

    def begin(self, tick: int, without: Collection[int] = ()) -> "Walk":
        """The crowd at a tick of its recording, without some people, ready to walk on."""
        return Walk(self, tick, without)


class Walk:
    """One walk of a crowd from a tick on. The same actors make the same walk, bit for bit."""

    def __init__(self, crowd: ReactingCrowd, tick: int, without: Collection[int]) -> None:
        self._crowd = crowd
        self.tick = tick
        people = len(crowd.last)
        self._absent = np.zeros(people, dtype=np.bool_)
        self._absent[list(without)] = True
        self._now = State(
            np.zeros((people, 2)),
            np.zeros((people, 2)),
            np.zeros(people),
            np.zeros(people, dtype=np.bool_),
        )
        self.displacement_m = np.zeros(people)
        """The greatest distance of each person from the recorded place so far, float64 (N,)."""
        self.present = self._there()
        """The people who are there, in ascending order, int64 (P,)."""
        self._place(self.present, self._now)

    @property
    def positions(self) -> Floats:
        """Places of the present people, float64 (P, 2), metres."""
        return np.asarray(self._now.places[self.present])

    @property
    def recorded(self) -> Floats:
        """Recorded places of the present people at this tick, float64 (P, 2), metres."""
        paths = self._crowd.paths
        own = self.tick - paths.first[self.present]
        return np.asarray(paths.places[paths.begins[self.present] + own])

    @property
    def late_s(self) -> Floats:
        """Delay of the present people behind their recorded timing, float64 (P,), seconds."""
        own = self._now.own_ticks[self.present]
        due = self.tick - self._crowd.paths.first[self.present]
        return np.asarray((due - own) * self._crowd.numbers.tick_s)

    def leave_out(self, person: int) -> None:
        """Take a person out for good, with what has been imposed on that person."""
        self._absent[person] = True
        self.displacement_m[person] = 0.0
        self.present = self._there()

    def step(self, actors: ArrayLike = (), stand_ins: ArrayLike | None = None) -> None:
        """Walk for one tick among actors.

        Parameters
        ----------
        actors : (A, 5)
            Where each is at the beginning of the tick, x and y in metres; how it moves during the
            tick, in m/s; its radius in metres.
        stand_ins : (A,)
            The person in whose place each actor is, or -1. That person is left out (`without`), but
            is in the recording, and so is how others made room: only an actor that is more
            in the way than that person was makes them walk otherwise.

        Raises
        ------
        ValueError
            A shape is wrong, a number is not finite or out of range, or there is no such person.
        """
        crowd = self._crowd
        given = np.array(actors, dtype=np.float64).reshape(-1, _ACTOR_NUMBERS)
        if not np.isfinite(given).all():
            raise ValueError("actors: a number is not finite")
        if (given[:, 4] < 0.0).any():
            raise ValueError("actors: a radius is negative")
        given[:, 4] -= PERSON_RADIUS_M
        nobody = np.full(len(given), -1, dtype=np.int64)
        named = nobody if stand_ins is None else np.array(stand_ins, dtype=np.int64)
        if named.shape != nobody.shape or not ((named >= -1) & (named < len(crowd.last))).all():
            raise ValueError("stand_ins: expected a person, or -1, for each actor")
        now = self._now
        after = State(
            now.places.copy(), now.deviations.copy(), now.own_ticks.copy(), now.moved.copy()
        )
        around = Surroundings(given, named, crowd.walls, crowd.passes, crowd.strengths_mps2)
        kernels.step(self.present, self.tick, crowd.paths, now, after, around, crowd.numbers)
        before, self.tick, self._now = self.present, self.tick + 1, after
        self.present = self._there()
        self._place(np.setdiff1d(self.present, before, assume_unique=True), after)
        away = np.linalg.norm(self.positions - self.recorded, axis=1)
        self.displacement_m[self.present] = np.maximum(self.displacement_m[self.present], away)

    def _there(self) -> Ints:
        crowd = self._crowd
        there = (crowd.paths.first <= self.tick) & (self.tick <= crowd.last) & ~self._absent
        return np.flatnonzero(there)

    def _place(self, people: Ints, state: State) -> None:
        """Put people who come in where they were recorded."""
        paths = self._crowd.paths
        own = self.tick - paths.first[people]
        state.places[people] = paths.places[paths.begins[people] + own]
        state.deviations[people] = 0.0
        state.own_ticks[people] = own
        state.moved[people] = False
