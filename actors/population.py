"""The population of a zone: all actors with their behaviours, and the navigator of them all."""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Mapping, Sequence
from contextlib import suppress
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from esplanade.actors.behaviour import Behaviour, Goal, Perception
from esplanade.actors.blockers import Blocker, find_blocker
from esplanade.actors.explanation import Explanation
from esplanade.actors.navigator import Navigator
from esplanade.actors.outcomes import Outcome
from esplanade.actors.parameters import ActorParameters, body_of
from esplanade.actors.placing import Newcomer, Placing
from esplanade.actors.potential_pool import GoalKey, RenewedPotential
from esplanade.actors.saved_minds import SavedMinds, load_mind
from esplanade.actors.state import ActorState
from esplanade.actors.tours import Saying
from esplanade.actors.warming import warm_up
from esplanade.planning import (
    PARAMETERS,
    AgentTable,
    Body,
    LayeredGrid,
    RiskModel,
    Scene,
)

_EXPLAINED_WITHIN_M = 8.0
_AT_GOAL = (Outcome.ARRIVED, Outcome.NEAR)
_STUCK = (Outcome.BLOCKED, Outcome.NO_WAY)
_DERIVED_AT_ONCE = 32
"""If saved actors have more goals than this, their potentials are derived outside of ticks."""
_SPARE_POTENTIALS = 64
"""Room for so many goals more is made beforehand; it takes memory only once they are there."""


class _Before(NamedTuple):
    """Reasons and outcomes (A,) of all actors as they were a tick ago."""

    reasons: NDArray[np.int64]
    outcomes: NDArray[np.int64]


class Population:
    """All actors of a zone. One call of `tick` a tick; same seed and same people, same walks.

    An actor has one identity, its id; its whole state stands in `navigator.table`.
    """

    def __init__(
        self,
        grid: LayeredGrid,
        scene: Scene,
        tick_s: float = 0.05,
        seed: int = 0,
        *,
        person_radius_m: float = 0.25,
    ) -> None:
        self.grid = grid
        self.scene = scene
        self.navigator = Navigator(
            grid, tick_s, seed, risk=RiskModel(person_radius_m=person_radius_m)
        )
        self.ended = dict.fromkeys(Outcome, 0)
        """Trips of all actors that have ended so far, by their outcome."""
        self.doors_wanted: dict[str, bool] = {}
        """Doors that behaviours wanted moved in the last tick; the actor added last prevails."""
        self.said: list[tuple[Hashable, Saying]] = []
        """The sentences of the last tick, each with the actor that says it."""
        self._tick = 0
        self._seed = seed
        self._behaviours: dict[Hashable, Behaviour] = {}
        self._generators: dict[Hashable, np.random.Generator] = {}
        self._asked: list[tuple[Hashable, Behaviour, Any]] = []
        """Those asked in this tick, each with its behaviour and chance as they were before."""
        self._held: set[Hashable] = set()
        self._steered: dict[Hashable, tuple[float, float]] = {}
        self._people: Mapping[Hashable, Goal] = {}
        self._placing = Placing(grid, scene)
        self._minds = SavedMinds()

    @property
    def trips(self) -> int:
        """Goals reached by all actors so far."""
        return self.ended[Outcome.ARRIVED]

    @property
    def table(self) -> AgentTable:
        """Every actor's state; read it freely between two ticks."""
        return self.navigator.table

    def __len__(self) -> int:
        return len(self._behaviours)

    def add(
        self,
        actor_id: Hashable,
        behaviour: Behaviour,
        parameters: ActorParameters | None = None,
        position: tuple[float, float] | None = None,
        z_m: float = 0.0,
    ) -> ActorState:
        """Put an actor in; without a position it gets a free place, chosen with the seed.

        At a position where it cannot stand it is put on the nearest ground where it can.

        Raises
        ------
        ValueError
            The id is taken, the position is outside, or there is no free place.
        KeyError
            The behaviour names a place that the scene does not have.
        """
        if position is not None:
            self.navigator.check_place(position, z_m)
        place = None if position is None else (*position, z_m)
        parameters = parameters or ActorParameters()
        self.add_many([Newcomer(actor_id, behaviour, parameters, place, z_m)])
        return self.navigator.state(actor_id)

    def add_many(self, newcomers: Sequence[Newcomer]) -> None:
        """Put actors in, all or none; as `add`.

        Raises
        ------
        ValueError, KeyError
            As of `add`, of any of them. Nothing is changed then.
        """
        for each in newcomers:
            self._check_targets(each.behaviour)
        generators = [self.generator(each.id) for each in newcomers]
        agents = self.table.agents
        taken = np.column_stack([agents.positions, agents.heights, agents.parameters["radius_m"]])
        places = self.places(newcomers, self._placing, generators, taken)
        records = np.array([each.parameters.row() for each in newcomers], dtype=PARAMETERS)
        self.navigator.add_actors([each.id for each in newcomers], places, records)
        for each, generator in zip(newcomers, generators, strict=True):
            self._behaviours[each.id] = each.behaviour
            self._generators[each.id] = generator
        self._minds.change(each.id for each in newcomers)

    def places(
        self,
        newcomers: Sequence[Newcomer],
        placing: Placing,
        generators: Sequence[np.random.Generator],
        taken: NDArray[np.float64],
    ) -> list[Goal]:
        """Places where newcomers can stand, away from each other and from `taken` (N, 4).

        These are x, y, z and the radius of who is there.
        """
        places: list[Goal] = []
        passed: dict[Goal, int] = {}
        for each, generator in zip(newcomers, generators, strict=True):
            body = each.parameters.body
            if each.place is not None:
                self.navigator.check_place(each.place[:2], each.place[2])
                if each.near:
                    places.append(placing.beside(body, each.place, taken, passed))
                else:
                    places.append(placing.near(body, each.place))
            else:
                places.append(placing.anywhere(body, each.z_m, taken, generator))
            taken = np.concatenate([taken, [(*places[-1], body.radius_m)]])
        return places

    def generator(self, actor_id: Hashable) -> np.random.Generator:
        """The chance that an actor of this id has, from its beginning."""
        return np.random.default_rng([self._seed, *str(actor_id).encode()])

    def draw_anew(self, seed: int) -> None:
        """Let the behaviours of all actors, and of those who come in, draw by another seed."""
        self._seed = seed
        self._generators = {each: self.generator(each) for each in self._generators}
        self._minds.change_all()

    def remove(self, actor_id: Hashable) -> None:
        """Take an actor out; KeyError when there is none of that id."""
        self.remove_many([actor_id])

    def remove_many(self, ids: Sequence[Hashable]) -> None:
        """Take actors out; KeyError when one is not there, and nothing is changed then."""
        self.navigator.remove_actors(ids)
        for actor_id in dict.fromkeys(ids):
            del self._behaviours[actor_id], self._generators[actor_id]
            self._held.discard(actor_id)
        self._minds.change(ids)

    def set_behaviour(self, actor_id: Hashable, behaviour: Behaviour) -> None:
        """Give an actor another behaviour; KeyError for an unknown actor or place."""
        row = self.table.row(actor_id)
        self._check_targets(behaviour)
        self._behaviours[actor_id] = behaviour
        self._minds.change([actor_id])
        self.navigator.begin_trip(actor_id)
        self.table.trips.ask_at_s[row] = -np.inf

    def check_targets(self, behaviour: Behaviour) -> None:
        """KeyError for a place that the scene does not have, ValueError for a point outside."""
        self._check_targets(behaviour)
        for target in behaviour.targets():
            if not isinstance(target, str):
                self.navigator.check_place(target[:2], target[2])

    def set_parameters(self, actor_id: Hashable, parameters: ActorParameters) -> None:
        """Change an actor's parameters from the next tick on."""
        self.navigator.set_parameters(actor_id, parameters)

    def set_many(
        self,
        ids: Sequence[Hashable],
        values: Mapping[str, ArrayLike],
        prepared: Mapping[GoalKey, NDArray[np.float32]] | None = None,
    ) -> None:
        """Change some parameters of some actors; see `Navigator.set_many`."""
        self.navigator.set_many(ids, values, prepared)

    def new_bodies(
        self, ids: Sequence[Hashable], values: Mapping[str, ArrayLike]
    ) -> list[tuple[Goal | None, Body]]:
        """The bodies that `set_many` would make others, each with the goal of its actor.

        Raises
        ------
        ParameterError, KeyError, ValueError
            As of `set_many`.
        """
        return self.navigator.new_bodies(ids, values)

    def hold(self, actor_id: Hashable, held: bool) -> None:
        """Let an actor stand where it is, making way, until it is held no more."""
        row = self.table.row(actor_id)
        if held:
            self._held.add(actor_id)
            self.navigator.set_goal(actor_id, None)
        else:
            self._held.discard(actor_id)
            self.table.trips.ask_at_s[row] = -np.inf

    def steer(self, velocities: Mapping[Hashable, tuple[float, float]]) -> None:
        """Let some actors go at these velocities, m/s, in the next tick, instead of planning.

        Those who are not there by then, or held, plan as ever.
        """
        self._steered = dict(velocities)

    def held(self, actor_id: Hashable) -> bool:
        """Whether an actor is held."""
        return actor_id in self._held

    def place(self, actor_id: Hashable, place: Goal) -> None:
        """Put an actor elsewhere, on the nearest ground where it can stand.

        Raises
        ------
        ValueError
            The place is outside, or the body can stand nowhere. Nothing is changed then.
        KeyError
            There is no actor of that id.
        """
        row = self.table.row(actor_id)
        self.navigator.check_place(place[:2], place[2])
        x, y, z_m = self._placing.near(body_of(self.table.agents.parameters[row]), place)
        self.navigator.place_actor(actor_id, (x, y), z_m=z_m)
        self.navigator.set_back(actor_id)
        self.navigator.begin_trip(actor_id)
        self.table.trips.ask_at_s[row] = -np.inf

    def derive_outside(self) -> None:
        """From now on no tick waits for potentials: `outdated_potential` tells which are wanted."""
        self.navigator.potentials.derived_outside = True

    def undo_point(self) -> Callable[[], None]:
        """Return a call that puts all actors back, if a change fails half-way."""
        restore = self.navigator.undo_point()
        behaviours, generators = dict(self._behaviours), dict(self._generators)
        held, ended = set(self._held), dict(self.ended)

        def undo() -> None:
            restore()
            self._behaviours, self._generators = behaviours, generators
            self._held, self.ended = held, ended
            self._minds.change_all()

        return undo

    def save(self) -> dict[str, Any]:
        """Everything that later ticks of these actors depend on, as plain data and arrays.

        What was seen of people is not in it: people who were away begin to be seen anew. Cost:
        copies of the table, and a little for each actor whose behaviour was asked meanwhile.

        Raises
        ------
        TypeError
            An actor's id is neither text nor a whole number.
        """
        header, columns = self.navigator.save()
        return {
            "time_s": self._tick * self.navigator.tick_s,
            "trips": [self.ended[outcome] for outcome in Outcome],
            "held": list(self._held),
            "table": header,
            "columns": columns,
            "minds": self._minds.save(self._behaviours, self._generators),
        }

    def load(self, saved: Mapping[str, Any], behaviours: Mapping[Hashable, Behaviour]) -> None:
        """Take the actors of a saved population in the place of those here.

        `behaviours` are of the kinds that they had, one for each.

        Raises
        ------
        ValueError, KeyError, TypeError
            Something is missing, or cannot be. Nothing is to be done with this population then.
        """
        wanted = np.asarray(saved["columns"]["wanted"])
        if len(np.unique(wanted, axis=0)) > _DERIVED_AT_ONCE:
            self.derive_outside()
        self.navigator.load(saved["table"], saved["columns"])
        if not math.isfinite(saved["time_s"]) or saved["time_s"] < 0.0:
            raise ValueError(f"time_s: {saved['time_s']}")
        self._load_minds(saved["minds"], behaviours, set(saved["held"]))
        self.ended = dict(zip(Outcome, map(int, saved["trips"]), strict=True))
        self._tick = round(saved["time_s"] / self.navigator.tick_s)

    def _load_minds(
        self,
        minds: Sequence[bytes],
        behaviours: Mapping[Hashable, Behaviour],
        held: set[Hashable],
    ) -> None:
        """Let the behaviours of all actors in the table go on, and those who are held stand."""
        ids = self.table.ids
        if not held <= set(ids):
            raise ValueError("an actor is held that is not there")
        self._behaviours = {actor_id: behaviours[actor_id] for actor_id in ids}
        self._generators = {actor_id: self.generator(actor_id) for actor_id in ids}
        for actor_id, packed in zip(ids, minds, strict=True):
            behaviour = self._behaviours[actor_id]
            load_mind(packed, behaviour, self._generators[actor_id])
            self.check_targets(behaviour)
            for x, y, z_m in behaviour.places():
                self.navigator.check_place((x, y), z_m)
        self._held = held
        self._minds.change_all()

    def save_exactly(self) -> dict[str, Any]:
        """Everything that later ticks of these actors depend on, bit for bit.

        Raises
        ------
        TypeError
            As of `save`.
        """
        return {
            "ticks": self._tick,
            "trips": [self.ended[outcome] for outcome in Outcome],
            "held": sorted(self._held, key=str),
            "minds": self._minds.save(self._behaviours, self._generators),
            "navigator": self.navigator.save_exactly(),
        }

    def load_exactly(
        self, saved: Mapping[str, Any], behaviours: Mapping[Hashable, Behaviour]
    ) -> None:
        """Go on bit for bit from what `save_exactly` gave; as `load`.

        Raises
        ------
        ValueError, KeyError, TypeError
            Something is missing, or cannot be. Nothing is to be done with this population then.
        """
        self.navigator.load_exactly(saved["navigator"])
        self._placing.ground_changed()
        self._load_minds(saved["minds"], behaviours, set(saved["held"]))
        self.ended = dict(zip(Outcome, map(int, saved["trips"]), strict=True))
        self._tick = int(saved["ticks"])

    def tick(self, people: Mapping[Hashable, Goal]) -> dict[Hashable, ActorState]:
        """`advance`, then the states of all actors: id -> state."""
        self.advance(people)
        return {actor_id: self.state(actor_id) for actor_id in self.table}

    def advance(self, people: Mapping[Hashable, Goal]) -> None:
        """One tick: behaviours choose goals, then everyone plans and steps; see `table`.

        A behaviour is asked when its time has come, when its actor has arrived, and while no path
        leads to the goal. Cost in Python: O(behaviours asked). If it fails, all actors are as they
        were before, as if it had been a tick of `stand`.
        """
        undo = self.undo_point()
        self._asked.clear()
        try:
            self.navigator.observe(people)
            self._people = people
            self._plan()
        except Exception:
            undo()
            for actor_id, behaviour, chance in self._asked:
                self._behaviours[actor_id] = behaviour
                self._generators[actor_id].bit_generator.state = chance
            self.doors_wanted, self.said = {}, []
            raise
        finally:
            self._steered = {}
            self._tick += 1

    def stand(self, people: Mapping[Hashable, Goal]) -> None:
        """A tick in which planning has failed before: nobody moves, but people are seen."""
        with suppress(ValueError):
            self.navigator.observe(people)
            self._people = people
        self.doors_wanted, self.said, self._steered = {}, [], {}
        self._tick += 1

    def _plan(self) -> None:
        self.doors_wanted, self.said = {}, []
        trips, time_s = self.table.trips, self._tick * self.navigator.tick_s
        due = (time_s >= trips.ask_at_s) | (trips.outcomes != trips.outcome_when_asked)
        due[[self.table.row(actor_id) for actor_id in self._held]] = False
        rows = np.flatnonzero(due).tolist()
        if rows:
            ids = self.table.ids
            for row in rows:
                self._ask(ids[row], row, self._people, time_s)
        before = _Before(self.table.agents.reasons.copy(), trips.outcomes.copy())
        steered = {
            who: velocity
            for who, velocity in self._steered.items()
            if who in self.table and who not in self._held
        }
        if steered:
            self.navigator.advance(steered)
        else:
            self.navigator.advance()
        self._keep_account(before)

    def _ask(
        self,
        actor_id: Hashable,
        row: int,
        people: Mapping[Hashable, Goal],
        time_s: float,
    ) -> None:
        """Ask a behaviour where its actor is to go, and send it there."""
        behaviour, generator = self._behaviours[actor_id], self._generators[actor_id]
        self._asked.append((actor_id, behaviour.copy(), generator.bit_generator.state))
        self._minds.change([actor_id])
        agents, trips = self.table.agents, self.table.trips
        outcome = self.navigator.outcome(row)
        x, y = agents.positions[row].tolist()
        goal = behaviour.update(
            Perception(
                time_s,
                (x, y),
                float(agents.heights[row]),
                outcome in _AT_GOAL,
                outcome in _STUCK,
                people,
                self.scene,
                self.grid,
                body_of(agents.parameters[row]),
                generator,
                self._place_of,
                outcome,
            )
        )
        self.doors_wanted.update(behaviour.moves_doors)
        self.said.extend((actor_id, saying) for saying in behaviour.says)
        ended = outcome is not None and outcome is not Outcome.ARRIVED
        if goal != self.table.wanted(row) or (ended and behaviour.sets_out):
            self.navigator.set_goal(
                actor_id,
                None if goal is None else goal[:2],
                z_m=0.0 if goal is None else goal[2],
                strict=behaviour.strict,
            )
        trips.outcome_when_asked[row] = trips.outcomes[row]
        trips.ask_at_s[row] = behaviour.ask_at_s
        trips.points_at[row] = np.nan if behaviour.points_at is None else behaviour.points_at

    def _place_of(self, actor_id: str) -> Goal | None:
        """Where an actor is; None if there is none of that id."""
        if actor_id not in self.table:
            return None
        row, agents = self.table.row(actor_id), self.table.agents
        x, y = agents.positions[row].tolist()
        return x, y, float(agents.heights[row])

    def _keep_account(self, before: _Before) -> None:
        """Count the trips that ended in this tick, and for how long things are as they are.

        `before` is how things were a tick ago.
        """
        reasons, trips = self.table.agents.reasons, self.table.trips
        same_s = trips.reason_s + self.navigator.tick_s
        trips.reason_s[:] = np.where(reasons == before.reasons, same_s, 0.0)
        ended = np.where(trips.outcomes != before.outcomes, trips.outcomes, 0)
        counts = np.bincount(ended, minlength=max(Outcome) + 1)
        for outcome in Outcome:
            self.ended[outcome] += int(counts[outcome])

    def state(self, actor_id: Hashable) -> ActorState:
        """One actor's state; an actor that points at something is turned to it."""
        state = self.navigator.state(actor_id)
        target = self.table.points_at(self.table.row(actor_id))
        if target is None:
            return state
        return state._replace(points_at=target, heading=_turned_to(state.position, target))

    def facing(self) -> NDArray[np.float64]:
        """Headings that actors show, float64 (A,) rad: those who point at something face it."""
        agents, trips = self.table.agents, self.table.trips
        headings = agents.headings.copy()
        for row in np.flatnonzero(~np.isnan(trips.points_at[:, 0])).tolist():
            headings[row] = _turned_to(
                agents.positions[row].tolist(), trips.points_at[row].tolist()
            )
        return headings

    def pointing(self) -> dict[Hashable, Goal]:
        """The places that actors point at just now, x, y, z in metres by their ids."""
        rows = np.flatnonzero(~np.isnan(self.table.trips.points_at[:, 0])).tolist()
        if not rows:
            return {}
        ids = self.table.ids
        return {ids[row]: target for row in rows if (target := self.table.points_at(row))}

    def ground_changed(self, *, renewed_outside: bool = False) -> None:
        """The ground has changed, as when a door closes: potentials of goals are derived anew.

        With `renewed_outside`, by whoever calls `outdated_potential` and `renew_potential`.
        """
        self._placing.ground_changed()
        self.navigator.ground_changed(renewed_outside=renewed_outside)

    def outdated_potential(self) -> Callable[[], RenewedPotential] | None:
        """Derives the next potential that is out of date, in any thread; None if there is none."""
        return self.navigator.potentials.outdated()

    def renew_potential(self, renewed: RenewedPotential) -> None:
        """Let actors go by a potential that was derived anew."""
        self.navigator.potentials.renew(renewed)

    def explain(self, actor_id: Hashable) -> Explanation:
        """Why an actor does what it does; KeyError when there is none of that id."""
        behaviour, state = self._behaviours[actor_id], self.navigator.state(actor_id)
        near = self.navigator.predicted_near(state.position, state.z_m, _EXPLAINED_WITHIN_M)
        for circles in near:
            circles[:, 3] *= 2.0
        row = self.table.row(actor_id)
        return Explanation(
            behaviour.name,
            state.reason,
            state.goal,
            state.path,
            near,
            float(self.table.trips.reason_s[row]),
            find_blocker(self.navigator, actor_id, self._people),
            state.outcome,
            state.in_the_way,
            self.navigator.moved(actor_id),
            behaviour.tour,
        )

    def blocker(self, actor_id: Hashable) -> Blocker | None:
        """The blocker of an actor, as in `explain`, without the rest."""
        return find_blocker(self.navigator, actor_id, self._people)

    def warm_up(self, ready_to_plan: Callable[[], None] = lambda: None) -> None:
        """Make ready all that a tick would have to wait for: kernels, and potentials of places.

        `ready_to_plan` waits until the kernels that plan have been compiled elsewhere.
        """
        warm_up(self.navigator.tick_s, ready_to_plan)
        goals = [(place.position, place.z_m) for place in self.scene.places]
        self.navigator.prepare_goals(goals, ActorParameters())
        self.navigator.potentials.reserve(_SPARE_POTENTIALS)

    def close(self) -> None:
        """End the planning threads."""
        self.navigator.close()

    def _check_targets(self, behaviour: Behaviour) -> None:
        for target in behaviour.targets():
            if isinstance(target, str):
                self.scene.place(target)


def _turned_to(position: Sequence[float], target: Sequence[float]) -> float:
    """Heading from a place to a target, radians."""
    return math.atan2(target[1] - position[1], target[0] - position[0])
