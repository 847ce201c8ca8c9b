"""Schedules: commands that are to be carried out later, as data, and when each is due."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from datetime import UTC, datetime, timedelta
from typing import Any, Final, Literal

from esplanade.protocol.commands.conditions import FigureCondition
from esplanade.protocol.commands.schedules import When
from esplanade.server.console.conditions import Held
from esplanade.server.console.refusals import RefusedError

SCHEDULE: Final = "schedule"
"""The field of a subject `schedule:ID`: what is to be done, None if nothing is any more."""
MOST_WAITING: Final = 256
"""No more schedules may wait."""
MOST_ENDED: Final = 200
"""Of more schedules that have ended the oldest are forgotten; the audit keeps them all."""
LATE_S: Final = 60.0
"""What is found to be due longer ago than this was missed, and is not made up for."""
State = Literal["waiting", "firing", "fired", "done", "undone", "cancelled", "missed", "refused"]
"""`firing` is carried out now; `fired` is, and is to be taken back; the last six have ended, but
for `fired`."""
OPEN: Final = frozenset({"waiting", "firing", "fired"})


@dataclass
class Schedule:
    """One schedule."""

    id: str
    commands: list[dict[str, Any]]
    when: dict[str, Any]
    again_after_s: float | None
    guard: dict[str, Any] | None
    by: str | None
    rights: str
    """The rights of whoever has made it: it never has more, whatever its account gets later."""
    note: str | None
    at_us: int
    due_tick: int | None = None
    due_us: int | None = None
    state: State = "waiting"
    fired: dict[str, int] | None = None
    """The moment and the tick in which it was carried out."""
    changes: list[int] = field(default_factory=list)
    back_us: int | None = None
    """When its changes are to be taken back."""
    faults: list[dict[str, Any]] = field(default_factory=list)

    def plain(self) -> dict[str, Any]:
        """It as plain data."""
        return asdict(self)

    def definition(self) -> dict[str, Any]:
        """The commands of a schedule and their times, without what has come of them."""
        return {name: getattr(self, name) for name in _DEFINITION}


_DEFINITION: Final = (
    *("id", "commands", "when", "again_after_s", "guard", "by", "rights", "note", "at_us"),
    *("due_tick", "due_us"),
)


class Schedules:
    """The schedules there are, by id."""

    def __init__(self) -> None:
        self._schedules: dict[str, Schedule] = {}
        self._held: dict[str, Held] = {}
        self._made = 0

    def __iter__(self) -> Iterator[Schedule]:
        return iter(list(self._schedules.values()))

    def get(self, name: str) -> Schedule | None:
        """The schedule with that id."""
        return self._schedules.get(name)

    def new_id(self, taken: int = 0) -> str:
        """The next id; `taken` more of them are given away already."""
        waiting = sum(each.state in OPEN for each in self)
        if waiting + taken >= MOST_WAITING:
            raise RefusedError.of("full", f"{MOST_WAITING} schedules wait already")
        return f"s{self._made + 1 + taken}"

    def fact(self, name: str) -> dict[str, Any] | None:
        """The part that is still to be done, as plain data."""
        found = self._schedules.get(name)
        return found.definition() if found is not None and found.state in OPEN else None

    def take(self, name: str, value: Mapping[str, Any] | None) -> None:
        """This is to be done from now on; None cancels what was.

        A schedule that was cancelled after it had fired is only taken back again at its time.
        """
        found = self._schedules.get(name)
        if value is None:
            if found is not None and found.state in OPEN:
                found.state = "cancelled"
                self._forget()
            return
        made = Schedule(**value)
        if found is not None and found.fired is not None:
            made = replace(found, state="fired")
        self._put(made)

    def due(self, now_us: int, tick: int) -> list[Schedule]:
        """The schedules whose tick or moment has come, without those that go by a figure."""
        return [
            each
            for each in self._schedules.values()
            if each.state == "waiting"
            and (
                (each.due_tick is not None and tick >= each.due_tick)
                or (each.due_us is not None and now_us >= each.due_us)
            )
        ]

    def held(self, values: Mapping[str, float | None], now_s: float) -> list[Schedule]:
        """The schedules whose figure has been beyond its limit for long enough."""
        found = []
        for name, held in list(self._held.items()):
            schedule = self._schedules[name]
            if schedule.state != "waiting":
                del self._held[name]
            elif held.update(values.get(held.condition.name), now_s):
                found.append(schedule)
        return found

    def back(self, now_us: int) -> list[Schedule]:
        """The schedules whose changes are to be taken back now."""
        return [
            each
            for each in self._schedules.values()
            if each.state == "fired" and each.back_us is not None and now_us >= each.back_us
        ]

    def figures(self) -> set[str]:
        """The figures that schedules go by."""
        return {held.condition.name for held in self._held.values()}

    def load(self, data: Mapping[str, Any]) -> Schedule:
        """Take in what `plain` of one gave."""
        known = {each.name for each in fields(Schedule)}
        return self._put(Schedule(**{name: data[name] for name in data if name in known}))

    def _put(self, schedule: Schedule) -> Schedule:
        self._schedules[schedule.id] = schedule
        self._made = max(self._made, int(schedule.id[1:]))
        figure = schedule.when.get("figure")
        if figure is not None and schedule.state == "waiting":
            self._held[schedule.id] = Held(FigureCondition.model_validate(figure))
        self._forget()
        return schedule

    def _forget(self) -> None:
        ended = [each.id for each in self._schedules.values() if each.state not in OPEN]
        for name in ended[: max(0, len(ended) - MOST_ENDED)]:
            del self._schedules[name]


def due_of(when: When, now_us: int) -> tuple[int | None, int | None]:
    """The tick, or the moment in microseconds, at which something is due; None for neither."""
    if when.at_tick is not None:
        return when.at_tick, None
    if when.after_s is not None:
        return None, now_us + round(1e6 * when.after_s)
    if when.at_time is not None:
        return None, _moment_us(when.at_time, now_us)
    return None, None


def _moment_us(text: str, now_us: int) -> int:
    now = datetime.fromtimestamp(now_us / 1e6, UTC)
    if "T" in text or "-" in text:
        return round(1e6 * datetime.fromisoformat(text).timestamp())
    hour, minute, second, *_ = [*map(int, text.split(":")), 0]
    moment = now.replace(hour=hour, minute=minute, second=second, microsecond=0)
    if moment <= now:
        moment += timedelta(days=1)
    return round(1e6 * moment.timestamp())
