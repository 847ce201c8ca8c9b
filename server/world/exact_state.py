"""The exact state of a zone: another process goes on from it bit for bit.

A restart keeps less (`saved_zone.py`): people stand then, and nobody's past is known. Here stands
everything that a later tick depends on. What follows from the ground is not in it but how it was
derived, so that some hundred kilobytes hold a world of hundreds.
"""

from collections.abc import Hashable, Mapping
from typing import Any, Final, NamedTuple, cast

import numpy as np

from esplanade.actors import ActorSpec, Behaviour, Population
from esplanade.actors.saved_minds import chance_as_text, load_chance
from esplanade.planning import LayeredGrid
from esplanade.server.world.actor_commands import ActorCommands
from esplanade.server.world.actors import ActorAvatars
from esplanade.server.world.contacts import Contacts
from esplanade.server.world.doors import Doors
from esplanade.server.world.frame import Recorder
from esplanade.server.world.inputs import ActorCommand
from esplanade.server.world.latest_steps import LatestSteps
from esplanade.server.world.people import People
from esplanade.server.world.person_inputs import PersonInputs
from esplanade.server.world.recorded_inputs import plain_command, recorded
from esplanade.server.world.spawning import Spawning
from esplanade.server.world.state import State
from esplanade.server.world.walking import Feet

NAMES: Final = "names"
"""The one part that nothing depends on: what people are called, by the ids of their avatars."""


class Parts(NamedTuple):
    """All of a zone that changes from tick to tick."""

    state: State
    grid: LayeredGrid
    people: People
    persons: PersonInputs
    population: Population
    avatars: ActorAvatars
    commands: ActorCommands
    doors: Doors
    spawning: Spawning
    contacts: Contacts
    feet: Feet
    steps: LatestSteps
    told: Recorder


class ExactState:
    """Saves all parts of a zone as plain data, by the names of these parts, and loads them."""

    def __init__(self, parts: Parts) -> None:
        self._parts = parts
        self._specs: dict[object, tuple[ActorSpec, str]] = {}
        """Specifications as text, made anew for those that are others."""

    def save(self) -> dict[str, Any]:
        """Copies of all that later ticks change; call it between two ticks."""
        p = self._parts
        state = p.state
        live = state.live()
        names = [state.names[slot] for slot in live.tolist()]
        return {
            NAMES: dict(zip(state.ids[live].tolist(), names, strict=True)),
            "avatars": state.save(),
            "people": {**p.people.save(), "watched": p.persons.save()},
            "actors": p.population.save_exactly(),
            "shown": {**p.avatars.save(), "specs": self._spec_texts()},
            "commands": {
                "outside": p.commands.derived_outside,
                "waiting": [recorded(each) for each in p.commands.those_waiting],
            },
            "doors": {
                "open": p.doors.states(),
                "wanted": p.doors.wanted,
                "outside": p.doors.derived_outside,
            },
            "chance": chance_as_text(p.spawning.random.bit_generator.state),
            "contacts": {
                "counts": [int(p.contacts.actor_person), int(p.contacts.actor_actor)],
                "touching": p.contacts.touching,
            },
            "feet": p.feet.save(),
            "steps": p.steps.save(live),
            "told": p.told.save(),
        }

    def load(self, saved: Mapping[str, Any]) -> None:
        """Let the zone go on from what was saved; doors move to where they stood.

        Raises
        ------
        ValueError, KeyError, TypeError
            Something is missing, or cannot be. Nothing is to be done with this zone then.
        """
        p = self._parts
        names = {int(avatar): str(name) for avatar, name in saved[NAMES].items()}
        specs = [ActorSpec.model_validate_json(text) for text in saved["shown"]["specs"]]
        self._move_doors(saved["doors"])
        p.state.load(saved["avatars"], names)
        behaviours: dict[Hashable, Behaviour] = {spec.id: spec.behaviour.make() for spec in specs}
        p.population.load_exactly(saved["actors"], behaviours)
        commands = saved["commands"]
        p.commands.derived_outside = bool(commands["outside"])
        waiting = [cast(ActorCommand, plain_command(each)) for each in commands["waiting"]]
        p.commands.wait(waiting)
        p.avatars.load(saved["shown"])
        p.commands.restore(specs)
        p.people.load(saved["people"])
        p.persons.load(saved["people"]["watched"])
        load_chance(p.spawning.random, saved["chance"])
        with_people, among_actors = saved["contacts"]["counts"]
        p.contacts.actor_person, p.contacts.actor_actor = int(with_people), int(among_actors)
        p.contacts.touching = np.array(saved["contacts"]["touching"], dtype=np.int64)
        p.steps.load(p.state.live(), saved["steps"])
        p.feet.load(saved["feet"])
        p.told.load(saved["told"])

    def _move_doors(self, saved: Mapping[str, Any]) -> None:
        doors, grid = self._parts.doors, self._parts.grid
        if saved["open"].keys() != doors.states().keys():
            raise ValueError("these are not the doors of the scene")
        for name, is_open in saved["open"].items():
            if grid.doors.is_open(name) != bool(is_open):
                grid.set_door(name, bool(is_open))
        doors.derived_outside = bool(saved["outside"])
        doors.want_only(saved["wanted"])

    def _spec_texts(self) -> list[str]:
        specs = self._parts.commands.specs
        known = self._specs
        if len(known) > len(specs):
            known = {actor: known[actor] for actor in specs if actor in known}
        for actor, spec in specs.items():
            if actor not in known or known[actor][0] is not spec:
                known[actor] = spec, spec.model_dump_json()
        self._specs = known
        return [known[actor][1] for actor in specs]
