"""The options of the parts of `esplanade op` about actors and doors."""

from argparse import ArgumentTypeError
from argparse import _SubParsersAction as SubParsers  # argparse names the type nowhere else
from typing import Any

from esplanade.commandline.parser import Parser
from esplanade.commandline.readers import Number, Text, Whole
from esplanade.operators.parts import add_note, add_part

_METRE = Number(-100_000.0, 100_000.0)


def add_actor_parts(commands: "SubParsers[Parser]") -> list[Parser]:
    """Add the commands, and return their parsers."""
    return [*_actors(commands), *_crowd(commands)]


def behaviour(text: str) -> dict[str, Any]:
    """A behaviour by its kind, or as JSON.

    Raises
    ------
    ArgumentTypeError
        It is neither.
    """
    import json  # noqa: PLC0415 (only where JSON is given)

    if not text.startswith("{"):
        return {"kind": text}
    try:
        found: dict[str, Any] = json.loads(text)
    except ValueError as error:
        raise ArgumentTypeError(f"this is no JSON: {error}") from None
    return found


def _actors(commands: "SubParsers[Parser]") -> list[Parser]:
    send = add_part(
        commands,
        "actor_commands:send",
        "send",
        "Send an actor to a place or a point, where it stays.",
        "send actor-1 fountain",
        "send actor-1 12.5 4 0",
        more="The places of the scene are in GET /api/v1/world.",
    )
    send.add_argument("actor", metavar="ACTOR", type=Text(), help="such as actor-1")
    send.add_argument(
        "target", metavar="PLACE", nargs="+", type=Text(), help="a place's name, or X Y Z in metres"
    )
    add_note(send)
    hold = add_part(
        commands,
        "actor_commands:hold",
        "hold",
        "Let an actor stand where it is, making way, until it is let go.",
        "hold actor-1",
        "hold actor-1 --release",
    )
    hold.add_argument("actor", metavar="ACTOR", type=Text(), help="such as actor-1")
    hold.add_argument("--release", action="store_true", help="let it go on with what it did")
    add_note(hold)
    led = add_part(
        commands,
        "actor_commands:behaviour_",
        "behaviour",
        "Let actors do something else from now on.",
        "behaviour wander actor-1 actor-2",
        """behaviour '{"kind": "guide", "tour": ["door", "fountain"]}' actor-3""",
        more="The kinds, and what each can be told, are `behaviours` in GET /api/v1/schema.",
    )
    led.add_argument(
        "behaviour", metavar="BEHAVIOUR", type=behaviour, help="its kind, or all of it as JSON"
    )
    led.add_argument("actors", metavar="ACTOR", nargs="+", type=Text(), help="actors' ids")
    add_note(led)
    return [send, hold, led]


def _crowd(commands: "SubParsers[Parser]") -> list[Parser]:
    add = add_part(
        commands,
        "actor_commands:add",
        "add",
        "Let actors come into the world: all of them, or none.",
        "add --count 20 --behaviour wander --preset brisk --tag wave",
        "add --id actor-40 --name Ada --at 3 4 0",
    )
    add.add_argument("--count", metavar="N", type=Whole(1, 200), default=1, help="[default: 1]")
    add.add_argument("--id", metavar="ID", type=Text(), help="of the one [default: the next free]")
    add.add_argument("--name", metavar="TEXT", type=Text(), help="what others see it called")
    add.add_argument(
        "--behaviour",
        metavar="BEHAVIOUR",
        type=behaviour,
        default={"kind": "wander"},
        help="its kind, or all of it as JSON [default: wander]",
    )
    add.add_argument("--preset", metavar="NAME", type=Text(), help="values of their own")
    add.add_argument("--tag", dest="tags", metavar="TAG", action="append", help="may be repeated")
    add.add_argument(
        "--at", metavar=("X", "Y", "Z"), nargs=3, type=_METRE, help="[default: a free place]"
    )
    add_note(add)
    remove = add_part(
        commands,
        "actor_commands:remove",
        "remove",
        "Take actors out of the world: all of them, or none.",
        "remove actor-3 actor-4",
    )
    remove.add_argument("actors", metavar="ACTOR", nargs="+", type=Text(), help="actors' ids")
    add_note(remove)
    door = add_part(
        commands,
        "actor_commands:door",
        "door",
        "Open or close a door, once nobody stands in its way.",
        "door lobby close",
    )
    door.add_argument("door", metavar="DOOR", type=Text(), help="its name in the scene")
    door.add_argument("state", metavar="open|close", choices=("open", "close"), help="the wish")
    add_note(door)
    return [add, remove, door]
