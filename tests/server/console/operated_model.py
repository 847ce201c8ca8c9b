"""A plain model of what operators do: facts, a list of changes, and what waits."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from esplanade.actors import ActorParameters

Key = tuple[str, str]
USUAL = ActorParameters().model_dump()
TAGS = {"main/a1": ("fast",), "main/a2": (), "main/a3": ()}


LATE_US = 60_000_000


class ConflictError(Exception):
    """A change cannot be taken back, or there is none."""


@dataclass
class Made:
    """A change: the facts that it touched, before and after."""

    number: int
    account: str
    before: dict[Key, Any]
    after: dict[Key, Any]
    reverts: "Made | None" = None
    reverted: bool = False

    @property
    def is_undo(self) -> bool:
        return self.reverts is not None and not self.reverts.is_undo


@dataclass
class Waiting:
    """A schedule."""

    name: str
    account: str
    due_us: int
    again_us: int | None
    wanted: dict[Key, Any]
    state: str = "waiting"
    back_us: int | None = None
    made: Made | None = None


@dataclass
class Watching:
    """A guard."""

    made: Made
    above: float
    state: str = "watching"


@dataclass
class Model:
    """All of it."""

    facts: dict[Key, Any] = field(default_factory=dict)
    made: list[Made] = field(default_factory=list)
    schedules: dict[str, Waiting] = field(default_factory=dict)
    guards: list[Watching] = field(default_factory=list)
    may_tune: set[str] = field(default_factory=lambda: {"olga", "oleg"})
    """The accounts whose schedules and guards may change parameters."""
    crowd: float = 0.0

    def fits(self, wanted: Mapping[Key, Any]) -> bool:
        """Whether all actors could have these facts."""
        facts = {**self.facts, **wanted}
        if any(name == "risk_weight" and (value or 0) < 0 for (_, name), value in wanted.items()):
            return False
        return all(
            value(facts, actor, "speed_mps") <= value(facts, actor, "max_speed_mps")
            for actor in TAGS
        )

    def change(self, account: str, wanted: Mapping[Key, Any], number: int) -> Made:
        """Make facts true."""
        before = {key: self.facts.get(key) for key in wanted}
        made = Made(number, account, before, dict(wanted))
        self.facts |= made.after
        self.made.append(made)
        return made

    def revertible(self, account: str, which: str) -> Made:
        """The change that is meant.

        Raises
        ------
        ConflictError
            There is none, or somebody has changed the same since.
        """
        for made in reversed(self.made):
            anybody = which == "latest_of_all"
            if made.reverted or not (anybody or made.account == account):
                continue
            if made.is_undo is (which == "undone"):
                return self.checked(made)
            if made.reverts is None:
                break
        raise ConflictError

    def checked(self, made: Made) -> Made:
        """The change, if all is still as it has made it, and would fit when it is taken back."""
        if made.reverted or any(self.facts.get(key) != now for key, now in made.after.items()):
            raise ConflictError
        if not self.fits(made.before):
            raise ConflictError
        return made

    def revert(self, account: str, made: Made, number: int) -> None:
        """Take a change back."""
        taken = Made(number, account, made.after, made.before, made)
        self.facts |= made.before
        for subject, field_ in made.before:
            if field_ == "schedule":
                schedule = self.schedules[subject.removeprefix("schedule:")]
                if made.before[subject, field_] is None:
                    schedule.state = "cancelled"
                else:
                    schedule.state = "waiting" if schedule.made is None else "fired"
        made.reverted = True
        self.made.append(taken)

    def settle(self, now_us: int, number: "Numbers") -> None:
        """Do what is due: guards, then schedules, then what is to be taken back again."""
        for guard in [each for each in self.guards if each.state == "watching"]:
            if guard.made.reverted:
                guard.state = "ended"
            elif self.crowd > guard.above:
                guard.state = self._taken_back(guard.made, "taken_back", number)
        waiting = list(self.schedules.values())
        due = [each for each in waiting if each.state == "waiting" and each.due_us <= now_us]
        back = [
            each
            for each in waiting
            if each.state == "fired" and each.back_us is not None and each.back_us <= now_us
        ]
        for each in due:
            if now_us - each.due_us > LATE_US:
                each.state = "missed"
                continue
            if each.account not in self.may_tune or not self.fits(each.wanted):
                each.state = "refused"
                continue
            each.made = self.change(each.account, each.wanted, number.next())
            each.state = "done" if each.again_us is None else "fired"
            each.back_us = None if each.again_us is None else now_us + each.again_us
        for each in back:
            assert each.made is not None
            if each.made.reverted:
                each.state = "undone"
            else:
                each.state = self._taken_back(each.made, "undone", number)

    def _taken_back(self, made: Made, state: str, number: "Numbers") -> str:
        if made.account not in self.may_tune:
            return "refused"
        try:
            self.revert(made.account, self.checked(made), number.next())
        except ConflictError:
            return "refused"
        return state


class Numbers:
    """Numbers of changes that nobody is told of: they are not compared."""

    def next(self) -> int:
        return -1


def value(facts: Mapping[Key, Any], actor: str, name: str) -> float:
    """A parameter of an actor, by these facts."""
    purposes = sorted(
        (key[1].removeprefix("group:"), group)
        for key, group in facts.items()
        if key[0] == f"actor:{actor}" and key[1].startswith("group:") and group is not None
    )
    groups = [*TAGS[actor], *(f"{purpose}:{group}" for purpose, group in purposes)]
    for scope in (f"actor:{actor}", *(f"group:{group}" for group in reversed(groups)), "world"):
        found = facts.get((scope, name))
        if found is not None:
            return float(found)
    return float(USUAL[name])
