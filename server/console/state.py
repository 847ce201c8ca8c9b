"""The facts that operators can change, as fields of subjects that can be compared."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any, Final

from esplanade.actors import ActorSpec, Overrides, Scope
from esplanade.actors.overrides import DEFAULTS, WORLD, Values
from esplanade.protocol.commands import Facts
from esplanade.server.console.groups import GROUP, Groups, moved
from esplanade.server.console.presets import Presets
from esplanade.server.console.recording import RECORDING, Recorder
from esplanade.server.console.schedules import Schedules
from esplanade.server.world.pace import Pace
from esplanade.server.world.zone import Zone

BEHAVIOUR: Final = "behaviour"
HELD: Final = "held"
PRESENT: Final = "present"
OPEN: Final = "open"
FACTOR: Final = "factor"
PAUSED: Final = "paused"
STEPPED: Final = "stepped"
"""Fields of subjects that are no parameters."""
PACE: Final = "pace"
"""The subject that the time of the world is."""


class OperatedState:
    """The facts of a zone. A value of None stands for what is not set, or not there."""

    def __init__(
        self,
        zone: Zone,
        overrides: Overrides,
        presets: Presets | None = None,
        pace: Pace | None = None,
    ) -> None:
        self.zone = zone
        self.pace = pace or Pace()
        self.overrides = overrides
        self.groups = Groups()
        self.presets = presets or Presets()
        self.schedules = Schedules()
        self.held: set[str] = set()
        self.recorder: Recorder | None = None
        """Where recordings go; None where there is no folder for them."""
        self.elsewhere: dict[str, Callable[[str, str], Any]] = {}
        """Tells the fields of subjects that are kept elsewhere, by the kind of subject."""
        self._doors: dict[str, bool] = {}
        """The latest wish for each door that was wanted open or closed."""

    def fact(self, subject: str, field: str) -> Any:  # noqa: PLR0911 (one for each kind)
        """Return the present value of a field of a subject."""
        kind, _, name = subject.partition(":")
        if kind == PACE:
            return getattr(self.pace.state, field, None)
        if kind == RECORDING:
            return self.recorder is not None and self.recorder.is_on
        if kind in self.elsewhere:
            return self.elsewhere[kind](subject, field)
        match kind, field:
            case "door", _:
                return self._doors.get(name, self.zone.doors.states().get(name))
            case "actor", "behaviour":
                spec = self.zone.actors.get(name)
                return None if spec is None else spec.behaviour.model_dump(mode="json")
            case "actor", "held":
                return name in self.held
            case "actor", "present":
                return self._present(name)
            case "actor", _ if field.startswith(GROUP):
                return self.groups.of(name).get(field.removeprefix(GROUP))
            case "preset", _:
                return self.presets.fact(name)
            case "schedule", _:
                return self.schedules.fact(name)
        return self.overrides.of(scope_of(subject)).get(field)

    def now(self, facts: Facts) -> Facts:
        """Return the present values of the same fields of the same subjects."""
        return {
            subject: {field: self.fact(subject, field) for field in fields}
            for subject, fields in facts.items()
        }

    def take(self, facts: Facts) -> None:
        """These facts are true from now on: the world has carried them out."""
        for subject, field, value in each(facts):
            kind, _, name = subject.partition(":")
            match kind, field:
                case "door", _:
                    self._doors[name] = value
                case "actor", "behaviour":
                    pass  # the world knows it
                case "actor", "held":
                    (self.held.add if value else self.held.discard)(name)
                case "actor", "present":
                    self.held.discard(name)
                    own = {} if value is None else value["overrides"]
                    cleared = self.overrides.without(Scope("own", name))
                    self.overrides = cleared.with_values(Scope("own", name), own)
                case "preset", _:
                    self.presets.take(name, value)
                case "schedule", _:
                    self.schedules.take(name, value)
        self.groups = self.groups.taking(facts)
        self.overrides = with_facts(self.overrides, facts)

    def save(self) -> dict[str, Any]:
        """All that is set, as plain data."""
        return {
            "overrides": [
                [scope.level, scope.name, dict(values)]
                for scope, values in self.overrides.values.items()
            ],
            "held": list(self.held),
            "doors": dict(self._doors),
            "groups": self.groups.save(),
        }

    def load(self, saved: Mapping[str, Any]) -> None:
        """Set what was saved.

        Raises
        ------
        ValueError, KeyError, TypeError
            Something is missing, or cannot be.
        """
        overrides = Overrides()
        for level, name, values in saved["overrides"]:
            if level not in {"world", "group", "own"}:
                raise ValueError(f"there is no scope of level {level!r}")
            for value in values.values():
                if isinstance(value, bool) or not isinstance(value, int | float):
                    raise TypeError(f"a parameter cannot be {value!r}")
            overrides = overrides.with_values(Scope(level, name), values)
        groups = Groups.load(saved.get("groups", {"actors": {}}))
        for spec in self.zone.actors.values():
            overrides.parameters(spec.id, groups.names(spec))
        doors = {str(name): bool(is_open) for name, is_open in saved["doors"].items()}
        self.overrides, self.held, self._doors = overrides, set(saved["held"]), doors
        self.groups = groups

    def reached(self, scopes: Iterable[Scope], facts: Facts) -> list[ActorSpec]:
        """The actors whose parameters may be others when values in these scopes are, or groups."""
        names: dict[str, set[str]] = {"world": set(), "group": set(), "own": set()}
        for scope in scopes:
            names[scope.level].add(scope.name)
        specs = list(self.zone.actors.values())
        if names["world"]:
            return specs
        groups, own = names["group"], names["own"] | moved(facts)
        return [
            spec
            for spec in specs
            if spec.id in own or not groups.isdisjoint(self.groups.names(spec))
        ]

    def _present(self, name: str) -> Any:
        spec = self.zone.actors.get(name)
        if spec is None:
            return None
        own = dict(self.overrides.of(Scope("own", name)))
        return spec.model_copy(update={"overrides": own}).model_dump(mode="json")


def each(facts: Facts) -> Iterator[tuple[str, str, Any]]:
    """Every fact: the subject, the field and its value."""
    for subject, fields in facts.items():
        for field, value in fields.items():
            yield subject, field, value


def scope_of(subject: str) -> Scope:
    """The scope that a subject of parameters is."""
    kind, _, name = subject.partition(":")
    match kind:
        case "world":
            return WORLD
        case "group":
            return Scope("group", name)
    return Scope("own", name)


def parameters_of(facts: Facts) -> dict[Scope, dict[str, float | int | None]]:
    """The facts about parameters alone, by scope."""
    found: dict[Scope, dict[str, float | int | None]] = {}
    for subject, field, value in each(facts):
        if field in DEFAULTS:
            found.setdefault(scope_of(subject), {})[field] = value
    return found


def with_facts(overrides: Overrides, facts: Facts) -> Overrides:
    """The overrides after these facts."""
    for scope, values in parameters_of(facts).items():
        given = {name: value for name, value in values.items() if value is not None}
        cleared = [name for name, value in values.items() if value is None]
        if cleared:
            overrides = overrides.without(scope, *cleared)
        if given:
            overrides = overrides.with_values(scope, given)
    return overrides


class Effective:
    """The effective parameters of many actors, found without a scope made for each."""

    def __init__(self, overrides: Overrides) -> None:
        self._by_level: dict[str, dict[str, Values]] = {"world": {}, "group": {}, "own": {}}
        for scope, values in overrides.values.items():
            self._by_level[scope.level][scope.name] = values

    def values(
        self, actor: str, of_groups: tuple[str, ...], names: Iterable[str]
    ) -> list[float | int]:
        """Some parameters of an actor of some groups, in the order of their names."""
        groups = self._by_level["group"]
        layers = [
            self._by_level["own"].get(actor, _NONE),
            *(groups[name] for name in reversed(of_groups) if name in groups),
            self._by_level["world"].get("", _NONE),
            DEFAULTS,
        ]
        return [next(layer[name] for layer in layers if name in layer) for name in names]


_NONE: Final[Values] = {}
