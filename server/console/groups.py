"""Groups by purpose: an actor has one at most for each purpose, beside the tags of its roster."""

from collections.abc import Mapping
from typing import Any, Final

from esplanade.actors import ActorSpec
from esplanade.protocol.commands import Facts

GROUP: Final = "group:"
"""The beginning of the field of an actor that says its group for a purpose."""


class Groups:
    """The groups of each actor, by purpose. Nothing here is changed: `taking` gives others."""

    def __init__(self, of_actors: Mapping[str, Mapping[str, str]] | None = None) -> None:
        self._of_actors = {name: dict(found) for name, found in (of_actors or {}).items()}

    def of(self, actor: str) -> Mapping[str, str]:
        """The name of an actor's group, by purpose."""
        return self._of_actors.get(actor, {})

    def names(self, spec: ActorSpec) -> tuple[str, ...]:
        """The groups whose values hold for an actor; the last prevails over those before.

        Its tags come first, then its groups, by purpose in the order of the alphabet.
        """
        return (
            *spec.tags,
            *(f"{purpose}:{name}" for purpose, name in sorted(self.of(spec.id).items())),
        )

    def members(self) -> dict[str, list[str]]:
        """The actors of each group, `purpose:name`."""
        found: dict[str, list[str]] = {}
        for actor, groups in sorted(self._of_actors.items()):
            for purpose, name in sorted(groups.items()):
                found.setdefault(f"{purpose}:{name}", []).append(actor)
        return found

    def taking(self, facts: Facts) -> "Groups":
        """The groups after these facts."""
        changed: dict[str, dict[str, str]] = {}
        for subject, fields in facts.items():
            kind, _, actor = subject.partition(":")
            if kind != "actor":
                continue
            for field, value in fields.items():
                if field.startswith(GROUP):
                    own = changed.setdefault(actor, dict(self.of(actor)))
                    own.pop(field.removeprefix(GROUP), None)
                    if value is not None:
                        own[field.removeprefix(GROUP)] = value
        if not changed:
            return self
        merged = {**self._of_actors, **changed}
        return Groups({actor: groups for actor, groups in merged.items() if groups})

    def save(self) -> dict[str, Any]:
        """All of it as plain data."""
        return {"actors": {actor: dict(groups) for actor, groups in self._of_actors.items()}}

    @classmethod
    def load(cls, data: Mapping[str, Any]) -> "Groups":
        """The groups as they were saved."""
        return cls(data["actors"])


def moved(facts: Facts) -> set[str]:
    """The actors whose groups become others by facts."""
    return {
        subject.partition(":")[2]
        for subject, fields in facts.items()
        if subject.startswith("actor:") and any(field.startswith(GROUP) for field in fields)
    }
