"""Requests of operators on their way from a gateway to the host of a zone and back, as bytes.

A gateway finds out who asks, and says so: neither passwords nor tokens go along. What is answered
comes in parts with numbers, so that one that is lost is noticed, and no more of them are under way
than the gateway has written.
"""

from dataclasses import dataclass, field
from typing import Any, Final, Literal

import msgpack
from pydantic import TypeAdapter, ValidationError

VERSION: Final = 1
PART_BYTES: Final = 256 * 1024
"""No part holds more of an answer."""
PARTS_UNDER_WAY: Final = 8
"""Parts that may be sent before the gateway says that it has written one of them."""
ALIVE_S: Final = 3.0
"""Each end says that it is there so often, for as long as a request is under way."""
SILENT_S: Final = 12.0
"""An end that has not been heard for so long is gone."""

Headers = list[tuple[bytes, bytes]]


class CallError(ValueError):
    """The bytes are no part of a request; the message says what is wrong."""


@dataclass(frozen=True)
class Caller:
    """The operator who asks, as `esplanade.server.accounts.identity.Identity` has it."""

    account: str | None
    role: str
    rights: tuple[str, ...]
    via: str
    address: str | None


@dataclass(frozen=True)
class Call:
    """A request as it begins."""

    name: str
    """The name of the request, which no other has: letters and digits."""
    gateway: str
    caller: Caller
    kind: Literal["http", "websocket"]
    method: str
    path: str
    query: bytes
    headers: Headers = field(default_factory=list)
    """Those that say something of the body, or of what is wanted; none says who asks."""
    body: bytes = b""


@dataclass(frozen=True)
class Begun:
    """The begin of an answer: its status and headers; of a socket, that it is accepted."""

    status: int
    headers: Headers


@dataclass(frozen=True)
class Part:
    """A part of an answer, or of a message of a socket, and whether more of it comes."""

    data: bytes | str
    more: bool


@dataclass(frozen=True)
class Closed:
    """A socket is closed, with a code; before it was accepted, it is refused."""

    code: int


@dataclass(frozen=True)
class Alive:
    """The end is there, and nothing else is to be said yet."""


Answered = Begun | Part | Closed | Alive


@dataclass(frozen=True)
class Written:
    """Parts up to this number have been written to the client, or are not wanted any more."""

    number: int


@dataclass(frozen=True)
class Said:
    """The client of a socket has sent this text."""

    text: str


@dataclass(frozen=True)
class Gone:
    """The client is gone, or wants no more."""


Added = Written | Said | Gone | Alive

_CALL: Final = TypeAdapter(Call)
_ANSWERED: Final = {"begun": Begun, "part": Part, "closed": Closed, "alive": Alive}
_ADDED: Final = {"written": Written, "said": Said, "gone": Gone, "alive": Alive}
_NAMES: Final = {kind: name for kinds in (_ANSWERED, _ADDED) for name, kind in kinds.items()}
_READERS: Final[dict[str, TypeAdapter[Any]]] = {
    name: TypeAdapter(kind) for kind, name in _NAMES.items()
}


def encode_call(call: Call) -> bytes:
    """Return the bytes of a request."""
    packed: bytes = msgpack.packb([VERSION, _CALL.dump_python(call)])
    return packed


def decode_call(message: bytes) -> Call:
    """Return the request that the bytes say.

    Raises
    ------
    CallError
        They say none.
    """
    match _unpacked(message):
        case [version, fields] if version == VERSION:
            call: Call = _read(_CALL, fields)
            return call
        case [version, _]:
            raise CallError(f"the request has version {version}, and this program reads {VERSION}")
    raise CallError("the bytes are no request")


def encode_answered(number: int, answered: Answered) -> bytes:
    """Return the bytes of what comes back; numbers begin with 1 and count all but `Alive`."""
    return _encoded([number, _NAMES[type(answered)], answered])


def decode_answered(message: bytes) -> tuple[int, Answered]:
    """Return what comes back, and its number.

    Raises
    ------
    CallError
        The bytes say nothing of that.
    """
    number, answered = _decoded(message, 3, _ANSWERED)
    return number, answered


def encode_added(added: Added) -> bytes:
    """Return the bytes of what a gateway adds to a request that has begun."""
    return _encoded([_NAMES[type(added)], added])


def decode_added(message: bytes) -> Added:
    """Return what a gateway adds.

    Raises
    ------
    CallError
        The bytes say nothing of that.
    """
    added: Added = _decoded(message, 2, _ADDED)[-1]
    return added


def _encoded(said: list[Any]) -> bytes:
    fields = vars(said[-1])
    packed: bytes = msgpack.packb([*said[:-1], fields])
    return packed


def _decoded(message: bytes, length: int, kinds: dict[str, Any]) -> list[Any]:
    said = _unpacked(message)
    if not isinstance(said, list) or len(said) != length or str(said[-2]) not in kinds:
        raise CallError(f"there are no parts of a request but {', '.join(kinds)}")
    if length > 2 and not (isinstance(said[0], int) and said[0] >= 0):
        raise CallError("a part of a request has a number")
    return [*said[:-2], _read(_READERS[str(said[-2])], said[-1])]


def _unpacked(message: bytes) -> Any:
    try:
        return msgpack.unpackb(message)
    except (ValueError, msgpack.UnpackException) as error:
        raise CallError(f"the bytes are not msgpack: {error}") from None


def _read(reader: TypeAdapter[Any], fields: Any) -> Any:
    try:
        return reader.validate_python(fields)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        where = " / ".join(str(part) for part in first["loc"])
        raise CallError(f"a part of a request: {where}: {first['msg']}") from None
