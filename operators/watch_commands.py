"""`esplanade op watch`: what is new in a world, line by line."""

import json
import os
import sys
from argparse import Namespace
from collections.abc import Iterable, Iterator
from typing import Any

from esplanade.commandline import exit_codes
from esplanade.commandline.errors import CommandError
from esplanade.operators.asking import in_words, refusal_text
from esplanade.operators.errors import OperatorError
from esplanade.operators.http import opened
from esplanade.operators.plain_text import on_one_line
from esplanade.operators.times import at_time

_DATA = b"data: "


def watch(options: Namespace) -> int:
    """Show messages until they end."""
    path = f"/live.sse?channels={','.join(options.channels)}"
    kinds = frozenset(options.kinds or ())
    try:
        with opened(options.url, options.token, path) as stream:
            for message in messages(stream):
                shown = lines(message, kinds) if not options.json else as_json(message, kinds)
                if not _print(shown):
                    return exit_codes.OK
    except OperatorError as error:
        raise CommandError(refusal_text(error, options.token)) from None
    raise CommandError("the server has ended; nothing more is told")


def _print(shown: Iterable[str]) -> bool:
    """Print lines; False if whoever reads them has read enough."""
    try:
        for line in shown:
            print(line, flush=True)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return False
    return True


def messages(stream: Iterable[bytes]) -> Iterator[dict[str, Any]]:
    """The messages of a stream of server-sent events, as they come."""
    for line in stream:
        if line.startswith(_DATA):
            yield json.loads(line.removeprefix(_DATA))


def as_json(message: dict[str, Any], kinds: frozenset[str]) -> Iterator[str]:
    """A message as a line of JSON, with the events that are wanted; nothing where none is left."""
    if message["channel"] == "events":
        events = [each for each in message["events"] if not kinds or each["kind"] in kinds]
        if not events:
            return
        message = {**message, "events": events}
    if message["channel"] != "hello":
        yield json.dumps(message)


def lines(message: dict[str, Any], kinds: frozenset[str] = frozenset()) -> Iterator[str]:
    """A message as lines for people. Text of others cannot steer the terminal."""
    match message:
        case {"channel": "events", "events": events}:
            for each in events:
                if not kinds or each["kind"] in kinds:
                    place = each["place"]
                    where = "" if place is None else f"  at {_place(place)}"
                    text = on_one_line(each["text"])
                    yield f"{at_time(each['at_us'])}  {each['kind']:<12}  {text}{where}"
        case {"channel": "changes", "change": change}:
            yield from _change(change)
        case {"channel": "changes", "about": about}:
            yield f"{about}: others now"
        case {"channel": "contacts", "pairs": pairs}:
            for x, y, z, actor, other, kind in pairs:
                whom = other if kind == "actor" else f"person {other}"
                yield f"tick {message['tick']}  {actor} and {whom} touched at {_place((x, y, z))}"
        case {"channel": "series", "values": values}:
            figures = "  ".join(f"{name} {value:g}" for name, value in values.items())
            yield f"{at_time(message['at_us'])}  {figures}"


def _change(change: dict[str, Any]) -> Iterator[str]:
    note = f", {on_one_line(change['note'])}" if change["note"] else ""
    who = change["account"] or "an operator"
    yield f"{at_time(change['at_us'])}  change {change['number']} by {who}: {change['op']}{note}"
    for subject, fields in change["after"].items():
        for field, value in fields.items():
            before = change["before"].get(subject, {}).get(field)
            yield f"  {on_one_line(subject)} {field}: {in_words(before)} -> {in_words(value)}"


def _place(place: Iterable[float]) -> str:
    return ", ".join(f"{value:.1f}" for value in place)
