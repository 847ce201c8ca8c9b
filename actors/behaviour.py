"""Behaviours: each turns what an actor perceives into its goal of the moment."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass
from typing import Any, ClassVar, Literal

import numpy as np

from esplanade.actors.memory import (
    FLAG,
    MOMENT,
    MOMENTS,
    NUMBER,
    PEOPLE,
    PERHAPS_MOMENT,
    PLACE,
    Memory,
)
from esplanade.actors.outcomes import Outcome
from esplanade.actors.sights import sight_at
from esplanade.actors.tours import Saying, Tour, arrival, onward, welcome
from esplanade.planning import Body, LayeredGrid, Scene
from esplanade.planning.scene.heights import SAME_FLOOR_M

Goal = tuple[float, float, float]
"""x, y and the height of the floor, metres."""
Target = str | Goal
"""A place's name or a point."""
AGAIN_AFTER_S = 10.0
"""An actor that had to stay near its goal tries again after so long."""
BehaviourName = Literal["go_to", "wander", "patrol", "guide", "follow", "idle"]


@dataclass(frozen=True)
class Perception:
    """A behaviour's knowledge at a tick."""

    time_s: float
    position: tuple[float, float]
    z_m: float
    arrived: bool
    """The goal given last has been reached, as nearly as whoever is there allows."""
    stuck: bool
    """No way leads to the goal given last, or somebody blocks it."""
    people: Mapping[Hashable, Goal]
    scene: Scene
    grid: LayeredGrid
    body: Body
    rng: np.random.Generator
    actor_at: Callable[[str], Goal | None] = lambda _: None
    """Tells where an actor is, by its id; None for one that is not there."""
    outcome: Outcome | None = None
    """How the trip to the goal given last ended; None while it goes on."""

    def resolve(self, target: Target) -> Goal:
        """The point that a target means; KeyError for a place that the scene does not have."""
        if isinstance(target, str):
            place = self.scene.place(target)
            return place.position[0], place.position[1], place.z_m
        return target


_ASKED = "ask_at_s"


class Behaviour(ABC):
    """Decides where an actor wants to be, when it is asked."""

    name: ClassVar[BehaviourName]
    memory: ClassVar[Memory] = {}
    """The attributes that `save` and `load` are about, beside `ask_at_s`."""
    ask_at_s: float = -math.inf
    """Time of the world, in seconds, when `update` wants to be called again; by default at once.

    It is called before that when the actor's trip has ended, however that was.
    """
    sets_out: bool = False
    """Whether the goal of the last update is one to set out for, even if it is that of a trip that
    has ended elsewhere."""

    @abstractmethod
    def update(self, view: Perception) -> Goal | None:
        """The goal from now on, None to stand still."""

    def targets(self) -> Sequence[Target]:
        """Targets that must exist in the scene."""
        return ()

    def copy(self) -> Behaviour:
        """A copy that later updates leave as it is."""
        return copy(self)

    def save(self) -> dict[str, Any]:
        """Everything that later updates depend on, as plain data and sets."""
        return {name: getattr(self, name) for name in (_ASKED, *self.memory)}

    def load(self, saved: Mapping[str, Any]) -> None:
        """Go on as the behaviour of the same kind would have that was saved.

        Raises
        ------
        ValueError, KeyError
            Something is missing, or is not what it should be.
        """
        for name, kind in {_ASKED: MOMENT, **self.memory}.items():
            setattr(self, name, kind.validate_python(saved[name]))

    def places(self) -> list[Goal]:
        """The places that it has in mind."""
        remembered = (getattr(self, name) for name, kind in self.memory.items() if kind is PLACE)
        return [place for place in remembered if place is not None]

    strict: bool = False
    """Whether goals where the actor's body does not fit are refused rather than moved."""

    @property
    def points_at(self) -> Goal | None:
        """The place that the actor shows to people since the last update, None for none."""
        return None

    @property
    def says(self) -> Sequence[Saying]:
        """The sentences of the last update, each for some people."""
        return ()

    @property
    def tour(self) -> Tour | None:
        """The tour on which the actor leads people, None for none."""
        return None

    @property
    def moves_doors(self) -> Mapping[str, bool]:
        """Doors to open (true) or close from now on, by name, said once when it is to happen."""
        return {}


class Idle(Behaviour):
    """Stand, and make way when somebody comes too close."""

    name = "idle"

    def update(self, view: Perception) -> Goal | None:  # noqa: ARG002 - nothing to look at
        """None: an idle actor has no goal."""
        self.ask_at_s = math.inf
        return None


class GoTo(Behaviour):
    """Go to one place or point and stay there; if somebody was in the way, try again later."""

    name = "go_to"
    memory: ClassVar[Memory] = {"_again_at": PERHAPS_MOMENT}

    def __init__(self, target: Target, *, strict: bool = False) -> None:
        self._target = target
        self.strict = strict
        self._again_at: float | None = None

    def targets(self) -> Sequence[Target]:
        """The one target."""
        return (self._target,)

    def update(self, view: Perception) -> Goal | None:
        """Always the same goal."""
        self.ask_at_s, self.sets_out = math.inf, False
        if view.outcome not in (Outcome.NEAR, Outcome.BLOCKED):
            self._again_at = None
        elif self._again_at is None:
            self._again_at = self.ask_at_s = view.time_s + AGAIN_AFTER_S
        elif view.time_s >= self._again_at:
            self._again_at, self.sets_out = None, True
        else:
            self.ask_at_s = self._again_at
        return view.resolve(self._target)


class Wander(Behaviour):
    """Walk from place to place at random, resting at each; anywhere free if there are no places."""

    name = "wander"
    memory: ClassVar[Memory] = {"_goal": PLACE, "_rest_until": PERHAPS_MOMENT}

    def __init__(self, pause_s: tuple[float, float] = (1.0, 4.0)) -> None:
        self._pause_s = pause_s
        self._goal: Goal | None = None
        self._rest_until: float | None = None

    def update(self, view: Perception) -> Goal | None:
        """The place being walked to, or rested at."""
        self.ask_at_s, self.sets_out = math.inf, False
        if self._goal is None or view.stuck:
            self._set_out(view)
        elif view.arrived:
            if self._rest_until is None:
                self._rest_until = view.time_s + view.rng.uniform(*self._pause_s)
                self.ask_at_s = self._rest_until
            elif view.time_s >= self._rest_until:
                self._rest_until = None
                self._set_out(view)
            else:
                self.ask_at_s = self._rest_until
        return self._goal

    def _set_out(self, view: Perception) -> None:
        self._goal = self._choose(view)
        self._rest_until = None
        self.ask_at_s, self.sets_out = -math.inf, True

    def _choose(self, view: Perception) -> Goal | None:
        here = np.array(view.position)
        places = [
            (*place.position, place.z_m)
            for place in view.scene.places
            if math.dist(place.position, view.position) > 1.0
            or abs(place.z_m - view.z_m) >= SAME_FLOOR_M
        ]
        if places:
            return places[int(view.rng.integers(len(places)))]
        x0, y0, x1, y1 = view.scene.bounds
        for _ in range(32):
            point = view.rng.uniform((x0, y0), (x1, y1))
            x, y = float(point[0]), float(point[1])
            z_m = view.grid.floor_at((x, y), view.z_m)
            far = float(np.hypot(*(point - here))) > 1.0 and abs(z_m - view.z_m) < SAME_FLOOR_M
            if far and view.grid.is_free([point], [z_m], view.body.radius_m, view.body)[0]:
                return x, y, z_m
        return None


class Patrol(Behaviour):
    """Walk a list of places round and round, resting at each."""

    name = "patrol"
    memory: ClassVar[Memory] = {"_next": NUMBER, "_rest_until": PERHAPS_MOMENT}

    def __init__(
        self, stops: Sequence[Target], pause_s: float = 2.0, *, strict: bool = False
    ) -> None:
        self.strict = strict
        if not stops:
            raise ValueError("a patrol needs at least one stop")
        self._stops = tuple(stops)
        self._pause_s = pause_s
        self._next = 0
        self._rest_until: float | None = None

    def load(self, saved: Mapping[str, Any]) -> None:
        """As of any behaviour; the next stop is one of the stops."""
        super().load(saved)
        if self._next >= len(self._stops):
            raise ValueError(f"the next stop is {self._next}, of {len(self._stops)}")

    @property
    def next_stop(self) -> int:
        """The place, among the stops, of the one that is walked to or rested at."""
        return self._next

    @property
    def resting(self) -> bool:
        """Whether the actor rests at a stop."""
        return self._rest_until is not None

    def targets(self) -> Sequence[Target]:
        """The stops."""
        return self._stops

    def update(self, view: Perception) -> Goal | None:
        """The stop being walked to, or rested at."""
        self.ask_at_s, self.sets_out = math.inf, False
        if view.stuck:
            self._advance()
        elif view.arrived:
            if self._rest_until is None:
                self._rest_until = view.time_s + self._pause_s
            elif view.time_s >= self._rest_until:
                self._advance()
        if self._rest_until is not None:
            self.ask_at_s = self._rest_until
        return view.resolve(self._stops[self._next])

    def _advance(self) -> None:
        self._rest_until = None
        self._next = (self._next + 1) % len(self._stops)
        self.ask_at_s, self.sets_out = -math.inf, True


class Guide(Behaviour):
    """Lead people along a tour; wait for followers who fall behind, then go on.

    At a stop it explains the place to its followers, and points at what stands there. It greets
    those who join, and says to all of them where they are and where they go next.

    A person who stays within `join_m` for `join_after_s` seconds follows. When a follower is
    further than `lag_m` away the guide stands until it has come within `join_m` again, but no
    longer than `patience_s`: then it is no follower any more.
    """

    name = "guide"
    memory: ClassVar[Memory] = {
        "_near_since": MOMENTS,
        "_followers": PEOPLE,
        "_waiting_since": PERHAPS_MOMENT,
        "_stop": PLACE,
        "_sight": PLACE,
        "_explains": FLAG,
    }

    def __init__(
        self,
        tour: Sequence[Target],
        pause_s: float = 5.0,
        join_m: float = 3.0,
        lag_m: float = 6.0,
        join_after_s: float = 2.0,
        patience_s: float = 15.0,
        *,
        strict: bool = False,
    ) -> None:
        self.strict = strict
        if not tour:
            raise ValueError("a tour needs at least one stop")
        if not 0.0 < join_m < lag_m:
            raise ValueError(f"join_m must lie below lag_m, got {join_m} and {lag_m}")
        self._tour = Patrol(tour, pause_s)
        self._join_m = join_m
        self._lag_m = lag_m
        self._join_after_s = join_after_s
        self._patience_s = patience_s
        self._near_since: dict[Hashable, float] = {}
        self._followers: set[Hashable] = set()
        self._waiting_since: float | None = None
        self._stop: Goal | None = None
        self._sight: Goal | None = None
        self._explains = False
        self._says: list[Saying] = []

    @property
    def followers(self) -> frozenset[Hashable]:
        """The people who are being led."""
        return frozenset(self._followers)

    @property
    def waiting(self) -> bool:
        """Whether the guide stands for a follower who fell behind."""
        return self._waiting_since is not None

    @property
    def points_at(self) -> Goal | None:
        """The sight at the stop, while it is explained to somebody."""
        return self._sight if self._explains else None

    @property
    def says(self) -> Sequence[Saying]:
        """The sentences of the last update to those who are led."""
        return tuple(self._says)

    @property
    def tour(self) -> Tour:
        """The tour, and who is led on it."""
        return Tour(self._stop_names(), self._tour.next_stop, self.followers)

    def copy(self) -> Behaviour:
        """A copy that later updates leave as it is."""
        other = copy(self)
        vars(other).update(_tour=copy(self._tour), _followers=set(self._followers))
        return other

    def save(self) -> dict[str, Any]:
        """As of any behaviour, with its way along the tour."""
        return {**super().save(), "tour": self._tour.save()}

    def load(self, saved: Mapping[str, Any]) -> None:
        """As of any behaviour, with its way along the tour."""
        super().load(saved)
        self._tour.load(saved["tour"])

    def targets(self) -> Sequence[Target]:
        """The stops of the tour."""
        return self._tour.targets()

    def update(self, view: Perception) -> Goal | None:
        """The next stop; None while waiting for followers."""
        away = {
            who: math.dist(where[:2], view.position)
            if abs(where[2] - view.z_m) < SAME_FLOOR_M
            else math.inf
            for who, where in view.people.items()
        }
        self._followers &= away.keys()
        self._near_since = {
            who: self._near_since.get(who, view.time_s)
            for who, distance in away.items()
            if distance <= self._join_m
        }
        joined = {
            who
            for who, since in self._near_since.items()
            if view.time_s - since >= self._join_after_s and who not in self._followers
        }
        self._followers |= joined
        self._says = []
        if joined:
            self._say(welcome(self._stop_names()), joined)
        if self._waiting_since is None:
            if any(away[who] > self._lag_m for who in self._followers):
                self._waiting_since = view.time_s
        else:
            behind = {who for who in self._followers if away[who] > self._join_m}
            if behind and view.time_s - self._waiting_since >= self._patience_s:
                self._followers -= behind
                behind = set()
            if not behind:
                self._waiting_since = None
        self._explains = self.sets_out = False
        if self._waiting_since is not None:
            return None
        stop = self._tour.update(view)
        self.sets_out = self._tour.sets_out
        if self.sets_out and self._followers:
            self._say(onward(self._stop_names(), self._tour.next_stop), self._followers)
        if stop is not None and self._tour.resting and self._followers:
            self._explains = True
            if stop != self._stop:
                self._stop, self._sight = stop, sight_at(view.scene, stop)
                self._say(arrival(self._stop_names(), self._tour.next_stop), self._followers)
        return stop

    def _say(self, text: str, to: Iterable[Hashable]) -> None:
        self._says.append(Saying(text, frozenset(to)))

    def _stop_names(self) -> tuple[str, ...]:
        return tuple(stop if isinstance(stop, str) else "" for stop in self._tour.targets())
