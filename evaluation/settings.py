"""Settings of our own actor by name: its parameters, and those of the models it plans with."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, fields
from typing import Any, Final

from pydantic import BaseModel, TypeAdapter, ValidationError

from esplanade.actors import ActorParameters
from esplanade.commandline.fields import in_words
from esplanade.commandline.parser import suggestion
from esplanade.planning import PlanModel, PredictionModel, RiskModel, RuleModel

MODELS: Final[Mapping[str, type]] = {
    "risk": RiskModel,
    "prediction": PredictionModel,
    "plan": PlanModel,
    "rules": RuleModel,
}
"""A model's field is called by this name, a point, and its own; a parameter by its own alone."""

NOT_SET: Final = frozenset({"plan.threads", "prediction.spread"})
"""Threads change no result: processes share the work already. A spread is no single value."""


def _defaults(kind: Any) -> dict[str, Any]:
    if issubclass(kind, BaseModel):
        return {name: field.default for name, field in kind.model_fields.items()}
    return {field.name: field.default for field in fields(kind)}


DEFAULTS: Final[Mapping[str, Any]] = {
    **_defaults(ActorParameters),
    **{
        f"{model}.{name}": default
        for model, kind in MODELS.items()
        for name, default in _defaults(kind).items()
        if isinstance(default, int | float) and f"{model}.{name}" not in NOT_SET
    },
}
"""Every setting there is, with its default: all that is a number, or yes or no."""


class SettingError(ValueError):
    """No such setting, or a value it cannot have; the message says which and why."""


@dataclass(frozen=True)
class Models:
    """Models that the actors of a zone share."""

    risk: RiskModel
    prediction: PredictionModel
    plan: PlanModel
    rules: RuleModel


def read_changes(texts: Sequence[str]) -> dict[str, Any]:
    """Checked settings from NAME=VALUE, as `--set` has them; the last one of a name counts."""
    with _of_option("--set"):
        return check(dict(_parted(text) for text in texts))


def read_choices(texts: Sequence[str]) -> dict[str, tuple[Any, ...] | None]:
    """Checked values of settings from NAME=V1,V2,.., as `--vary` has them; None for a mere NAME."""
    found: dict[str, tuple[Any, ...] | None] = {}
    with _of_option("--vary"):
        for text in texts:
            name, given, values = text.partition("=")
            _require_known(name)
            each = (check({name: value})[name] for value in values.split(","))
            found[name] = tuple(each) if given else None
    return found


def check(settings: Mapping[str, Any]) -> dict[str, Any]:
    """The same settings, their values in their own types.

    Raises
    ------
    SettingError
        A name is unknown, a value has the wrong type or is out of range, or two do not fit.
    """
    for name in settings:
        _require_known(name)
    parameters, groups = _grouped(settings)
    found = _validated("", TypeAdapter(ActorParameters), parameters)
    for model, values in groups.items():
        found |= _validated(f"{model}.", TypeAdapter(MODELS[model]), values)
    return {name: found[name] for name in settings}


def models_of(settings: Mapping[str, Any]) -> Models:
    """The models with these checked settings, all else as it is by default."""
    groups = _grouped(settings)[1]
    return Models(**{model: kind(**groups[model]) for model, kind in MODELS.items()})


def parameters_of(settings: Mapping[str, Any], given: Mapping[str, Any]) -> ActorParameters:
    """An actor's parameters: checked settings go before `given`, and that before defaults."""
    return ActorParameters(**{**given, **_grouped(settings)[0]})


def _grouped(settings: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, dict[str, Any]]]:
    """Parameters of the actor, and fields of each model."""
    parameters: dict[str, Any] = {}
    groups: dict[str, dict[str, Any]] = {model: {} for model in MODELS}
    for name, value in settings.items():
        model, point, field = name.partition(".")
        if point:
            groups[model][field] = value
        else:
            parameters[name] = value
    return parameters, groups


def _validated(prefix: str, adapter: TypeAdapter[Any], values: Mapping[str, Any]) -> dict[str, Any]:
    try:
        made = adapter.validate_python(values)
    except ValidationError as error:
        told = in_words(error)
        where = "" if error.errors()[0]["loc"] else f"{', '.join(values)}: "
        raise SettingError(f"{prefix}{where}{told}") from None
    found = {prefix + name: getattr(made, name) for name in values}
    for name, value in found.items():
        if not value >= 0:
            raise SettingError(f"{name}: {value} is negative, or no number")
    return found


def _parted(text: str) -> tuple[str, str]:
    name, given, value = text.partition("=")
    if not given:
        raise SettingError(f"{text!r} is not NAME=VALUE")
    return name, value


def _require_known(name: str) -> None:
    if name in DEFAULTS:
        return
    raise SettingError(f"{name}: there is no such setting{suggestion(name, DEFAULTS)}")


@contextmanager
def _of_option(option: str) -> Iterator[None]:
    """Faults say which option they are in."""
    try:
        yield
    except SettingError as error:
        raise SettingError(f"{option} {error}") from None
