"""Derives what a command on actors needs before a tick can carry it out."""

from functools import partial

import numpy as np
from numpy.typing import NDArray

from esplanade.actors import Newcomer, Population
from esplanade.actors.placing import Placing
from esplanade.actors.potential_pool import Goal, GoalKey, goal_key, potential_of
from esplanade.planning import Body, Scene
from esplanade.server.world.helped import each_of
from esplanade.server.world.inputs import (
    ActorCommand,
    ActorsDerived,
    AddActors,
    SetParameters,
    parts_of,
)
from esplanade.server.world.routes import Point


class Derivation:
    """One command's. It is made between two ticks; `derive` may then run in any thread.

    It works on a fork of the grid, which holds as long as no door moves meanwhile. Where a door
    does, all is derived again in the tick that carries the command out.
    """

    def __init__(self, population: Population, scene: Scene, command: ActorCommand) -> None:
        self._population = population
        self._scene = scene
        self._command = command
        self._grid = population.grid
        self._fork = population.grid.fork()
        agents = population.table.agents
        self._taken = np.column_stack(
            [agents.positions, agents.heights, agents.parameters["radius_m"]]
        )
        self._changes: list[tuple[Goal | None, Body]] = []
        self._newcomers: list[Newcomer] = []
        for one in parts_of(command):
            match one:
                case SetParameters():
                    self._changes += population.new_bodies(one.actors, one.values)
                case AddActors():
                    self._newcomers += [
                        Newcomer(
                            spec.id, spec.behaviour.make(), parameters, spec.place, near=spec.near
                        )
                        for spec, parameters in zip(one.specs, one.parameters, strict=True)
                    ]

    def derive(self) -> ActorsDerived:
        """Everything that can be derived now; a fault is told, not raised."""
        try:
            return self._derive()
        except Exception as error:  # noqa: BLE001 - the command is refused, the thread goes on
            return ActorsDerived(self._command.command, fault=str(error))

    def _derive(self) -> ActorsDerived:
        changed = [body for _, body in self._changes]
        self._know([*changed, *(each.parameters.body for each in self._newcomers)])
        potentials = self._potentials()
        places = self._places()
        bodies = self._grid.bodies_change(self._fork) if changed or self._newcomers else None
        return ActorsDerived(self._command.command, bodies, potentials, tuple(places))

    def _potentials(self) -> dict[GoalKey, NDArray[np.float32]]:
        fork, there = self._fork, self._population.navigator.potentials
        found = [goal_key(fork, goal, body) for goal, body in self._changes if goal is not None]
        keys = [key for key in dict.fromkeys(found) if key is not None and not there.has(key)]
        for *_, body in keys:
            fork.row_of(body)  # derived here, since two threads share the fork
        return dict(zip(keys, each_of(partial(potential_of, fork), keys), strict=True))

    def _places(self) -> list[Point]:
        """Places of all newcomers, in the order of the commands that bring them."""
        population = self._population
        generators = [population.generator(each.id) for each in self._newcomers]
        placing = Placing(self._fork, self._scene)
        return population.places(self._newcomers, placing, generators, self._taken)

    def _know(self, bodies: list[Body]) -> None:
        """Let the fork know these bodies all at once: as many as there may be."""
        for body in bodies:
            self._fork.claim(body)
        self._population.navigator.prepare_contacts(bodies)
