"""A zone, tick by tick: begin (people), think (actors, elsewhere), finish (what is told of it)."""

from collections.abc import Callable, Hashable, Iterable, Mapping
from typing import Final

import numpy as np
import structlog

from esplanade.actors import (
    ActorParameters,
    ActorSpec,
    Explanation,
    ObservedPeople,
    Population,
)
from esplanade.actors.locomotion.footsteps.ground import Ground
from esplanade.actors.people import NOBODY
from esplanade.actors.potential_pool import RenewedPotential
from esplanade.planning import LayeredGrid, Scene
from esplanade.server.world.actor_commands import ActorCommands
from esplanade.server.world.actors import ActorAvatars
from esplanade.server.world.command_checks import check
from esplanade.server.world.contacts import Contacts
from esplanade.server.world.doors import Doors
from esplanade.server.world.frame import Events, Frame, Line, Recorder, Tickets
from esplanade.server.world.inputs import (
    ActorCommand,
    ActorsDerived,
    ActorsStood,
    Attach,
    Detach,
    DoorDerived,
    Follow,
    Input,
    Join,
    Leave,
    MoveDoor,
    OfPerson,
    PotentialDerived,
    Say,
    Stand,
    Steer,
    Watch,
)
from esplanade.server.world.latest_steps import LatestSteps
from esplanade.server.world.outcomes import Fault, fault_of
from esplanade.server.world.people import People
from esplanade.server.world.routes import Point, RouteSearch, SharedWaves
from esplanade.server.world.rules import Rules
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
        self._actors = ActorAvatars(self.state, population, names, tick_s)
        self._commands = ActorCommands(population, self._actors, scene, self.most_actors, roster)
        self._recorder = Recorder(self.state, self.origin_m)
        self._plan_period = max(1, round(1.0 / tick_s) // PLANS_PER_SECOND)
        self._watched: dict[int, int] = {}
        self._begin_frame()
        self.steps = LatestSteps(self.state.capacity)
        self.feet = Feet(self.state, self.steps, Ground(scene, grid), tick_s, seed)
        self._spawning = Spawning(
            scene, grid, rules.person_clearance_m, np.random.SeedSequence(seed)
        )
        self._observed = NOBODY

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
            self._people.move()
            self._observed = self._observe()

    def think(self) -> bool:
        """Find the next step of every actor; whether there are any.

        If it raises, every actor is as it was, and `finish(False)` lets them stand. To have the
        same world in a replay, `ActorsStood` is then an input of this tick.
        """
        with self.times.stage("actors"):
            if self._stands:
                self._actors.stand(self._observed)
                return False
            return self._actors.plan(self._observed)

    def finish(self, actors_moved: bool) -> Frame:
        """Move the actors, if they have moved, and say what is new in this tick."""
        with self.times.stage("contacts"):
            pointing = self._place(actors_moved)
            if actors_moved:
                for name, is_open in self._actors.doors_wanted.items():
                    self.doors.want(name, is_open)
            self.contacts.update(self.state)
        with self.times.stage("steps"):
            self.feet.update(self.tick)
        with self.times.stage("encode"):
            people, actors = self.count()
            return Frame(
                tick=self.tick,
                people=people,
                actors=actors,
                left=self._left,
                entered=self._recorder.entered(),
                reshaped=self._recorder.reshaped(),
                joined=self._joined,
                attached=self._attached,
                detached=self._detached,
                acks=self._acks,
                records=self._recorder.changed(),
                steps=self.steps.begun_in(self.tick, self.state.live()),
                events=Events(self._moved_doors, pointing, self._chat, self._plans()),
                outcomes=self._commands.outcomes,
                actors_stood=not actors_moved and len(self._population) > 0,
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

    # --- questions ----------------------------------------------------------------------------

    @property
    def trips(self) -> int:
        """Trips that the actors have completed."""
        return self._actors.trips

    def count(self) -> tuple[int, int]:
        """People and actors in the world."""
        return len(self.state.of_kind(PERSON)), len(self.state.of_kind(ACTOR))

    def route_search(self, avatar_id: int, goal: Point, *, strict: bool = False) -> RouteSearch:
        """A search for a way from where that avatar is now; heavy, and meant for another thread."""
        clearance_m = self.rules.person_clearance_m
        return RouteSearch(self._waves, self._where(avatar_id), goal, clearance_m, strict=strict)

    def outdated_potential(self) -> Callable[[], RenewedPotential] | None:
        """Derives the next potential that is out of date, if any; heavy, safe in any thread.

        Ask between two ticks; potentials are out of date where `doors.derived_outside`.
        """
        return self._population.outdated_potential()

    def actor_work(self) -> Callable[[], ActorsDerived] | None:
        """Derives what the next command on actors waits for, if any; heavy, safe in any thread.

        Ask between two ticks, and let no door move until the result was an input.
        """
        return self._commands.work()

    @property
    def commands_waiting(self) -> int:
        """Number of commands on actors that wait for what is derived for them."""
        return self._commands.waiting

    def check(self, command: ActorCommand) -> Fault | None:
        """Why a command would be refused if it were an input of the next tick, None if it were not.

        Ask between two ticks.
        """
        try:
            check(command, self._population, self.most_actors)
        except Exception as error:  # noqa: BLE001 - whatever it is, it is told
            return fault_of(error)
        return None

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

    def _where(self, avatar_id: int) -> Point:
        slot = self.state.slot(avatar_id)
        x, y = self.state.positions[slot].tolist()
        return x, y, float(self.state.heights[slot])

    # --- inputs -------------------------------------------------------------------------------

    def _begin_frame(self) -> None:
        self._joined: Tickets = []
        self._attached: Tickets = []
        self._detached: list[int] = []
        self._left: list[int] = []
        self._acks: dict[int, int] = {}
        self._chat: list[Line] = []
        self._stands = False
        self._commands.begin()

    def _take(self, item: Input) -> None:
        match item:
            case Join():
                self._joined.append((item.ticket, self._join(item)))
            case MoveDoor():
                self.doors.want(item.name, item.is_open)
            case DoorDerived():
                self._moved_doors |= self.doors.take(item.change)
            case PotentialDerived():
                self._population.renew_potential(item.potential)
            case ActorsDerived():
                self._go(self._commands.take_derived(item, self.tick))
            case ActorsStood():
                self._stands = True
            case Attach() | Detach() | Leave() | Stand() | Steer() | Follow() | Say() | Watch():
                if item.id in self.state:
                    self._apply(item, self.state.slot(item.id))
            case _:
                self._go(self._commands.take(item, self.tick))

    def _go(self, avatars: list[int]) -> None:
        """Actors' avatars have left the world: nobody watches them any more."""
        self._left += avatars
        gone = set(avatars)
        self._watched = {who: one for who, one in self._watched.items() if one not in gone}

    def _join(self, join: Join) -> int:
        place = self._spawning.place(join.at, join.anywhere)
        layer = self._grid.layer_at(place[:2], place[2])
        radius_m = self.rules.person_radius_m
        slot = self.state.add(PERSON, join.name, place, layer, radius_m)
        self._people.stop(slot)
        self.people_seen += 1
        return int(self.state.ids[slot])

    def _apply(self, item: OfPerson, slot: int) -> None:
        match item:
            case Steer():
                self._people.steer(slot, item)
                self._acks[item.id] = item.seq
            case Follow():
                self._people.follow(slot, item)
                self._acks[item.id] = item.seq
            case Stand():
                self._people.stop(slot)
            case Attach():
                self._attached.append((item.ticket, item.id))
            case Detach():
                self._people.stop(slot)
                self._look_no_more(item.id)
                self._detached.append(item.id)
            case Leave():
                self._people.stop(slot)
                self._look_no_more(item.id)
                self._left.append(item.id)
                self.state.remove(item.id)
            case Say():
                self._chat.append(Line(item.id, item.text))
            case Watch():
                self._watched.pop(item.id, None)
                if item.actor_id is not None and self.is_actor(item.actor_id):
                    self._watched[item.id] = item.actor_id

    def _look_no_more(self, avatar_id: int) -> None:
        self._watched.pop(avatar_id, None)
        self._attached = [(ticket, one) for ticket, one in self._attached if one != avatar_id]

    def _plans(self) -> dict[int, Explanation]:
        """Why the watched actors do what they do, of those whose turn it is."""
        in_turn = {a for a in self._watched.values() if (self.tick + a) % self._plan_period == 0}
        return {actor: self.explain(actor) for actor in sorted(in_turn)}

    def _observe(self) -> ObservedPeople:
        state = self.state
        people = state.of_kind(PERSON)
        places = np.column_stack([state.positions[people], state.heights[people]])
        return ObservedPeople(state.ids[people], places)
