"""The parts of `esplanade op` about actors and doors."""

from argparse import Namespace
from typing import Any

from esplanade.commandline.errors import UsageError
from esplanade.operators.asking import asked, change

_POINT = 3


def send(options: Namespace) -> int:
    """Send an actor to a place or a point."""
    target: Any = options.target
    if len(target) == _POINT:
        try:
            target = [float(word) for word in target]
        except ValueError:
            target = " ".join(target)
    else:
        target = " ".join(target)
    return change(options, "send_actor", actor=options.actor, target=target)


def hold(options: Namespace) -> int:
    """Let an actor stand, or go on."""
    return change(options, "hold_actor", actor=options.actor, held=not options.release)


def behaviour_(options: Namespace) -> int:
    """Let actors do something else."""
    return change(options, "set_behaviour", actors=options.actors, behaviour=options.behaviour)


def add(options: Namespace) -> int:
    """Let actors come into the world."""
    if options.count > 1 and (options.id or options.at):
        raise UsageError("--id and --at are for one actor, not for several")
    new: dict[str, Any] = {"behaviour": options.behaviour, "tags": options.tags or []}
    if options.preset:
        new["overrides"] = asked(options, f"/presets/{options.preset}")["values"]
    said = {"id": options.id, "name": options.name, "place": options.at}
    new |= {name: value for name, value in said.items() if value is not None}
    return change(options, "add_actors", actors=[new] * options.count)


def remove(options: Namespace) -> int:
    """Take actors out of the world."""
    return change(options, "remove_actors", actors=options.actors)


def door(options: Namespace) -> int:
    """Open or close a door."""
    return change(options, "move_door", door=options.door, open=options.state == "open")
