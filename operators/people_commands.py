"""The parts of `esplanade op` about people, and marks of moments."""

from argparse import Namespace

from esplanade.commandline.errors import CommandError
from esplanade.operators.asking import asked, change


def announce(options: Namespace) -> int:
    """Say something to all people."""
    return change(options, "announce", text=options.text)


def mark(options: Namespace) -> int:
    """Mark this moment."""
    return change(options, "mark", text=options.text)


def mute(options: Namespace) -> int:
    """Let nobody hear a person for a time."""
    person = _person(options)
    return change(options, "mute", person=person, seconds=options.span, text=options.text)


def kick(options: Namespace) -> int:
    """Send a person out."""
    return change(options, "kick", person=_person(options), text=options.text)


def _person(options: Namespace) -> int:
    """The id of the avatar that is meant."""
    if options.person.isdecimal():
        return int(options.person)
    people = asked(options, "/people")["people"]
    found = [each["id"] for each in people if each["name"] == options.person]
    if len(found) != 1:
        many = "several people are" if found else "nobody is"
        raise CommandError(f"{many} called {options.person!r}; give the id of the avatar")
    return int(found[0])
