"""The policy that a study is of, and its settings: our own actor, or a policy from outside."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from typing import Any, Final

from esplanade.actors import ActorParameters
from esplanade.evaluation import settings as of_actor
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.settings import DEFAULTS, SettingError
from esplanade.evaluation.studies.variants import OURS, Variant
from esplanade.planning import RuleModel
from esplanade.policies.names import frozen, option_value

RULES_PREFIX: Final = "rules."


class Subject(ABC):
    """A policy with settings that a study varies."""

    @abstractmethod
    def check(self, settings: Mapping[str, Any]) -> dict[str, Any]:
        """The same settings, their values in their own types.

        Raises
        ------
        SettingError
            A name or a value cannot be.
        """

    @abstractmethod
    def read_choices(self, texts: Sequence[str]) -> dict[str, tuple[Any, ...] | None]:
        """Checked values from NAME=V1,V2,.., as `--vary` has them; None for a mere NAME."""

    @abstractmethod
    def baseline(self, name: str, base: Mapping[str, Any]) -> Any:
        """The value of a setting in the baseline, which has the settings of `base`.

        Raises
        ------
        SettingError
            It is not known.
        """

    @abstractmethod
    def schema(self, name: str) -> Mapping[str, Any]:
        """The JSON schema of a setting, with its unit and limits where they are known."""

    @abstractmethod
    def variant(self, rules: Rules, settings: Mapping[str, Any]) -> Variant:
        """The variant with checked settings."""


class OurActor(Subject):
    """Our own actor, whose parameters and models have names, limits and defaults."""

    def check(self, settings: Mapping[str, Any]) -> dict[str, Any]:
        return of_actor.check(settings)

    def read_choices(self, texts: Sequence[str]) -> dict[str, tuple[Any, ...] | None]:
        return of_actor.read_choices(texts)

    def baseline(self, name: str, base: Mapping[str, Any]) -> Any:
        return base.get(name, DEFAULTS[name])

    def schema(self, name: str) -> Mapping[str, Any]:
        of_rules = name.startswith(RULES_PREFIX)
        kind = RuleModel if of_rules else ActorParameters
        known = kind.model_json_schema()["properties"]
        found: Mapping[str, Any] = known.get(name.removeprefix(RULES_PREFIX) if of_rules else name)
        return found or {}

    def variant(self, rules: Rules, settings: Mapping[str, Any]) -> Variant:
        return Variant.of(rules, settings)


class FromOutside(Subject):
    """A policy from outside; its settings are keywords of its constructor, which judges them."""

    def __init__(self, policy: str) -> None:
        self._policy = policy

    def check(self, settings: Mapping[str, Any]) -> dict[str, Any]:
        found = {}
        for name, value in settings.items():
            if not name.isidentifier():
                raise SettingError(f"{name!r} cannot be a keyword of a policy")
            try:
                found[name] = frozen(value)
            except ValueError as error:
                raise SettingError(f"{name}: {error}") from None
        return found

    def read_choices(self, texts: Sequence[str]) -> dict[str, tuple[Any, ...] | None]:
        found: dict[str, tuple[Any, ...] | None] = {}
        for text in texts:
            name, given, values = text.partition("=")
            if not name.isidentifier():
                raise SettingError(f"--vary {name!r} cannot be a keyword of a policy")
            read = tuple(option_value(value) for value in values.split(","))
            found[name] = read if given else None
        return found

    def baseline(self, name: str, base: Mapping[str, Any]) -> Any:
        if name not in base:
            raise SettingError(
                f"{name}: say its value in the baseline by --policy-option {name}=VALUE"
            )
        return base[name]

    def schema(self, name: str) -> Mapping[str, Any]:  # noqa: ARG002 - nothing is known of any
        return {}

    def variant(self, rules: Rules, settings: Mapping[str, Any]) -> Variant:
        return Variant(rules, tuple(sorted(settings.items())), self._policy)


OUR_ACTOR: Final = OurActor()


def subject_of(policy: str) -> Subject:
    """The subject of a study by the policy's name."""
    return OUR_ACTOR if policy == OURS else FromOutside(policy)
