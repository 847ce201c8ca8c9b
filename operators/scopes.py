"""Scopes, conditions and persons as commands name them."""

from argparse import ArgumentTypeError
from typing import Any, Final

from esplanade.commandline.readers import Span

_SIDES: Final = {">": "above", "<": "below"}


def scope_text(group: str | None, actor: str | None) -> str:
    """A scope as commands name it: the world, unless there is a group or an actor."""
    if group is not None and actor is not None:
        raise ValueError("a scope is a group or an actor, not both")
    if group is not None:
        return f"group:{group}"
    return "world" if actor is None else f"actor:{actor}"


def condition(text: str) -> dict[str, Any]:
    """A condition such as people>40 or contacts_per_minute>3/10s, as commands have it.

    Raises
    ------
    ArgumentTypeError
        It is not of that form.
    """
    for sign, side in _SIDES.items():
        name, found, rest = text.partition(sign)
        if not found:
            continue
        limit, slash, span = rest.partition("/")
        try:
            for_s = Span()(span) if slash else 0.0
            return {"name": name.strip(), side: float(limit), "for_s": for_s}
        except ValueError:
            break
    raise ArgumentTypeError(f"{text!r} is no condition such as people>40 or people>40/10s")


def guard(text: str) -> dict[str, Any]:
    """A guard, written as a condition is."""
    found = condition(text)
    return {"figure": found.pop("name"), **found}
