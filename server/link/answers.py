"""Answers of a host for single people, as bytes: what is told to them alone, by their gateway."""

from collections.abc import Sequence
from typing import Annotated, Final, NamedTuple

import msgpack
from pydantic import Field, TypeAdapter, ValidationError

from esplanade.protocol import CloseCode

VERSION: Final = 1
MOST_BYTES: Final = 512 * 1024
"""Answers that together are longer than this go out in several messages."""

Number = Annotated[int, Field(ge=0, le=2**63 - 1)]


class Answer(NamedTuple):
    """An answer for whoever occupies a seat with this generation, and for nobody else."""

    person: Number
    generation: Number
    frame: bytes
    """The frame for the client; empty where the seat is taken by somebody who came later."""
    close: CloseCode | None = None
    """The code with which the connection is to end after that frame; None where it does not."""
    reason: str = ""
    """The reason of such an end, for metrics."""


_ANSWERS: Final = TypeAdapter(tuple[int, str, list[Answer]])


class AnswerError(ValueError):
    """The bytes are no answers of this version; the message says what is wrong."""


def encode_answers(zone: str, answers: Sequence[Answer]) -> list[bytes]:
    """Return the messages that carry the answers of a zone, in their order."""
    messages: list[bytes] = []
    part: list[Answer] = []
    size = 0
    for answer in answers:
        if part and size + len(answer.frame) > MOST_BYTES:
            messages.append(msgpack.packb((VERSION, zone, part)))
            part, size = [], 0
        part.append(answer)
        size += len(answer.frame) + 32
    if part:
        messages.append(msgpack.packb((VERSION, zone, part)))
    return messages


def decode_answers(message: bytes) -> tuple[str, list[Answer]]:
    """Return the zone and its answers.

    Raises
    ------
    AnswerError
        The bytes say none.
    """
    try:
        version, zone, answers = _ANSWERS.validate_python(msgpack.unpackb(message))
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        raise AnswerError(f"the answers: {first['loc']}: {first['msg']}") from None
    except (ValueError, msgpack.UnpackException, TypeError) as error:
        raise AnswerError(f"the answers are not msgpack: {error}") from None
    if version != VERSION:
        raise AnswerError(f"the answers have version {version}, and this program reads {VERSION}")
    return zone, answers
