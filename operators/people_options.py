"""The options of the parts of `esplanade op` about people."""

from argparse import Namespace
from argparse import _SubParsersAction as SubParsers  # argparse names the type nowhere else

from esplanade.commandline.errors import UsageError
from esplanade.commandline.parser import Parser
from esplanade.commandline.readers import Number, Span, Text, Whole
from esplanade.operators.parts import add_json, add_note, add_part

KNOWN_BY = ("token", "name", "address")
_WHO = """\
A person is the number of the avatar, which `op people` lists, or the whole name where only one
person has it. The person is told what happens, in the words of --text."""
_BANNED = """\
The person goes at once, and is known again by the resume token and the name, or as --by says.
Whoever has left within the last ten minutes can still be banned by the number. Without --for it has
no end; `op bans` lists bans, and `op unban` lifts one. No ban is more than a hurdle: another name
is easily given, and an address is shared by others."""


def add_people_parts(commands: "SubParsers[Parser]") -> list[Parser]:
    """Add the commands, and return their parsers."""
    people = add_part(
        commands,
        "people_commands:people",
        "people",
        "List who is connected: number, name, where, since when, and who is muted.",
        "people",
        "people --json",
    )
    add_json(people)
    return [people, *_to_all(commands), *_to_one(commands), *_out(commands), *_bans(commands)]


def _to_all(commands: "SubParsers[Parser]") -> list[Parser]:
    announce = add_part(
        commands,
        "people_commands:announce",
        "announce",
        "Say something to all people, or to those on a storey or near an actor.",
        'announce "The east wing closes in ten minutes."',
        'announce "Please take the stairs." --storey 3.2',
        'announce "The tour begins here." --near actor-3 --radius 15',
        'announce "The tour begins here." --near actor-3 --dry-run',
        more="With --dry-run it says how many would read it.",
    )
    announce.add_argument("text", metavar="TEXT", type=Text(), help="what they read")
    metre = Number(-100_000.0, 100_000.0)
    announce.add_argument(
        "--storey", metavar="M", type=metre, help="only people on the storey at this height"
    )
    announce.add_argument("--near", metavar="ACTOR", type=Text(), help="only people near this one")
    announce.add_argument(
        "--radius",
        metavar="M",
        type=Number(0.0, 1000.0, above=True),
        help="how near, in metres [default: 10]",
    )
    add_note(announce)
    mark = add_part(
        commands,
        "people_commands:mark",
        "mark",
        "Mark this moment: a line on charts, and a row of the audit.",
        'mark "doors opened"',
    )
    mark.add_argument("text", metavar="TEXT", type=Text(), help="what happened")
    add_note(mark)
    return [announce, mark]


def _to_one(commands: "SubParsers[Parser]") -> list[Parser]:
    warn = add_part(
        commands,
        "people_commands:warn",
        "warn",
        "Say something to one person, who has to close it before going on.",
        'warn Eve --text "Please let others speak."',
        more=_WHO,
    )
    _add_person(warn, text_needed=True)
    mute = add_part(
        commands,
        "people_commands:mute",
        "mute",
        "Let nobody hear a person's chat for a time, and say so; 0s ends it.",
        "mute Eve --for 15m",
        "mute 117 --for 0s",
        more=_WHO,
    )
    mute.add_argument(
        "--for", dest="span", metavar="SPAN", type=Span(), default=600.0, help="[default: 10m]"
    )
    _add_person(mute)
    return [warn, mute]


def _out(commands: "SubParsers[Parser]") -> list[Parser]:
    kick = add_part(
        commands,
        "people_commands:kick",
        "kick",
        "Send a person out at once, and say why; they may come in anew.",
        'kick Eve --text "Please come back tomorrow."',
        more=_WHO,
    )
    _add_person(kick)
    walk_out = add_part(
        commands,
        "people_commands:walk_out",
        "walk-out",
        "Let a person's avatar walk to the nearest place of arrival, and leave from there.",
        'walk-out Eve --text "We are closing. Good night!"',
        more=_WHO,
    )
    _add_person(walk_out)
    return [kick, walk_out]


def _bans(commands: "SubParsers[Parser]") -> list[Parser]:
    ban = add_part(
        commands,
        "people_commands:ban",
        "ban",
        "Let somebody in no more: a person, or whoever has a name or an address.",
        'ban Eve --for 7d --text "No shouting." --note "third time"',
        "ban 117 --by token name address",
        "ban --name 'Eve*' --for 1h",
        "ban --address 192.0.2.0/24",
        more=_BANNED,
        check=_somebody,
    )
    _add_person(ban, optional=True)
    ban.add_argument(
        "--by",
        metavar="|".join(KNOWN_BY),
        nargs="+",
        choices=KNOWN_BY,
        help="how the person is known again [default: token name]",
    )
    ban.add_argument(
        "--name",
        dest="pattern",
        metavar="PATTERN",
        type=Text(),
        help="whoever gives this name or one that looks alike; * stands for any characters",
    )
    ban.add_argument("--address", metavar="ADDRESS", type=Text(), help="an address, or a range")
    ban.add_argument("--for", dest="span", metavar="SPAN", type=Span(), help="[default: for ever]")
    unban = add_part(
        commands,
        "people_commands:unban",
        "unban",
        "Let a ban hold no more.",
        "unban 12",
        more="`op bans` lists the numbers.",
    )
    unban.add_argument("ban", metavar="NUMBER", type=Whole(1), help="the number of the ban")
    add_note(unban)
    listed = add_part(
        commands, "people_commands:bans", "bans", "List bans, the newest first.", "bans"
    )
    listed.add_argument("--all", action="store_true", help="also those that hold no more")
    add_json(listed)
    return [ban, unban, listed]


def _add_person(parser: Parser, *, text_needed: bool = False, optional: bool = False) -> None:
    parser.add_argument(
        "person",
        metavar="PERSON",
        nargs="?" if optional else None,
        type=Text(),
        help="the number of the avatar, or the whole name",
    )
    parser.add_argument(
        "--text", metavar="TEXT", type=Text(), required=text_needed, help="what the person reads"
    )
    add_note(parser)


def _somebody(found: Namespace) -> None:
    if found.person is None and found.pattern is None and found.address is None:
        raise UsageError("say whom: PERSON, --name or --address")
    if found.by and found.person is None:
        raise UsageError("--by: it says how PERSON is known again, and there is none")
