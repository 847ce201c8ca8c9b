"""Events of a world, the latest of them in memory, with the names of people to be hidden or not."""

from collections import deque
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import count
from typing import Any, Final

from esplanade.server.live.names import stand_in

REMEMBERED: Final = 10_000
"""Of more events the oldest are forgotten."""
Place = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Party:
    """Somebody who takes part in an event: a person by the avatar's id, an actor by its own."""

    id: int | str
    name: str
    person: bool

    def label(self, *, names: bool) -> str:
        """The name as it is told."""
        return stand_in(int(self.id)) if self.person and not names else self.name


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happened. `{who}` and `{other}` in its words stand for names."""

    id: int
    at_us: int
    tick: int
    kind: str
    words: str
    who: Party | None = None
    other: Party | None = None
    place: Place | None = None
    arguments: Mapping[str, Any] = field(default_factory=dict)
    said: str = ""
    """Text of people or operators that follows the words, and is left as it is."""
    private: bool = False
    """Whether `said` and the arguments may have names of people."""

    def told(self, *, names: bool) -> dict[str, Any]:
        """The event as plain data."""
        hidden = self.private and not names
        text = self.words
        for mark, party in (("{who}", self.who), ("{other}", self.other)):
            if party is not None:
                text = text.replace(mark, party.label(names=names))
        return {
            "id": self.id,
            "at_us": self.at_us,
            "tick": self.tick,
            "kind": self.kind,
            "who": None if self.who is None else self.who.id,
            "other": None if self.other is None else self.other.id,
            "place": self.place,
            "arguments": {} if hidden else dict(self.arguments),
            "text": text if hidden else text + self.said,
        }

    def is_of(self, who: str) -> bool:
        """Whether somebody of that id takes part."""
        return any(party is not None and str(party.id) == who for party in (self.who, self.other))


class Events:
    """The latest events, and those that are new since the last beat."""

    def __init__(self) -> None:
        self.new: list[Event] = []
        self._all: deque[Event] = deque(maxlen=REMEMBERED)
        self._numbers = count(1)

    def add(self, kind: str, at_us: int, tick: int, words: str, **more: Any) -> None:
        """Note that something has happened; `more` are fields of `Event`."""
        event = Event(next(self._numbers), at_us, tick, kind, words, **more)
        self._all.append(event)
        self.new.append(event)

    def __iter__(self) -> Iterator[Event]:
        return iter(self._all)

    def found(self, kinds: Iterable[str], who: str | None, from_us: int, limit: int) -> list[Event]:
        """The latest events of some kinds, or of all if none is given; the newest first."""
        wanted, found = set(kinds), list[Event]()
        for event in reversed(self._all):
            if len(found) >= limit or event.at_us < from_us:
                break
            if (not wanted or event.kind in wanted) and (who is None or event.is_of(who)):
                found.append(event)
        return found
