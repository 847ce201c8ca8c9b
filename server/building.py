"""Builds the world of a loaded scene, ready to tick."""

import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial

from esplanade.actors import Population
from esplanade.planning import LayeredGrid
from esplanade.planning.routes.storey_heights import reached_from, storeys_of
from esplanade.policies.names import label_of
from esplanade.server.checkpoint.parts import with_faults_told
from esplanade.server.driving.settings import USUAL_COUNT
from esplanade.server.loading import LoadedScene, LoadingError
from esplanade.server.populating import default_roster, names_of, populate_from, with_driven
from esplanade.server.recovery import Recovery
from esplanade.server.rehearsal import rehearse, rehearse_walking
from esplanade.server.roster import Roster
from esplanade.server.settings import ServerSettings
from esplanade.server.warming import kernels_compiled
from esplanade.server.world.saved_zone import saved_specs, set_doors
from esplanade.server.world.zone import ROOM_FOR_ACTORS, Zone


def build_world(
    loaded: LoadedScene, settings: ServerSettings, recovery: Recovery | None = None
) -> tuple[Population, Zone, list[float]]:
    """The world of a loaded scene, ready to tick: its actors, itself, the heights of its storeys.

    It compiles what is not compiled yet, and takes a while.

    Raises
    ------
    LoadingError
        The scene has no room for the actors.
    """
    with kernels_compiled(lambda: rehearse_walking(loaded.rules, settings.tick_s)) as ready_to_plan:
        return _build_warm(loaded, settings, ready_to_plan, recovery)


def _build_warm(
    loaded: LoadedScene,
    settings: ServerSettings,
    ready_to_plan: Callable[[], None],
    recovery: Recovery | None,
) -> tuple[Population, Zone, list[float]]:
    tick_s, seed = settings.tick_s, settings.seed
    try:
        grid = LayeredGrid.from_scene(loaded.scene)
        roster = loaded.roster or default_roster(loaded.scene, settings.actors, seed)
        if settings.policy is not None:
            count = USUAL_COUNT if settings.policy_actors is None else settings.policy_actors
            roster = with_driven(roster, label_of(settings.policy), count)
        names = names_of(roster)
        saved = None if recovery is None else recovery.zone
        if saved is not None:
            with_faults_told("zone", partial(set_doors, grid), saved)
            if len(saved["specs"]) > len(names) + ROOM_FOR_ACTORS:
                names = {spec.id: spec.name for spec in saved_specs(saved)}
            roster = Roster()  # the saved actors come in when kernels are ready
        population = populate_from(
            roster,
            grid,
            loaded.scene,
            tick_s,
            seed,
            person_radius_m=settings.person_radius_m,
        )
        world = Zone(
            loaded.scene,
            grid,
            population,
            names,
            loaded.rules,
            tick_s=tick_s,
            max_people=settings.max_clients,
            seed=seed,
            clock=time.perf_counter,
            roster=roster.actors,
        )
    except ValueError as error:
        raise LoadingError(f"scene {loaded.scene.name!r}: {error}") from error
    population.warm_up(ready_to_plan)
    if recovery is not None:
        _bring_back(world, recovery)
    rehearse(loaded.rules, tick_s)
    starts = [(*spawn.position, spawn.z_m) for spawn in loaded.scene.spawns]
    storeys = storeys_of(grid, reached_from(grid, starts))
    return population, world, [round(height, 2) for height in storeys]


def _bring_back(world: Zone, recovery: Recovery) -> None:
    """Let a world without anybody go on from what was recovered."""
    if recovery.ids is not None:
        world.state.begin_ids(*recovery.ids)
    if recovery.zone is not None:
        with_faults_told("zone", lambda saved: world.load(saved, recovery.people), recovery.zone)
    else:
        for person in recovery.people:
            world.put(person)
    world.skip_to(recovery.tick)


def with_roster(loaded: LoadedScene, settings: ServerSettings) -> LoadedScene:
    """A scene with the actors of its own roster, or with those that it usually has."""
    if loaded.roster is not None:
        return loaded
    roster = default_roster(loaded.scene, settings.actors, settings.seed)
    return replace(loaded, roster=roster)
