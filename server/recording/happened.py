"""The events of a recording: what happened in its ticks, by the ids of those who took part."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from esplanade.server.live.names import stand_in
from esplanade.server.recording.seconds import Tick
from esplanade.server.world.state import PERSON


class Happened:
    """Makes events of ticks, one after the other."""

    def __init__(self) -> None:
        self._touching: set[int] = set()
        self._people: set[int] = set()
        self._stood = False

    def events(self, tick: Tick) -> Iterator[dict[str, Any]]:
        """The events of the next tick, as plain data."""
        frame = tick.frame
        for gone in frame.left:
            if gone in self._people:
                self._people.discard(gone)
                yield _event(frame.tick, "leave", f"{stand_in(gone)} left", gone)
        for each in frame.entered:
            if each.kind == PERSON:
                self._people.add(each.id)
                yield _event(frame.tick, "join", f"{stand_in(each.id)} came in", each.id)
        for name, is_open in frame.events.doors.items():
            text = f"the door {name} is {'open' if is_open else 'closed'}"
            yield _event(frame.tick, "door", text, name)
        touching = set(np.asarray(tick.touching).tolist())
        for pair in sorted(touching - self._touching):
            actor, other = divmod(pair, 2**32)
            yield _event(frame.tick, "contact", f"{actor} and {other} touched", actor, other)
        self._touching = touching
        if frame.actors_stood and not self._stood:
            yield _event(frame.tick, "plan_failure", "nothing was planned, and the actors stood")
        self._stood = frame.actors_stood


def _event(
    tick: int, kind: str, text: str, who: int | str | None = None, other: int | None = None
) -> dict[str, Any]:
    return {"tick": tick, "kind": kind, "text": text, "who": who, "other": other}
