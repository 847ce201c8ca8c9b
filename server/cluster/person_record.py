"""The record of a person in the seat: whatever is to go along from process to process is here."""

from typing import Annotated, Final

import msgpack
from pydantic import BaseModel, ConfigDict, Field, ValidationError

Metres = Annotated[float, Field(allow_inf_nan=False)]

VERSION: Final = 1


class RecordError(ValueError):
    """The bytes are no record of a person; the message says what is wrong."""


class PersonRecord(BaseModel):
    """All that a seat says of a person beside its columns. Fields without a value may be left out,
    so that older and newer programs read each other's records."""

    model_config = ConfigDict(frozen=True, extra="ignore")

    address: str = ""
    """The key by which limits of the client's address go."""
    place: tuple[Metres, Metres, Metres] | None = None
    """The place at which the avatar is to come into being, x, y and height, metres; None for any
    spawn."""
    anywhere: bool = False
    """Whether that very place is meant; otherwise the spawn that is nearest to it is."""
    operator: bool = False
    """Whether the person may move doors."""
    account: str = ""
    """The account of an operator who walks about as oneself; empty for others."""
    portal: str = ""
    """The portal out of which the person comes; empty for a newcomer."""
    muted: tuple[int, ...] = ()
    """Those whom the person does not want to hear."""
    silent_s: Annotated[float, Field(ge=0.0, allow_inf_nan=False)] = 0.0
    """For how many seconds nobody hears the person yet, from the moment of coming into the zone."""
    wished: str = ""
    """The name that the person asked for; the seat's may have a number behind it."""
    look: Annotated[tuple[int, ...], Field(max_length=64)] = ()
    """The numbers of the person's look; none where none is chosen."""


def encode_record(record: PersonRecord) -> bytes:
    """Return the bytes of a record."""
    packed: bytes = msgpack.packb([VERSION, record.model_dump(exclude_defaults=True)])
    return packed


def decode_record(packed: bytes) -> PersonRecord:
    """Return the record that the bytes say; no bytes are an empty one.

    Raises
    ------
    RecordError
        They say none.
    """
    if not packed:
        return PersonRecord()
    try:
        version, fields = msgpack.unpackb(packed)
        if version != VERSION:
            raise RecordError(f"the record has version {version}, this program reads {VERSION}")
        return PersonRecord.model_validate(fields)
    except (ValidationError, ValueError, TypeError, msgpack.UnpackException) as error:
        raise RecordError(f"the record of a person cannot be read: {error}") from None
