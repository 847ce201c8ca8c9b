"""Requests of the command line: faults in words, and answers as lines for people."""

import json
from argparse import Namespace
from collections.abc import Mapping, Sequence
from http import HTTPStatus
from typing import Any

from esplanade.commandline import exit_codes
from esplanade.commandline.errors import CommandError
from esplanade.operators.errors import OperatorError, RefusedError
from esplanade.operators.http import SessionToken, ask
from esplanade.operators.scopes import scope_text

PRICES = {"tick": "at once", "prepared": "once the ground is prepared for other bodies"}


def asked(options: Namespace, path: str, body: Any = None) -> Any:
    """The answer of the server that the options name.

    Raises
    ------
    CommandError
        It refuses, or there is none.
    """
    try:
        return ask(options.url, options.token, path, body)
    except OperatorError as error:
        raise CommandError(refusal_text(error, options.token)) from None


def refusal_text(error: OperatorError, token: str) -> str:
    """The fault in words, and what helps where a login that is kept holds no more."""
    ended = isinstance(error, RefusedError) and error.status == HTTPStatus.UNAUTHORIZED
    if ended and isinstance(token, SessionToken):
        return "your session has ended: call `esplanade op login` again"
    return str(error)


def scope_of(options: Namespace) -> str:
    """The scope that the options name."""
    return scope_text(options.group, options.actor)


def change(options: Namespace, op: str, **command: Any) -> int:
    """Send a command, and print what has changed."""
    given = {name: value for name, value in command.items() if value is not None}
    return change_all(options, [{"op": op, **given}])


def change_all(options: Namespace, commands: Sequence[Mapping[str, Any]]) -> int:
    """Send commands that are carried out in one tick, and print what has changed."""
    more = {"note": options.note, "dry_run": options.dry_run}
    bodies = [{**command, **more} for command in commands]
    if len(bodies) == 1:
        answers = [asked(options, "/commands", bodies[0])]
    else:
        answers = asked(options, "/commands", bodies)
    for answer in answers:
        _print(answer, is_dry=options.dry_run)
    return exit_codes.OK


def _print(answer: Mapping[str, Any], *, is_dry: bool) -> None:
    for subject, fields in answer["after"].items():
        for field, value in fields.items():
            before = answer["before"].get(subject, {}).get(field)
            print(f"{subject} {field}: {in_words(before)} -> {in_words(value)}")
    for name, count in answer["shadowed"].items():
        print(f"{name}: {count} narrower scopes have a value of their own, and keep it")
    if is_dry:
        took = answer.get("prepare_s")
        about = "" if took is None else f", in about {took:g} s"
        print(f"nothing was changed; it would be, {PRICES[answer['price']]}{about}")
    else:
        print(f"change {answer['command']}, tick {answer['tick']}")


def in_words(value: Any) -> str:
    """A value as people read it."""
    return "not set" if value is None else json.dumps(value)
