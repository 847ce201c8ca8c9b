"""The bulletin takes in what parts of the server want operators to see at once."""

import time
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final

MOST_NOTICES: Final = 4096
"""Of more notices that nobody has fetched the oldest are lost, and counted."""


@dataclass(frozen=True)
class Notice:
    """A change that operators made, or an event that no frame of the zone tells of."""

    at_us: int
    change: Mapping[str, Any] | None = None
    """A change as `GET /changes` tells it."""
    about: str | None = None
    """The things that are others now: presets, schedules, groups, accounts."""
    event: Mapping[str, Any] | None = None
    """An event of the kinds command, mark, report, pace, schedule or trajectories, not numbered."""


@dataclass
class Bulletin:
    """Notices that wait to be shown. Any thread may add to it; one fetches."""

    lost: int = 0
    _waiting: deque[Notice] = field(default_factory=deque)

    def change(self, change: Mapping[str, Any]) -> None:
        """Show a change: it is told on `changes`, and is a mark in all series."""
        self._add(Notice(_now_us(), change=dict(change)))

    def heard(self, kind: str, what: Mapping[str, Any]) -> None:
        """Take in what a console or those who serve people tell their listeners.

        That is a change, a mark, what is others now, a report, or a schedule or guard that came to
        nothing; other kinds are passed over.
        """
        if kind == "change":
            self.change(what)
        elif kind == "mark":
            self.event("mark", str(what.get("text") or ""), account=what.get("account"))
        elif kind == "about":
            self.about(str(what["about"]))
        elif kind == "schedule":
            told = {name: value for name, value in what.items() if name != "text"}
            self.event("schedule", str(what["text"]), **told)
        elif kind == "report":
            self.event(
                "report",
                str(what.get("text") or ""),
                who=what.get("who"),
                other=what.get("other"),
                place=what.get("place"),
                report=what.get("report"),
            )

    def about(self, what: str) -> None:
        """Tell that presets, schedules, groups or accounts are others now."""
        self._add(Notice(_now_us(), about=what))

    def event(
        self,
        kind: str,
        text: str,
        *,
        who: str | int | None = None,
        other: str | int | None = None,
        place: tuple[float, float, float] | None = None,
        **arguments: Any,
    ) -> None:
        """Add an event; one of the kind `mark` is a mark in all series too."""
        told = {"kind": kind, "who": who, "other": other, "place": place}
        self._add(Notice(_now_us(), event={**told, "arguments": arguments, "text": text}))

    def fetch(self) -> list[Notice]:
        """Take the notices that have come since the last call."""
        return [self._waiting.popleft() for _ in range(len(self._waiting))]

    def _add(self, notice: Notice) -> None:
        if len(self._waiting) >= MOST_NOTICES:
            self._waiting.popleft()
            self.lost += 1
        self._waiting.append(notice)


def _now_us() -> int:
    return time.time_ns() // 1000
