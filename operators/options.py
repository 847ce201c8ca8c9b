"""The options of the parts of `esplanade op` that ask a server that runs."""

from argparse import _SubParsersAction as SubParsers  # argparse names the type nowhere else

from esplanade.commandline.parser import Parser
from esplanade.commandline.readers import Span, Whole
from esplanade.operators.account_options import add_account_parts
from esplanade.operators.actor_options import add_actor_parts
from esplanade.operators.login_options import add_login_parts
from esplanade.operators.parts import add_json, add_note, add_part, add_scope, assignment
from esplanade.operators.people_options import add_people_parts
from esplanade.operators.preset_options import add_preset_parts
from esplanade.operators.schedule_options import add_schedule_parts
from esplanade.operators.scopes import guard
from esplanade.operators.time_options import add_time_parts
from esplanade.operators.watch_options import add_watch_parts


def add_parts(commands: "SubParsers[Parser]") -> list[Parser]:
    """Add the commands, and return their parsers."""
    return [
        *add_login_parts(commands),
        *_parameters(commands),
        *_history(commands),
        *add_preset_parts(commands),
        *add_schedule_parts(commands),
        *add_actor_parts(commands),
        *add_people_parts(commands),
        *add_time_parts(commands),
        *add_watch_parts(commands),
        *add_account_parts(commands),
    ]


def _parameters(commands: "SubParsers[Parser]") -> list[Parser]:
    get = add_part(
        commands,
        "commands:get_",
        "get",
        "Show an actor's parameters and where each comes from.",
        "get",
        "get actor-1",
        "get actor-1 --json",
    )
    get.add_argument("actor", metavar="ACTOR", nargs="?", help="such as actor-1 [default: all]")
    add_json(get)
    made = add_part(
        commands,
        "commands:set_",
        "set",
        "Set parameters of all actors, of a group, or of one.",
        'set risk_weight=12 foresight_s=4 --group hurried --note "queue at the door"',
        "set risk_weight=20 --over 30s",
        "set speed_mps=1.5 --guard 'contacts_per_minute>3/10s'",
        "set radius_m=0.3 --actor actor-1 --dry-run",
        more="A guard takes the change back by itself, within an hour, whether you look or not.",
    )
    made.add_argument(
        "values", metavar="NAME=VALUE", nargs="+", type=assignment, help="such as risk_weight=12"
    )
    add_scope(made)
    add_note(made)
    made.add_argument(
        "--if-revision", metavar="N", type=Whole(0), help="only if none was changed after that"
    )
    made.add_argument("--over", metavar="SPAN", type=Span(), help="go there evenly over this time")
    made.add_argument(
        "--guard",
        metavar="CONDITION",
        type=guard,
        help="take it back if this holds, such as people>40 or contacts_per_minute>3/10s",
    )
    clear = add_part(
        commands,
        "commands:clear_",
        "clear",
        "Take values of a scope away: wider scopes show again.",
        "clear risk_weight --group hurried",
        "clear --actor actor-1",
    )
    clear.add_argument("names", metavar="NAME", nargs="*", help="parameters [default: all of them]")
    add_scope(clear)
    add_note(clear)
    return [get, made, clear]


def _history(commands: "SubParsers[Parser]") -> list[Parser]:
    undo = add_part(
        commands,
        "commands:undo_",
        "undo",
        "Take a change back, if nobody has changed the same since.",
        "undo",
        "undo 117",
        "undo --anybody",
    )
    undo.add_argument(
        "change", metavar="CHANGE", nargs="?", type=Whole(1), help="[default: your own latest]"
    )
    undo.add_argument("--anybody", action="store_true", help="the latest, whoever made it")
    add_note(undo)
    redo = add_part(commands, "commands:redo_", "redo", "Make anew what you took back last.")
    add_note(redo)
    changes = add_part(
        commands,
        "history_commands:changes_",
        "changes",
        "List the latest changes: who made them, when, and whether they can be taken back.",
        "changes --limit 10",
    )
    changes.add_argument(
        "--limit", metavar="N", type=Whole(1, 200), default=20, help="so many [default: 20]"
    )
    add_json(changes)
    diff = add_part(
        commands,
        "history_commands:diff_",
        "diff",
        "Show all values that are set, or parameters in columns side by side.",
        "diff",
        "diff default preset:timid actor:actor-1",
        "diff world@117 world",
        more="A column is default, preset:NAME, world, group:NAME, actor:ID; the last three as\n"
        "they were right after a change with @ and its number; or change:NUMBER, the scope of\n"
        "a change right after it.",
    )
    diff.add_argument("columns", metavar="COLUMN", nargs="*", help="up to eight")
    diff.add_argument("--all", action="store_true", help="also parameters that are alike in all")
    add_json(diff, "print them as JSON")
    return [undo, redo, changes, diff]
