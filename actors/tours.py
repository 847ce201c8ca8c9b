"""The tours of guides as others are told of them, and the sentences that guides say on the way."""

from collections.abc import Hashable, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Tour:
    """The tour of a guide at a moment."""

    stops: tuple[str, ...]
    """Names of the stops; an empty one for a stop that is a mere point."""
    next: int
    """The place among them of the stop to which the guide leads, or where it is."""
    followers: frozenset[Hashable]
    """The people who are being led."""


@dataclass(frozen=True)
class Saying:
    """A sentence that an actor says to some people."""

    text: str
    to: frozenset[Hashable]


def welcome(stops: Sequence[str]) -> str:
    """The sentence to somebody who has joined a tour."""
    number = "one stop" if len(stops) == 1 else f"{len(stops)} stops"
    return f"Welcome to the tour of {number}."


def arrival(stops: Sequence[str], stop: int) -> str:
    """The sentence at a stop."""
    number = f"stop {stop + 1} of {len(stops)}"
    return f"This is {stops[stop]}, {number}." if stops[stop] else f"This is {number}."


def onward(stops: Sequence[str], stop: int) -> str:
    """The sentence on the way to a stop."""
    return f"We go on to {stops[stop] or f'stop {stop + 1}'}."
