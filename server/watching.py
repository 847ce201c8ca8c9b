"""The metrics of a world, of searches for routes, and of operators' commands."""

from functools import partial

from esplanade.actors import Outcome, Population
from esplanade.server.console.console import Console
from esplanade.server.console.gate import Gate
from esplanade.server.metrics import Metrics
from esplanade.server.net.door_commands import DoorCommands
from esplanade.server.net.route_requests import RouteRequests
from esplanade.server.world.zone import Zone


def watch_world(world: Zone, population: Population, metrics: Metrics) -> None:
    """Tell in the metrics who is in a world, and what goes on there."""
    metrics.gauge("people", "People in the world", lambda: world.count()[0])
    metrics.gauge("actors", "Actors in the world", lambda: world.count()[1])
    metrics.total("people_seen", "People who came in", lambda: world.people_seen)
    metrics.total("actor_trips", "Trips that actors completed", lambda: world.trips)
    for outcome, meaning in (
        (Outcome.NEAR, "beside their goal, since somebody was there"),
        (Outcome.BLOCKED, "before somebody who stood in the way"),
        (Outcome.NO_WAY, "since no way led to the goal"),
    ):
        metrics.total(
            f"actor_trips_{outcome.name.lower()}",
            f"Trips of actors that ended {meaning}",
            partial(_ended, world, outcome),
        )
    detours = population.navigator.detours
    metrics.gauge("detours", "Goals with a way around people who stand", lambda: len(detours))
    metrics.total(
        "detours_refused",
        "Looks at a way that was shut, for which none around was derived: there are too many",
        lambda: detours.refused,
    )
    contacts = world.contacts
    metrics.total("contacts_actor_person", "Actor-person contacts", lambda: contacts.actor_person)
    metrics.total("contacts_actor_actor", "Actor-actor contacts", lambda: contacts.actor_actor)
    metrics.gauge(
        "doors_waiting", "Doors that are wanted open or closed, and are not", world.doors.waiting
    )
    feet = world.feet
    metrics.total("steps", "Steps that began or were re-aimed", lambda: feet.begun)
    metrics.total("walkers_lost", "Walkers set back onto their feet", lambda: feet.lost)
    metrics.total("stepping_failures", "Ticks in which nobody could step", lambda: feet.failures)
    metrics.gauge(
        "commands_waiting",
        "Commands on actors that wait for what is derived for them",
        lambda: world.commands_waiting,
    )
    metrics.total(
        "inputs_failed",
        "Inputs and movements of actors that failed by a fault of the server",
        lambda: world.failures,
    )
    metrics.gauge(
        "potentials_outdated",
        "Potentials of goals that wait to be derived anew since a door has moved",
        lambda: population.navigator.potentials.outdated_rows,
    )


def _ended(world: Zone, outcome: Outcome) -> int:
    return world.ended[outcome]


def watch_routes(route_requests: RouteRequests, metrics: Metrics) -> None:
    """Tell in the metrics what searches for routes cost."""
    metrics.gauge("routes_waiting", "People who wait for a route", lambda: route_requests.waiting)
    metrics.total(
        "routes_refused",
        "Routes not sought because searches had cost too much",
        lambda: route_requests.refused,
    )
    metrics.total(
        "route_search_seconds",
        "Processor time of searches for routes",
        lambda: route_requests.search_s,
    )


def watch_console(console: Console, doors: DoorCommands, metrics: Metrics) -> None:
    """Tell in the metrics what operators want and what waits of it."""
    metrics.gauge(
        "door_commands_waiting",
        "Doors that operators who walk about want moved, and that wait",
        lambda: doors.waiting,
    )
    metrics.gauge(
        "changes_ongoing",
        "Changes of operators that go on: dragged values and ramps",
        lambda: console.ongoing.under_way,
    )
    metrics.gauge(
        "schedules_due",
        "Schedules and guards that wait to be carried out",
        lambda: console.scheduler.waiting,
    )
    metrics.gauge(
        "commands_in_turn",
        "Operators' lists of commands that are carried out or wait for their turn",
        lambda: console.waiting,
    )


def watch_gate(metrics: Metrics, gate: Gate) -> None:
    """Tell in the metrics how many requests of operators wait, and how many came too soon."""
    metrics.gauge(
        "requests_under_way",
        "Requests of operators that wait for the world",
        lambda: gate.under_way,
    )
    metrics.total(
        "commands_braked",
        "Operators' commands, or lists of them, that came too soon",
        lambda: gate.brakes.refused,
    )
