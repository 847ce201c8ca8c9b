"""Figures of a world that conditions go by: each has a name, a unit, and a way to read it."""

from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from esplanade.actors.state import Reason
from esplanade.server.console.refusals import RefusedError
from esplanade.server.world.state import ACTOR
from esplanade.server.world.zone import Zone

WINDOW_S: Final = 60.0
"""Contacts are counted over this time of the world."""
Read = Callable[[], float | None]
"""Gives the present value of a figure, or None where there is none; it is called between ticks."""


@dataclass(frozen=True)
class Figure:
    """A figure that conditions may name."""

    name: str
    unit: str
    text: str
    read: Read

    def plain(self) -> dict[str, Any]:
        """It with its present value, as plain data."""
        return {"name": self.name, "unit": self.unit, "text": self.text, "value": self.read()}


class Figures:
    """The figures there are, by name. Whoever measures more adds it."""

    def __init__(self) -> None:
        self._figures: dict[str, Figure] = {}

    def __iter__(self) -> Iterator[Figure]:
        return iter(self._figures.values())

    def add(self, name: str, unit: str, text: str, read: Read) -> None:
        """Add a figure, or let another reading take the place of one."""
        self._figures[name] = Figure(name, unit, text, read)

    def value(self, name: str) -> float | None:
        """The present value of a figure; None if there is none, or no such figure."""
        figure = self._figures.get(name)
        return None if figure is None else figure.read()

    def check(self, name: str, *path: str | int) -> None:
        """See that there is a figure of that name.

        Raises
        ------
        RefusedError
            There is none.
        """
        if name not in self._figures:
            text = f"there is no figure {name!r}; there are {', '.join(self._figures)}"
            raise RefusedError.of("unknown_figure", text, *path, figure=name)


class ContactRate:
    """Contacts of actors with people in the last minute of the world."""

    def __init__(self, zone: Zone) -> None:
        self._zone = zone
        self._samples: deque[tuple[int, int]] = deque()

    def sample(self) -> None:
        """Take a sample; call it now and then, such as once a second."""
        zone, keep_ticks = self._zone, WINDOW_S / self._zone.tick_s
        self._samples.append((zone.tick, zone.contacts.actor_person))
        while len(self._samples) > 1 and self._samples[1][0] <= zone.tick - keep_ticks:
            self._samples.popleft()

    def read(self) -> float:
        """Number of contacts in the last minute; of a younger world, since its beginning."""
        zone, keep_ticks = self._zone, WINDOW_S / self._zone.tick_s
        before = 0
        if self._samples and zone.tick > keep_ticks:
            before = self._samples[0][1]
        return float(zone.contacts.actor_person - before)


def zone_figures(zone: Zone, contacts: ContactRate) -> Figures:
    """The figures that a zone itself can tell."""
    figures = Figures()
    figures.add("people", "1", "People in the world", lambda: float(zone.count()[0]))
    figures.add("actors", "1", "Actors in the world", lambda: float(zone.count()[1]))
    figures.add(
        "contacts_per_minute",
        "1/min",
        "Contacts of actors with people in the last minute",
        contacts.read,
    )
    figures.add(
        "no_path_share", "1", "Part of the actors that find no path", lambda: _no_path_share(zone)
    )
    return figures


def _no_path_share(zone: Zone) -> float | None:
    slots = zone.state.of_kind(ACTOR)
    if not len(slots):
        return None
    return float(np.mean(zone.state.reasons[slots] == Reason.NO_PATH))
