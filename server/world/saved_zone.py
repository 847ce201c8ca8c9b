"""The state of a zone as plain data, from which another process goes on."""

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from esplanade.actors import ActorSpec, Population
from esplanade.actors.saved_minds import chance_as_text, load_chance
from esplanade.planning import LayeredGrid
from esplanade.protocol.looks import NO_LOOK, Look, known_look
from esplanade.server.world.actor_commands import ActorCommands
from esplanade.server.world.actors import ActorAvatars
from esplanade.server.world.contacts import Contacts
from esplanade.server.world.doors import Doors
from esplanade.server.world.looks import Looks
from esplanade.server.world.routes import Point
from esplanade.server.world.spawning import Spawning
from esplanade.server.world.state import PERSON, State


class Returning(NamedTuple):
    """A person who was here before a restart, and whose avatar waits."""

    id: int
    name: str
    place: Point
    """Where the avatar stands if the saved zone does not know it."""


class SavedZone:
    """Saves what later ticks of a zone depend on, and loads it into a zone without anybody.

    Names of people are not in it. People stand where they were; what they were doing is over.
    """

    def __init__(
        self,
        state: State,
        population: Population,
        avatars: ActorAvatars,
        commands: ActorCommands,
        doors: Doors,
        spawning: Spawning,
        contacts: Contacts,
        person_radius_m: float,
        grid: LayeredGrid,
        looks: Looks,
    ) -> None:
        self._state = state
        self._population = population
        self._avatars = avatars
        self._commands = commands
        self._doors = doors
        self._spawning = spawning
        self._contacts = contacts
        self._person_radius_m = person_radius_m
        self._grid = grid
        self._looks = looks
        self._spec_texts: dict[object, tuple[ActorSpec, str]] = {}
        """Specifications as text, made anew for those that are others."""

    def save(self) -> dict[str, Any]:
        """Copies of all that later ticks change; call it between two ticks."""
        state = self._state
        people = state.of_kind(PERSON)
        return {
            "people": {
                "ids": state.ids[people],
                "places": np.column_stack([state.positions[people], state.heights[people]]),
                "headings": state.headings[people],
                "looks": state.looks[people],
            },
            "specs": self._specs(),
            "avatars": dict(self._avatars.avatars),
            "actors": self._population.save(),
            "doors": {"open": self._doors.states(), "wanted": self._doors.wanted},
            "chance": chance_as_text(self._spawning.random.bit_generator.state),
            "contacts": [self._contacts.actor_person, self._contacts.actor_actor],
        }

    def load(self, saved: Mapping[str, Any], people: Sequence[Returning]) -> None:
        """Let this zone, in which nobody is, go on from what was saved.

        Raises
        ------
        ValueError, KeyError, TypeError
            Something is missing, or cannot be. Nothing is to be done with this zone then.
        """
        specs = saved_specs(saved)
        self._population.load(saved["actors"], {spec.id: spec.behaviour.make() for spec in specs})
        avatars = {str(actor): _id(avatar) for actor, avatar in saved["avatars"].items()}
        self._check_ids([*avatars.values(), *(person.id for person in people)])
        self._commands.restore(specs)
        self._avatars.restore(avatars, {spec.id: spec.name for spec in specs})
        self._load_people(saved["people"], people)
        for name, is_open in saved["doors"]["wanted"].items():
            self._doors.want(name, bool(is_open))
        load_chance(self._spawning.random, saved["chance"])
        with_people, among_actors = saved["contacts"]
        self._contacts.actor_person = int(with_people)
        self._contacts.actor_actor = int(among_actors)

    def put(self, person: Returning, heading: float = 0.0, look: Look = NO_LOOK) -> None:
        """Let a person's avatar stand where it was, or on the nearest ground where it can.

        It waits for its person, who is away.
        """
        if not all(map(math.isfinite, (*person.place, heading))):
            raise ValueError(f"the place of person {person.id} is not finite")
        place = self._spawning.place(person.place)
        layer = self._grid.layer_at(place[:2], place[2])
        slot = self._state.add(PERSON, person.name, place, layer, self._person_radius_m, person.id)
        self._state.headings[slot] = heading
        self._looks.wear(slot, look)
        self._state.away[slot] = True

    def _load_people(self, saved: Mapping[str, Any], people: Sequence[Returning]) -> None:
        ids, places, headings = (np.asarray(saved[k]) for k in ("ids", "places", "headings"))
        # Checkpoints of older programs know of no looks.
        looks = [known_look(look) for look in np.asarray(saved.get("looks", ())).tolist()]
        known = {
            int(avatar): (tuple(map(float, place)), float(heading), look)
            for avatar, place, heading, look in zip(
                ids, places, headings, looks or [NO_LOOK] * len(ids), strict=True
            )
        }
        for person in people:
            place, heading, look = known.get(person.id, (person.place, 0.0, NO_LOOK))
            x, y, z = place
            self.put(person._replace(place=(x, y, z)), heading, look)

    def _check_ids(self, ids: Sequence[int]) -> None:
        if len(set(ids)) < len(ids):
            raise ValueError("two avatars have one id")
        if not all(0 < one < self._state.next_id for one in ids):
            raise ValueError("an avatar has an id that was never given away")

    def _specs(self) -> list[str]:
        specs = self._commands.specs
        known = self._spec_texts
        if len(known) > len(specs):
            known = {actor: known[actor] for actor in specs if actor in known}
        for actor, spec in specs.items():
            if actor not in known or known[actor][0] is not spec:
                known[actor] = spec, spec.model_dump_json()
        self._spec_texts = known
        return [known[actor][1] for actor in specs]


def saved_specs(saved: Mapping[str, Any]) -> list[ActorSpec]:
    """The specifications of the actors of a saved zone.

    Raises
    ------
    ValueError, KeyError, TypeError
        They are not there, or one cannot be.
    """
    return [ActorSpec.model_validate_json(text) for text in saved["specs"]]


def set_doors(grid: LayeredGrid, saved: Mapping[str, Any]) -> None:
    """Let the doors of a grid stand as they did in a saved zone.

    Raises
    ------
    ValueError, KeyError, TypeError
        There is a door that the grid does not have.
    """
    for name, is_open in saved["doors"]["open"].items():
        if grid.doors.is_open(name) != bool(is_open):
            grid.set_door(name, bool(is_open))


def _id(value: object) -> int:
    if not isinstance(value, int):
        raise TypeError(f"the id of an avatar is {value!r}")
    return value
