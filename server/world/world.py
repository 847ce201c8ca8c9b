"""A zone, tick by tick: begin (people), think (actors, elsewhere), finish (what everyone sees)."""

from collections.abc import Callable, Hashable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from esplanade.actors import Explanation, ObservedPeople, Population
from esplanade.actors.locomotion.footsteps.ground import Ground
from esplanade.actors.people import NOBODY
from esplanade.planning import LayeredGrid, Scene
from esplanade.server.world.actors import ActorAvatars
from esplanade.server.world.contacts import Contacts
from esplanade.server.world.doors import Doors
from esplanade.server.world.inputs import (
    Attach,
    Detach,
    Follow,
    Input,
    Join,
    Leave,
    MoveDoor,
    Stand,
    Steer,
)
from esplanade.server.world.interest import Changes, Interest
from esplanade.server.world.people import People
from esplanade.server.world.routes import Point, Route, find_route, straight_route
from esplanade.server.world.rules import Rules
from esplanade.server.world.snapshots import SnapshotEncoder, Snapshots
from esplanade.server.world.spawning import Spawning
from esplanade.server.world.stage_times import StageTimes
from esplanade.server.world.state import ACTOR, KINDS, PERSON, State
from esplanade.server.world.step_interest import LatestSteps, StepBlocks, StepInterest
from esplanade.server.world.walking import Feet

Joined = list[tuple[int, int]]
"""(ticket, avatar's id) of everyone new."""


@dataclass(frozen=True)
class WorldUpdate:
    """News of a tick for its viewers, in this order."""

    doors: dict[str, bool]
    """Doors that opened or closed."""
    changes: Changes
    pointing: dict[int, Point | None]
    """The places that actors point at since this tick, by their ids; None for none any more."""
    steps: StepBlocks
    """For the viewers of `snapshots`, in their order."""
    snapshots: Snapshots


class World:
    """State of one zone and the order in which it changes. Time is `tick * tick_s`.

    A tick is `begin`, `think`, `finish`. `think` is the heavy part and may run in another
    thread, provided that the world is only asked questions meanwhile, and not
    to explain an actor. Same scene, seed and inputs give the same world, bit for bit.
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
    ) -> None:
        self.scene = scene
        self.rules = rules
        self.tick_s = tick_s
        self.tick = 0
        self.people_seen = 0
        self.actor_names = tuple(names.values())
        self.origin_m = (scene.bounds[0], scene.bounds[1])
        self.state = State(max_people + len(names))
        self.contacts = Contacts()
        self.times = StageTimes(clock)
        self._grid = grid
        self.doors = Doors(self.state, grid)
        self._moved_doors: dict[str, bool] = {}
        self._people = People(self.state, grid, rules, tick_s)
        self._population = population
        self._actors = ActorAvatars(self.state, population, names, tick_s)
        self._interest = Interest(self.state, rules)
        self._encoder = SnapshotEncoder(self.state, self.origin_m)
        self.steps = LatestSteps(self.state.capacity)
        self.feet = Feet(self.state, self.steps, Ground(scene, grid), tick_s, seed)
        self._step_interest = StepInterest(self.state, rules)
        self._spawning = Spawning(
            scene, grid, rules.person_clearance_m, np.random.SeedSequence(seed)
        )
        self._observed = NOBODY

    # --- one tick -----------------------------------------------------------------------------

    def begin(self, inputs: Iterable[Input]) -> Joined:
        """Take in what happened outside and move the people. Inputs of those who left are void."""
        self.tick += 1
        self.state.before[:] = self.state.positions
        joined: Joined = []
        with self.times.stage("drain"):
            for item in inputs:
                if isinstance(item, Join):
                    joined.append((item.ticket, self._join(item)))
                elif isinstance(item, MoveDoor):
                    self.doors.want(item.name, item.is_open)
                elif item.id in self.state:
                    self._apply(item, self.state.slot(item.id))
            self._moved_doors = self.doors.update()
            if self._moved_doors:
                self._population.ground_changed()
        with self.times.stage("people"):
            self._people.move()
            self._observed = self._observe()
        return joined

    def think(self) -> bool:
        """Find the next step of every actor; whether there are any."""
        with self.times.stage("actors"):
            return self._actors.plan(self._observed)

    def finish(self, actors_moved: bool) -> WorldUpdate:
        """Move the actors, if they have moved, and work out what each viewer is to be told."""
        with self.times.stage("contacts"):
            pointing = self._actors.place(actors_moved)
            if actors_moved:
                for name, is_open in self._actors.doors_wanted.items():
                    self.doors.want(name, is_open)
            self.contacts.update(self.state)
        with self.times.stage("steps"):
            self.feet.update(self.tick)
        with self.times.stage("interest"):
            self._encoder.refresh(self.tick)
            places_cm = self._encoder.places_cm()
            changes = self._interest.update(places_cm, self.tick)
            self._step_interest.update(self._interest, places_cm, self.tick)
        with self.times.stage("encode"):
            viewers = self._interest.viewers()
            snapshots = self._encoder.encode(self._interest, self.tick)
            written = self._encoder.written[viewers]
            steps = self._step_interest.encode(self._interest, self.steps, viewers, written)
        return WorldUpdate(self._moved_doors, changes, pointing, steps, snapshots)

    def wrote(self, snapshots: Snapshots, places: list[int]) -> None:
        """The snapshots at these places were sent, and the steps; the next ones build on them."""
        self._encoder.wrote(snapshots, places)

    # --- questions ----------------------------------------------------------------------------

    @property
    def trips(self) -> int:
        """Trips that the actors have completed."""
        return self._actors.trips

    def count(self) -> tuple[int, int]:
        """People and actors in the world."""
        return len(self.state.of_kind(PERSON)), len(self.state.of_kind(ACTOR))

    def describe(self, slot: int) -> dict[str, object]:
        """An avatar as the fields of `esplanade.protocol.messages.Entity`."""
        state = self.state
        x, y, z, heading = self._encoder.shown(slot)
        return {
            "id": int(state.ids[slot]),
            "kind": KINDS[state.kinds[slot]].value,
            "name": state.names[slot],
            "layer": int(state.layers[slot]),
            "x": x,
            "y": y,
            "z": z,
            "heading": heading,
            "radius": float(state.radii[slot]),
            "leg_m": float(state.legs_m[slot]),
            "stature_m": float(state.statures_m[slot]),
            "points_at": self._actors.pointing.get(int(state.ids[slot])),
        }

    def straight_route(self, avatar_id: int, goal: Point) -> Route | None:
        """The straight way from where that avatar is, if nothing stands between; quick."""
        here = self._where(avatar_id)
        return straight_route(self._grid, here, goal, self.rules.person_clearance_m)

    def route_finder(self, avatar_id: int, goal: Point) -> Callable[[], Route | None]:
        """A search for a way from where that avatar is now; heavy, and safe in any thread."""
        clearance_m = self.rules.person_clearance_m
        return partial(find_route, self._grid, self._where(avatar_id), goal, clearance_m)

    @property
    def walkers_shown(self) -> int:
        """Number of avatars whose steps are sent, counted for each viewer."""
        return self._step_interest.shown

    def sees(self, viewer_id: int, avatar_id: int) -> bool:
        """Whether that viewer has that avatar in view."""
        if viewer_id not in self.state or avatar_id not in self.state:
            return False
        viewer, slot = self.state.slot(viewer_id), self.state.slot(avatar_id)
        return bool(self._interest.since[viewer, slot])

    def seen_by(self, avatar_id: int) -> list[int]:
        """Ids of the viewers who have that avatar in view."""
        if avatar_id not in self.state:
            return []
        viewers = self._interest.seen_by(self.state.slot(avatar_id))
        ids: list[int] = self.state.ids[viewers].tolist()
        return ids

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

    def _join(self, join: Join) -> int:
        place = self._spawning.place(join.at, join.anywhere)
        layer = self._grid.layer_at(place[:2], place[2])
        radius_m = self.rules.person_radius_m
        slot = self.state.add(PERSON, join.name, place, layer, radius_m)
        self._people.stop(slot)
        self._attach(slot)
        self.people_seen += 1
        return int(self.state.ids[slot])

    def _attach(self, slot: int) -> None:
        self._interest.attach(slot)
        self._step_interest.attach(slot)
        self._encoder.attach(slot)

    def _apply(self, item: Attach | Detach | Leave | Stand | Steer | Follow, slot: int) -> None:
        match item:
            case Steer():
                self._people.steer(slot, item)
                self._encoder.acks[slot] = item.seq
            case Follow():
                self._people.follow(slot, item)
                self._encoder.acks[slot] = item.seq
            case Stand():
                self._people.stop(slot)
            case Attach():
                self._attach(slot)
            case Detach():
                self._people.stop(slot)
                self._interest.detach(slot)
                self._step_interest.detach(slot)
            case Leave():
                self._people.stop(slot)
                self._interest.remove(slot, item.id)
                self._step_interest.remove(slot)
                self.state.remove(item.id)

    def _observe(self) -> ObservedPeople:
        state = self.state
        people = state.of_kind(PERSON)
        places = np.column_stack([state.positions[people], state.heights[people]])
        return ObservedPeople(state.ids[people], places)
