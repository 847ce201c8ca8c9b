"""The roster of a world: which actors walk in it from the beginning, and how."""

from collections import Counter
from pathlib import Path
from typing import Annotated, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from esplanade.actors import ActorParameters, ActorSpec, Overrides, Scope
from esplanade.actors.overrides import WORLD
from esplanade.files.content import ContentError
from esplanade.files.text import read_text

MOST_ACTORS = 1000


class RosterError(ValueError):
    """A roster that cannot be used; the message names the file and the place in it."""


class Roster(BaseModel):
    """Actors, and the parameters that hold for all of them and for groups of them."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    actors: Annotated[tuple[ActorSpec, ...], Field(max_length=MOST_ACTORS)] = ()
    world: dict[str, float | int] = {}
    """Parameters of all actors."""
    groups: dict[str, dict[str, float | int]] = {}
    """Parameters of the actors that have a tag, by the tag."""

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        for actor_id, times in Counter(spec.id for spec in self.actors).items():
            if times > 1:
                raise ValueError(f"{times} actors have the id {actor_id!r}")
        try:
            overrides = self.overrides
        except KeyError as error:
            raise ValueError(error.args[0]) from None
        for spec in self.actors:
            try:
                overrides.parameters(spec.id, spec.tags)
            except ValidationError as error:
                fault = error.errors()[0]
                raise ValueError(f"the parameters of {spec.id}: {fault['msg']}") from None
        return self

    @property
    def overrides(self) -> Overrides:
        """The parameters that are not the usual ones, by scope."""
        overrides = Overrides()
        scopes = [(WORLD, self.world)]
        scopes += [(Scope("group", tag), values) for tag, values in self.groups.items()]
        scopes += [(Scope("own", spec.id), spec.overrides) for spec in self.actors]
        for scope, values in scopes:
            if values:
                overrides = overrides.with_values(scope, values)
        return overrides

    def parameters(self) -> list[ActorParameters]:
        """The parameters of each actor, in their order."""
        overrides = self.overrides
        return [overrides.parameters(spec.id, spec.tags) for spec in self.actors]


def read_roster(path: Path) -> Roster:
    """Read a roster from a JSON file.

    Raises
    ------
    RosterError
        The file cannot be read, or does not hold what it should.
    """
    try:
        return Roster.model_validate_json(read_text(path))
    except ContentError as error:
        raise RosterError(f"{path}: {error}") from error
    except ValidationError as error:
        fault = error.errors()[0]
        where = ".".join(map(str, fault["loc"]))
        raise RosterError(f"{path}: {where + ': ' if where else ''}{fault['msg']}") from error
