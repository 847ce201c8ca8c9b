"""Guards: a change is taken back when a figure is beyond a limit for too long."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, Final, Literal

from esplanade.protocol.commands.conditions import FigureCondition
from esplanade.server.console.conditions import Held
from esplanade.server.console.refusals import RefusedError

MOST: Final = 64
"""No more guards may watch at once."""
MOST_ENDED: Final = 200
"""Of more guards that have ended the oldest are forgotten."""


@dataclass
class Guard:
    """One guard: it watches a figure for the sake of some changes."""

    id: str
    changes: list[int]
    condition: dict[str, Any]
    until_us: int
    by: str | None
    rights: str
    """The rights of whoever has made the change: it never has more."""
    state: Literal["watching", "taken_back", "ended", "refused"] = "watching"
    faults: list[dict[str, Any]] = field(default_factory=list)

    def plain(self) -> dict[str, Any]:
        """It as plain data."""
        return asdict(self)


class Guards:
    """The guards there are, by id: that of the first change, after a `g`."""

    def __init__(self) -> None:
        self._guards: dict[str, Guard] = {}
        self._held: dict[str, Held] = {}

    def __iter__(self) -> Iterator[Guard]:
        return iter(list(self._guards.values()))

    def check_room(self) -> None:
        """See that one more may watch.

        Raises
        ------
        RefusedError
            Too many do.
        """
        if len(self._held) >= MOST:
            raise RefusedError.of("full", f"{MOST} guards watch already", "guard")

    def add(self, guard: Guard) -> None:
        """Let a guard watch, or remember one that did."""
        self._guards[guard.id] = guard
        if guard.state == "watching":
            self._held[guard.id] = Held(FigureCondition.model_validate(guard.condition))
        ended = [each.id for each in self._guards.values() if each.state != "watching"]
        for name in ended[: max(0, len(ended) - MOST_ENDED)]:
            del self._guards[name]

    def act(self, guard: Guard) -> None:
        """A guard takes its changes back: its figure is looked at no more until it has ended."""
        self._held.pop(guard.id, None)

    def end(self, guard: Guard, state: Literal["taken_back", "ended", "refused"]) -> None:
        """A guard watches no more."""
        guard.state = state
        self._held.pop(guard.id, None)

    def watching(self) -> list[Guard]:
        """The guards that watch."""
        return [self._guards[name] for name in self._held]

    def held(self, values: Mapping[str, float | None], now_s: float) -> list[Guard]:
        """The guards whose figure has been beyond its limit for long enough."""
        return [
            self._guards[name]
            for name, held in self._held.items()
            if held.update(values.get(held.condition.name), now_s)
        ]

    def figures(self) -> set[str]:
        """The figures that guards watch."""
        return {held.condition.name for held in self._held.values()}
