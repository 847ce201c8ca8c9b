"""The facts of a zone that gateways tell newcomers, as bytes in the database."""

from dataclasses import asdict
from typing import Annotated, Any, Final

import msgpack
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from esplanade.server.world.rules import Rules

VERSION: Final = 1


class DescriptionError(ValueError):
    """The bytes describe no zone; the message says why."""


class ZoneDescription(BaseModel):
    """A zone as a gateway knows it before the first frame."""

    model_config = ConfigDict(frozen=True, extra="ignore")

    scene: bytes
    """The scene as it stands in a welcome, packed."""
    title: str
    """The name of the scene."""
    rules: dict[str, float | int]
    origin_m: tuple[float, float]
    resume_seconds: float
    people: Annotated[int, Field(ge=1)]
    """The most people who may be in the zone."""
    mesh: str | None = None
    """The address of the triangles of a building that is a mesh, as seen from the page."""

    @property
    def world_rules(self) -> Rules:
        """The rules that hold in the zone."""
        return Rules(**self.rules)  # type: ignore[arg-type] # checked when it is read


def encode_description(description: ZoneDescription) -> bytes:
    """Return the bytes of a description."""
    packed: bytes = msgpack.packb([VERSION, description.model_dump()])
    return packed


def decode_description(packed: bytes) -> ZoneDescription:
    """Return the description that the bytes say.

    Raises
    ------
    DescriptionError
        They say none, or one of another version.
    """
    try:
        version, fields = msgpack.unpackb(packed)
        if version != VERSION:
            raise DescriptionError(
                f"the description of a zone has version {version}, this program reads {VERSION}"
            )
        found = ZoneDescription.model_validate(fields)
        _ = found.world_rules
    except (ValidationError, ValueError, TypeError, msgpack.UnpackException) as error:
        raise DescriptionError(f"the description of a zone cannot be read: {error}") from None
    return found


def rules_told(rules: Rules) -> dict[str, Any]:
    """The rules as plain data."""
    return asdict(rules)
