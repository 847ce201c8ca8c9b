"""The parts of `esplanade op` about people, and marks of moments."""

import json
import time
from argparse import Namespace

from rich.table import Table

from esplanade.commandline import exit_codes
from esplanade.commandline.errors import CommandError
from esplanade.commandline.output import console
from esplanade.operators.asking import asked, change
from esplanade.operators.plain_text import on_one_line
from esplanade.operators.times import at_time


def people(options: Namespace) -> int:
    """List who is connected."""
    found = asked(options, "/people")
    if options.json:
        print(json.dumps(found, indent=1))
        return exit_codes.OK
    table = Table("person", "name", "x", "y", "z", "muted")
    for each in found["people"]:
        place = [f"{value:.2f}" for value in each["position"]]
        muted = f"{each['muted_s']:.0f} s more" if each["muted_s"] else ""
        table.add_row(str(each["id"]), on_one_line(each["name"]), *place, muted)
    console().print(table)
    return exit_codes.OK


def announce(options: Namespace) -> int:
    """Say something to all people, or to some."""
    return change(
        options,
        "announce",
        text=options.text,
        storey_m=options.storey,
        near_actor=options.near,
        radius_m=options.radius,
    )


def mark(options: Namespace) -> int:
    """Mark this moment."""
    return change(options, "mark", text=options.text)


def warn(options: Namespace) -> int:
    """Warn a person."""
    return change(options, "warn", person=_person(options), text=options.text)


def mute(options: Namespace) -> int:
    """Let nobody hear a person for a time."""
    person = _person(options)
    return change(options, "mute", person=person, seconds=options.span, text=options.text)


def kick(options: Namespace) -> int:
    """Send a person out."""
    return change(options, "kick", person=_person(options), text=options.text)


def walk_out(options: Namespace) -> int:
    """Let a person's avatar walk out."""
    return change(options, "walk_out", person=_person(options), text=options.text)


def ban(options: Namespace) -> int:
    """Let somebody in no more."""
    return change(
        options,
        "ban",
        person=None if options.person is None else _person(options),
        by=options.by,
        name_pattern=options.pattern,
        address=options.address,
        until_s=None if options.span is None else round(time.time() + options.span),
        text=options.text,
    )


def unban(options: Namespace) -> int:
    """Let a ban hold no more."""
    return change(options, "unban", ban=options.ban)


def bans(options: Namespace) -> int:
    """List bans."""
    found = asked(options, "/bans")
    if options.json:
        print(json.dumps(found, indent=1))
        return exit_codes.OK
    table = Table("ban", "of", "since", "until", "by", "told")
    for each in found["bans"]:
        if not (each["holds"] or options.all):
            continue
        whom = " ".join(
            f"{kind} {each[field]}" if each.get(field) else kind
            for kind, field in ((kind, _SHOWN.get(kind, "")) for kind in each["kinds"])
        )
        until = each["until_s"]
        ends = "for ever" if until is None else at_time(round(1e6 * until))
        over = "" if each["holds"] else ", over"
        table.add_row(
            str(each["id"]),
            on_one_line(whom),
            at_time(each["at_us"]),
            f"{ends}{over}",
            each["by"] or "",
            on_one_line(each["text"]),
        )
    console().print(table)
    return exit_codes.OK


_SHOWN = {"name": "name_pattern", "address": "address"}


def _person(options: Namespace) -> int:
    """The id of the avatar that is meant."""
    if options.person.isdecimal():
        return int(options.person)
    there = asked(options, "/people")["people"]
    found = [each["id"] for each in there if each["name"] == options.person]
    if len(found) != 1:
        many = "several people are" if found else "nobody is"
        raise CommandError(f"{many} called {options.person!r}; give the id of the avatar")
    return int(found[0])
