"""A zone, tick by tick: begin (people), think (actors, elsewhere), finish (what is told of it)."""

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from typing import Any, Final

import numpy as np
import structlog

from esplanade.actors import (
    ActorParameters,
    ActorSpec,
    Explanation,
    Population,
)
from esplanade.actors.blockers import Blocker
from esplanade.actors.locomotion.footsteps.ground import Ground
from esplanade.actors.outcomes import Outcome as TripOutcome
from esplanade.actors.people import NOBODY
from esplanade.actors.potential_pool import DetourKey, GoalKey, RenewedPotential
from esplanade.actors.traces import Decided, Trace
from esplanade.actors.tracing import NotKeptError
from esplanade.planning import AgentTable, LayeredGrid, Prediction, Scene
from esplanade.protocol import encode
from esplanade.server.world.actor_commands import ActorCommands
from esplanade.server.world.actors import ActorAvatars
from esplanade.server.world.command_checks import fault_in
from esplanade.server.world.contacts import Contacts
from esplanade.server.world.doors import Doors
from esplanade.server.world.exact_state import ExactState, Parts
from esplanade.server.world.frame import Events, Frame, Line, Recorder
from esplanade.server.world.greetings import Greetings
from esplanade.server.world.inputs import (
    ActorCommand,
    ActorsDerived,
    ActorsStood,
    DoorDerived,
    IdsReserved,
    Input,
    Join,
    MoveDoor,
    OfPerson,
    PeoplePlaced,
    PlanEvery,
    PotentialDerived,
    SetParameters,
    SteerActors,
    SteerMany,
    Still,
)
from esplanade.server.world.latest_steps import LatestSteps
from esplanade.server.world.looks import Looks
from esplanade.server.world.outcomes import Fault, Outcome
from esplanade.server.world.people import People
from esplanade.server.world.person_inputs import PersonInputs
from esplanade.server.world.plans import plan
from esplanade.server.world.routes import Point, RouteSearch, SharedWaves
from esplanade.server.world.rules import Rules
from esplanade.server.world.saved_zone import Returning, SavedZone
from esplanade.server.world.spawning import Spawning
from esplanade.server.world.stage_times import StageTimes
from esplanade.server.world.state import ACTOR, PERSON, State
from esplanade.server.world.walking import Feet

PLANS_PER_SECOND: Final = 5
"""So often are the plans of a watched actor in a frame."""
ROOM_FOR_ACTORS: Final = 256
"""No more actors may come in beside those who are there from the beginning."""

log = structlog.get_logger(__name__)


class Zone:
    """State of one zone and the order in which it changes. Time is `tick * tick_s`.

    A tick is `begin`, `think`, `finish`. `think` is the heavy part and may run in another
    thread, provided that the zone is only asked questions meanwhile, and not
    to explain an actor. Same scene, seed and inputs give the same frames, bit for bit. A zone does
    not know who is told what: the audience of each server works that out from the frames.
    """

    def __init__(
        self,
        scene: Scene,
        grid: LayeredGrid,
        population: Population,
        names: Mapping[Hashable, str],
        rules: Rules,
        *,
        tick_s: float,
        max_people: int,
        seed: int,
        clock: Callable[[], float],
        roster: Iterable[ActorSpec] = (),
    ) -> None:
        """`names` holds what others see each actor called, by its id; `roster` says more."""
        self.scene = scene
        self.rules = rules
        self.tick_s = tick_s
        self.tick = 0
        self.people_seen = 0
        self.actor_names = tuple(names.values())
        self.origin_m = (scene.bounds[0], scene.bounds[1])
        self.most_actors = len(names) + ROOM_FOR_ACTORS
        self.state = State(max_people + self.most_actors)
        self.failures = 0
        """Number of inputs and of movements of actors that failed by a fault of ours."""
        self.contacts = Contacts()
        self.times = StageTimes(clock)
        self._grid = grid
        self._waves = SharedWaves(grid)
        self.doors = Doors(self.state, grid)
        self._moved_doors: dict[str, bool] = {}
        self._people = People(self.state, grid, rules, tick_s)
        self._population = population
        self.decided_tick = 0
        """The latest tick in which actors decided."""
        self._actors = ActorAvatars(self.state, population, names, tick_s)
        self._commands = ActorCommands(
            population, self._actors, scene, self.most_actors, roster, self.doors.want
        )
        self._greetings = Greetings(self.state, self._actors, self._commands)
        self._recorder = Recorder(self.state, self.origin_m)
        self._plan_period = max(1, round(1.0 / tick_s) // PLANS_PER_SECOND)
        self.steps = LatestSteps(self.state.capacity)
        self.feet = Feet(self.state, self.steps, Ground(scene, grid), tick_s, seed)
        self._spawning = Spawning(
            scene, grid, rules.person_clearance_m, np.random.SeedSequence(seed)
        )
        looks = Looks(self.state, seed)
        self._persons = PersonInputs(self.state, self._people, self._spawning, grid, rules, looks)
        self._begin_frame()
        self._observed = NOBODY
        self._saved = SavedZone(
            self.state,
            population,
            self._actors,
            self._commands,
            self.doors,
            self._spawning,
            self.contacts,
            rules.person_radius_m,
            grid,
            looks,
        )
        self._exact = ExactState(
            Parts(
                self.state,
                grid,
                self._people,
                self._persons,
                population,
                self._actors,
                self._commands,
                self.doors,
                self._spawning,
                self.contacts,
                self.feet,
                self.steps,
                self._recorder,
            )
        )

    # --- one tick -----------------------------------------------------------------------------

    def begin(self, inputs: Iterable[Input]) -> None:
        """Take in what happened outside and move the people. Inputs of those who left are void."""
        self.tick += 1
        self.times.begin()
        self._begin_frame()
        self.state.before[:] = self.state.positions
        self._moved_doors = {}
        with self.times.stage("drain"):
            for item in inputs:
                try:
                    self._take(item)
                except Exception:
                    # The world goes on without it.
                    log.exception("an input failed", tick=self.tick, input=type(item).__name__)
                    self.failures += 1
            self._moved_doors |= self.doors.update()
            if self._moved_doors:
                self._population.ground_changed(renewed_outside=self.doors.derived_outside)
        with self.times.stage("people"):
            if not self._still:
                self._people.move()
                self._observed = self._people.observed()

    def think(self) -> bool:
        """Find the next step of every actor; whether there are any.

        If it raises, every actor is as it was, and `finish(False)` lets them stand. To have the
        same world in a replay, `ActorsStood` is then an input of this tick.
        """
        with self.times.stage("actors"):
            if self._still:
                return False
            if self._stands:
                self._actors.stand(self._observed)
                return False
            decided = self._actors.plan(self._observed)
            self.decided_tick = self.tick if decided else self.decided_tick
            return decided

    def finish(self, actors_moved: bool) -> Frame:
        """Move the actors, if they have moved, and say what is new in this tick."""
        with self.times.stage("contacts"):
            # In a still tick actors who have come or were put elsewhere are shown all the same.
            pointing = self._place(actors_moved or self._still)
            if actors_moved:
                for name, is_open in self._actors.doors_wanted.items():
                    self.doors.want(name, is_open)
            if not self._still:
                self.contacts.update(self.state)
        with self.times.stage("steps"):
            if self._still:
                self.feet.stand_newcomers(self.tick)
            else:
                self.feet.update(self.tick)
        with self.times.stage("encode"):
            people, actors = self.count()
            return Frame(
                tick=self.tick,
                people=people,
                actors=actors,
                left=self._persons.left,
                entered=self._recorder.entered(),
                reshaped=self._recorder.reshaped(),
                joined=self._persons.joined,
                attached=self._persons.attached,
                detached=self._persons.detached,
                acks=self._persons.acks,
                records=self._recorder.changed(),
                steps=self.steps.begun_in(self.tick, self.state.live()),
                events=self._events(pointing, self._actors.said() if actors_moved else []),
                outcomes=self._commands.outcomes,
                actors_stood=not (actors_moved or self._still) and len(self._population) > 0,
            )

    def _place(self, actors_moved: bool) -> dict[int, Point | None]:
        try:
            return self._actors.place(actors_moved)
        except Exception:
            # Those whose avatars cannot be moved stand; the people's world goes on.
            log.exception("the actors' avatars cannot be moved", tick=self.tick)
            self.failures += 1
            return self._actors.place(moved=False)

    def derive_outside(self) -> None:
        """From now on no tick waits for what is heavy: it comes as inputs, of whoever asks for it.

        They are what `doors.due`, `outdated_potential` and `actor_work` want.
        """
        self.doors.derived_outside = self._commands.derived_outside = True
        self._population.derive_outside()

    # --- restarts -----------------------------------------------------------------------------

    def save(self) -> dict[str, Any]:
        """Everything that later ticks depend on, as plain data; call it between two ticks."""
        return {"tick": self.tick, "people_seen": self.people_seen, **self._saved.save()}

    def load(self, saved: Mapping[str, Any], people: Sequence[Returning] = ()) -> None:
        """Go on from what was saved, with these people of it, before the first tick.

        The doors of the grid must stand as they did then already (`saved_zone.set_doors`).

        Raises
        ------
        ValueError, KeyError, TypeError
            Something is missing, or cannot be. Nothing is to be done with this zone then.
        """
        self._saved.load(saved, people)
        self.tick, self.people_seen = int(saved["tick"]), int(saved["people_seen"])
        self.actor_names = tuple(spec.name for spec in self.actors.values())

    def save_exactly(self) -> dict[str, Any]:
        """Everything that later ticks depend on, bit for bit; call it between two ticks."""
        return {
            "zone": [self.tick, self.people_seen, self.failures, self.decided_tick],
            **self._exact.save(),
        }

    def load_exactly(self, saved: Mapping[str, Any]) -> None:
        """Go on bit for bit from what a zone of the same scene, seed and size has saved.

        Heavy: potentials are derived anew. Call it between two ticks.

        Raises
        ------
        ValueError, KeyError, TypeError
            Something is missing, or cannot be. Nothing is to be done with this zone then.
        """
        self._exact.load(saved)
        self.tick, self.people_seen, self.failures, self.decided_tick = map(int, saved["zone"])
        self.actor_names = tuple(spec.name for spec in self.actors.values())
        self._begin_frame()

    def skip_to(self, tick: int) -> None:
        """Let the next tick have the number after that one, at least; time of actors stands."""
        self.tick = max(self.tick, tick)

    def put(self, person: Returning) -> None:
        """Let a person stand in the world who was here before, before the first tick."""
        self._saved.put(person)

    def redo(self, inputs: Iterable[ActorCommand | MoveDoor]) -> list[Outcome]:
        """Carry out before the first tick what was acknowledged after the zone was saved."""
        self._commands.begin()
        for item in inputs:
            self._take(item)
        outcomes = self._commands.outcomes
        self._begin_frame()
        return outcomes

    # --- questions ----------------------------------------------------------------------------

    @property
    def trips(self) -> int:
        """Trips that the actors have completed."""
        return self._actors.trips

    @property
    def ended(self) -> Mapping[TripOutcome, int]:
        """Trips of actors that have ended, by their outcome."""
        return self._actors.ended

    @property
    def planning_interval(self) -> int:
        """Ticks from one planning of an actor to its next; `PlanEvery` changes them."""
        return self._population.navigator.planning_interval.ticks

    @property
    def usual_planning_interval(self) -> int:
        """The same where there is time enough."""
        return self._population.navigator.planning_interval.usual

    @property
    def grid(self) -> LayeredGrid:
        """The ground of the zone; its shape never changes, its doors do, between two ticks."""
        return self._grid

    def count(self) -> tuple[int, int]:
        """People and actors in the world."""
        return len(self.state.of_kind(PERSON)), len(self.state.of_kind(ACTOR))

    def route_search(self, avatar_id: int, goal: Point, *, strict: bool = False) -> RouteSearch:
        """A search for a way from where that avatar is now; heavy, and meant for another thread."""
        clearance_m = self.rules.person_clearance_m
        return RouteSearch(self._waves, self.where(avatar_id), goal, clearance_m, strict=strict)

    def outdated_potential(self) -> Callable[[], RenewedPotential] | None:
        """Derives the next potential that is out of date, if any; heavy, safe in any thread.

        Ask between two ticks; potentials are out of date where `doors.derived_outside`.
        """
        return self._population.outdated_potential()

    def outdated_goals(self) -> list[GoalKey | DetourKey]:
        """The goals whose potentials are out of date, in the order in which they are derived."""
        return self._population.navigator.potentials.outdated_goals()

    def derived_now(self, goal: GoalKey | DetourKey) -> RenewedPotential:
        """The potential of a goal on the ground as it is; heavy."""
        return self._population.navigator.potentials.derived_now(goal)

    def derived_again(self, goal: GoalKey | DetourKey, changes: int) -> RenewedPotential:
        """The potential of a goal on the ground as it is, for a replay; heavy."""
        return self._population.navigator.potentials.derived_again(goal, changes)

    def actor_work(self) -> Callable[[], ActorsDerived] | None:
        """Derives what the next command on actors waits for, if any; heavy, safe in any thread.

        Ask between two ticks, and let no door move until the result was an input.
        """
        return self._commands.work()

    @property
    def longest_waiting(self) -> int | None:
        """The number of the command for which `actor_work` derives something; None for none."""
        return next((each.command for each in self._commands.those_waiting), None)

    @property
    def commands_waiting(self) -> int:
        """Number of commands on actors that wait for what is derived for them."""
        return self._commands.waiting

    def check(self, command: ActorCommand) -> Fault | None:
        """Why a command would be refused if it were an input of the next tick, None if it were not.

        Ask between two ticks.
        """
        return fault_in(command, self._population, self.most_actors)

    def new_bodies(self, command: SetParameters) -> int:
        """Number of bodies, each with a goal, that a command would make; ask between two ticks.

        The command must be one that `check` has no fault in.
        """
        return len(set(self._population.new_bodies(command.actors, command.values)))

    @property
    def actors(self) -> Mapping[Hashable, ActorSpec]:
        """The specification of each actor by its id, with the behaviour it was given last."""
        return self._commands.specs

    def parameters(self, actor_id: str) -> ActorParameters:
        """The parameters that an actor goes by."""
        return self._population.navigator.parameters(actor_id)

    def avatar_of(self, actor_id: str) -> int | None:
        """The id of an actor's avatar; None if there is no such actor, or not yet."""
        return self._actors.avatar(actor_id)

    def goal_of(self, actor_id: str) -> Point | None:
        """The goal of an actor's trip; None if it is on none."""
        table = self._population.table
        row = table.row(actor_id)
        on_way = table.trips.outcomes[row] == 0 and not self._population.held(actor_id)
        return table.wanted(row) if on_way else None

    def waypoint(self, actor_id: str) -> tuple[float, float] | None:
        """The point that an actor's way leads straight to, metres; None where no way leads."""
        return self._population.navigator.waypoint(actor_id)

    def actor_of(self, avatar_id: int) -> str | None:
        """The id of the actor whose avatar that is; None if it is nobody's."""
        actor_id = self._actors.actor(avatar_id)
        return None if actor_id is None else str(actor_id)

    @property
    def agents(self) -> AgentTable:
        """Every actor's state; read it between two ticks only."""
        return self._population.table

    @property
    def slice_s(self) -> float:
        """Time between the places of a plan, seconds."""
        return self._population.navigator.plan.slice_s

    def predicted(self) -> Prediction:
        """The places where people are expected, as of the latest tick; between two ticks only."""
        return self._population.navigator.prediction

    def moves(self, avatar_id: int) -> bool:
        """Whether that person means to move, by a direction or along a route."""
        return avatar_id in self.state and self._people.moves(self.state.slot(avatar_id))

    def is_actor(self, avatar_id: int) -> bool:
        return avatar_id in self.state and (
            int(self.state.kinds[self.state.slot(avatar_id)]) == ACTOR
        )

    def explain(self, actor_id: int) -> Explanation:
        """Why an actor, named by its avatar's id, does what it does."""
        return self._actors.explain(actor_id)

    def blocker(self, avatar_id: int) -> Blocker | None:
        """The blocker of an actor, named by its avatar's id, as in `explain`; None for others."""
        return self._actors.blocker(avatar_id) if self.is_actor(avatar_id) else None

    def keep_decisions(self, wanted: bool) -> bool:
        """Set whether ticks keep what actors decide upon, for `decided` and `trace`; whether the
        latest one has. Call it between two ticks."""
        tracing = self._population.navigator.tracing
        tracing.wanted = wanted
        return tracing.has_kept

    def decided(self, avatar_id: int) -> Decided | None:
        """The path that an actor has taken, named by its avatar's id, and the one before.

        None if that was not kept. Ask between two ticks, as for `trace`.
        """
        actor_id = self._actors.actor(avatar_id)
        try:
            return None if actor_id is None else self._population.navigator.decided(actor_id)
        except NotKeptError:
            return None

    def trace(self, avatar_id: int) -> Trace | None:
        """The decision of an actor in `decided_tick`, made once more; as `decided`. Heavy: it is
        safe in the thread of `think`, if nothing else is done with the zone meanwhile."""
        actor_id = self._actors.actor(avatar_id)
        try:
            return None if actor_id is None else self._population.navigator.trace(actor_id)
        except NotKeptError:
            return None

    def where(self, avatar_id: int) -> Point:
        """Where an avatar is: x, y and the height of its feet, metres."""
        slot = self.state.slot(avatar_id)
        x, y = self.state.positions[slot].tolist()
        return x, y, float(self.state.heights[slot])

    # --- inputs -------------------------------------------------------------------------------

    def _begin_frame(self) -> None:
        self._persons.begin_frame()
        self._stands = self._still = False
        self._actors.steered = {}
        self._commands.begin()

    def _take(self, item: Input) -> None:
        match item:
            case Join():
                self._persons.join(item)
                self.people_seen += 1
            case SteerMany() | PeoplePlaced():
                self._persons.take_many(item)
            case MoveDoor():
                self.doors.want(item.name, item.is_open)
            case DoorDerived():
                self._moved_doors |= self.doors.take(item.change)
            case PotentialDerived() | PlanEvery() | SteerActors():
                self._actors.take(item)
            case ActorsDerived():
                self._persons.gone(self._commands.take_derived(item, self.tick))
            case ActorsStood():
                self._stands = True
            case Still():
                self._still = True
            case IdsReserved():
                self.state.add_ids(item.first, item.end)
            case _ if isinstance(item, OfPerson):
                if item.id in self.state:
                    self._persons.take(item, self.state.slot(item.id))
            case _:
                self._persons.gone(self._commands.take(item, self.tick))

    def _events(self, pointing: dict[int, Point | None], said: list[Line]) -> Events:
        gestures = self._persons.gestures
        return Events(
            doors=self._moved_doors,
            pointing=pointing,
            chat=[*self._persons.chat, *said],
            gestures=gestures | self._greetings.answers(gestures),
            away=self._recorder.away(),
            plans=self._plans(),
        )

    def _plans(self) -> dict[int, bytes]:
        """Why the watched actors do what they do, of those whose turn it is; packed messages."""
        in_turn = {a for a in self._persons.watched if (self.tick + a) % self._plan_period == 0}
        return {
            actor: encode(plan(self.tick, actor, self.explain(actor))) for actor in sorted(in_turn)
        }
