"""The options of `esplanade op watch`."""

from argparse import Namespace
from argparse import _SubParsersAction as SubParsers  # argparse names the type nowhere else

from esplanade.commandline.errors import UsageError
from esplanade.commandline.parser import Parser
from esplanade.operators.parts import add_part

CHANNELS = ("events", "changes", "contacts", "series")
EVENT_KINDS = (
    *("join", "leave", "contact", "stop", "no_path", "door", "plan_failure", "late_tick"),
    *("chat", "command", "mark", "report", "pace", "schedule", "trajectories"),
    "recording",
)
_KINDS = f"only events of these kinds: {', '.join(EVENT_KINDS)}"


def add_watch_parts(commands: "SubParsers[Parser]") -> list[Parser]:
    """Add the command, and return its parser."""
    watch = add_part(
        commands,
        "watch_commands:watch",
        "watch",
        "Show what happens in a world as it happens, line by line, until Ctrl-C.",
        "watch",
        "watch events --kind join leave chat",
        "watch contacts",
        "watch series --json >> figures.jsonl",
        more="events: who comes and goes, touches, stops, what operators do. changes: each change\n"
        "of an operator with its values. contacts: each touch with its place. series: the figures\n"
        "of each second. Times are in UTC. With --json each line is a message of the live socket.",
        check=_kinds_of_events,
    )
    watch.add_argument(
        "channels",
        metavar="|".join(CHANNELS),
        nargs="*",
        choices=CHANNELS,
        help="[default: events changes]",
    )
    watch.add_argument(
        "--kind", dest="kinds", metavar="KIND", nargs="+", choices=EVENT_KINDS, help=_KINDS
    )
    watch.add_argument("--json", action="store_true", help="print messages as they come, as JSON")
    return [watch]


def _kinds_of_events(found: Namespace) -> None:
    found.channels = found.channels or ["events", "changes"]
    if found.kinds and "events" not in found.channels:
        raise UsageError("--kind: it is for events")
