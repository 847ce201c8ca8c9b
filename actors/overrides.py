"""Sparse overrides of parameters: of the world, of groups and of single actors."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final, Literal, NamedTuple, Self

from esplanade.actors.parameters import ActorParameters

Value = float | int
Values = Mapping[str, Value]
Level = Literal["default", "world", "group", "own"]
DEFAULTS: Final[Values] = ActorParameters().model_dump()


@dataclass(frozen=True)
class Scope:
    """The range in which a value holds: the world, a group of actors, or one actor."""

    level: Literal["world", "group", "own"]
    name: str = ""
    """The group's name or the actor's id; the world needs none."""

    def __post_init__(self) -> None:
        if (self.level == "world") != (self.name == ""):
            raise ValueError(f"a scope of level {self.level!r} cannot have the name {self.name!r}")

    def __str__(self) -> str:
        return f"{self.level} {self.name}".strip()


WORLD: Final = Scope("world")


class Source(NamedTuple):
    """A value that an actor has, and where it comes from."""

    value: Value
    level: Level
    group: str | None = None


class Difference(NamedTuple):
    """A value that is another in one of two overrides; None where there is none."""

    scope: Scope
    name: str
    before: Value | None
    after: Value | None


@dataclass(frozen=True)
class Overrides:
    """The values that are set, by scope; an actor's own go before its groups', then the world's.

    Of several groups of an actor the one that is named last in its list prevails. Nothing here is
    changed: each change gives other overrides. What is set may not go together for an actor, as
    when its group is faster than it may be: `parameters` finds out.
    """

    values: Mapping[Scope, Values] = field(default_factory=dict)

    def of(self, scope: Scope) -> Values:
        """The values that are set in a scope."""
        return self.values.get(scope, {})

    def with_values(self, scope: Scope, values: Values) -> Self:
        """These overrides, with values set in a scope beside those that are there.

        Raises
        ------
        KeyError
            There is no parameter of that name.
        """
        for name in values:
            if name not in DEFAULTS:
                raise KeyError(f"{name!r} is no parameter of actors")
        return self._replaced(scope, {**self.of(scope), **values})

    def without(self, scope: Scope, *names: str) -> Self:
        """These overrides without some values of a scope; without all of it if none is named."""
        kept = {} if not names else {n: v for n, v in self.of(scope).items() if n not in names}
        return self._replaced(scope, kept)

    def effective(self, actor: str, groups: tuple[str, ...] = ()) -> dict[str, Source]:
        """Every parameter of an actor of some groups, each with where it comes from."""
        found = {name: Source(value, "default") for name, value in DEFAULTS.items()}
        found |= {name: Source(value, "world") for name, value in self.of(WORLD).items()}
        for group in groups:
            values = self.of(Scope("group", group))
            found |= {name: Source(value, "group", group) for name, value in values.items()}
        own = self.of(Scope("own", actor))
        return found | {name: Source(value, "own") for name, value in own.items()}

    def parameters(self, actor: str, groups: tuple[str, ...] = ()) -> ActorParameters:
        """The parameters of an actor.

        Raises
        ------
        pydantic.ValidationError
            The values do not go together, or one is out of its range.
        """
        sources = self.effective(actor, groups)
        return ActorParameters(**{name: each.value for name, each in sources.items()})

    def shadowed(self, scope: Scope, name: str) -> Iterator[Scope]:
        """The narrower scopes in which a value is set too, so that one set here shows less."""
        order = ("world", "group", "own")
        for other, values in self.values.items():
            if name in values and order.index(other.level) > order.index(scope.level):
                yield other

    def differences(self, later: Overrides) -> list[Difference]:
        """All that is another in later overrides, ordered by scope and name."""
        return [
            Difference(scope, name, self.of(scope).get(name), later.of(scope).get(name))
            for scope in sorted({*self.values, *later.values}, key=lambda s: (s.level, s.name))
            for name in sorted({*self.of(scope), *later.of(scope)})
            if self.of(scope).get(name) != later.of(scope).get(name)
        ]

    def _replaced(self, scope: Scope, values: Values) -> Self:
        others = {other: kept for other, kept in self.values.items() if other != scope}
        return type(self)({**others, scope: values} if values else others)
