"""Travels of actors that were a short while ago, as checkpoints of zones remember them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from esplanade.actors import ActorParameters, ActorSpec


@dataclass(frozen=True)
class Gone:
    """An actor that has gone by a portal."""

    tick: int
    portal: str
    spec: ActorSpec
    parameters: ActorParameters


@dataclass(frozen=True)
class Lately:
    """The actors who have come into a zone lately, with the ticks, and those who have gone."""

    came: dict[str, int] = field(default_factory=dict)
    gone: dict[str, Gone] = field(default_factory=dict)

    def forget(self, tick: int) -> None:
        """Forget who came or went before a tick."""
        for actor in [actor for actor, at in self.came.items() if at < tick]:
            del self.came[actor]
        for actor in [actor for actor, gone in self.gone.items() if gone.tick < tick]:
            del self.gone[actor]

    def save(self) -> dict[str, Any]:
        """The same as plain data."""
        gone = [
            [one.tick, one.portal, one.spec.model_dump_json(), one.parameters.model_dump_json()]
            for one in self.gone.values()
        ]
        return {"came": self.came.copy(), "gone": gone}

    @classmethod
    def load(cls, saved: Mapping[str, Any]) -> "Lately":
        """The same from plain data.

        Raises
        ------
        ValueError, KeyError, TypeError
            They are not what `save` gives.
        """
        gone = {}
        for tick, portal, spec_text, parameters in saved["gone"]:
            spec = ActorSpec.model_validate_json(spec_text)
            made = ActorParameters.model_validate_json(parameters)
            gone[spec.id] = Gone(int(tick), str(portal), spec, made)
        return cls({str(actor): int(tick) for actor, tick in saved["came"].items()}, gone)
