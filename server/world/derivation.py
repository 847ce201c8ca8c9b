"""Derives what a command on actors needs before a tick can carry it out."""

from collections.abc import Callable

import numpy as np

from esplanade.actors import Newcomer, Population
from esplanade.actors.placing import Placing
from esplanade.actors.potential_pool import Goal, GoalKey, goal_key, potential_of
from esplanade.planning import Body, Scene
from esplanade.server.world.inputs import ActorCommand, ActorsDerived, AddActors, SetParameters


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
        self._taken = np.column_stack([agents.positions, agents.heights])
        self._derive: Callable[[], ActorsDerived] = lambda: ActorsDerived(command.command)
        match command:
            case SetParameters():
                changes = population.new_bodies(command.actors, command.values)
                self._derive = lambda: self._bodies(changes)
            case AddActors():
                self._derive = lambda: self._newcomers(command)

    def derive(self) -> ActorsDerived:
        """Everything that can be derived now; a fault is told, not raised."""
        try:
            return self._derive()
        except Exception as error:  # noqa: BLE001 - the command is refused, the thread goes on
            return ActorsDerived(self._command.command, fault=str(error))

    def _bodies(self, changes: list[tuple[Goal | None, Body]]) -> ActorsDerived:
        population, fork = self._population, self._fork
        self._know([body for _, body in changes])
        potentials: dict[GoalKey, np.ndarray[tuple[int, ...], np.dtype[np.float32]]] = {}
        for goal, body in changes:
            key = None if goal is None else goal_key(fork, goal, body)
            if key is None or key in potentials or population.navigator.potentials.has(key):
                continue
            potentials[key] = potential_of(fork, key)
        return ActorsDerived(self._command.command, self._grid.bodies_change(fork), potentials)

    def _newcomers(self, command: AddActors) -> ActorsDerived:
        population, fork = self._population, self._fork
        self._know([parameters.body for parameters in command.parameters])
        who = [
            Newcomer(spec.id, spec.behaviour.make(), parameters, spec.place)
            for spec, parameters in zip(command.specs, command.parameters, strict=True)
        ]
        generators = [population.generator(each.id) for each in who]
        places = population.places(who, Placing(fork, self._scene), generators, self._taken)
        change = self._grid.bodies_change(fork)
        return ActorsDerived(self._command.command, change, places=tuple(places))

    def _know(self, bodies: list[Body]) -> None:
        """Let the fork know these bodies all at once: as many as there may be."""
        for body in bodies:
            self._fork.claim(body)
        self._population.navigator.prepare_contacts(bodies)
