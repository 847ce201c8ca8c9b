"""Frames of the server, of which a bot passes over what a later version has added.

Later versions of the protocol add messages, fields and names of errors. Fields that are unknown are
ignored by the models; this file passes over the rest.
"""

from typing import Any, Final

import msgpack

from esplanade.protocol import ErrorCode, ProtocolError, ServerCode, decode_server
from esplanade.protocol.codes import CloseCode
from esplanade.protocol.messages import ServerMessage

_ARRAYS: Final = range(0x91, 0xA0)
"""First bytes of short msgpack arrays that hold something."""
_CODES: Final = frozenset(int(code) for code in ServerCode)
_ERRORS: Final = frozenset(code.value for code in ErrorCode)


def decode(frame: bytes) -> ServerMessage | None:
    """The message, or None where this version knows nothing of it.

    Raises
    ------
    ProtocolError
        The frame breaks the protocol of every version.
    """
    if len(frame) > 1 and frame[0] in _ARRAYS and frame[1] not in _CODES:
        _check_unknown(frame)
        return None
    if is_error(frame) and error_code(frame)[0] not in _ERRORS:
        return None
    return decode_server(frame)


def is_error(frame: bytes) -> bool:
    """Whether the server complains."""
    return frame[:2] == bytes([0x92, ServerCode.ERROR])


def error_code(frame: bytes) -> tuple[str, str]:
    """The name and the text of an error, whether this version knows the name or not.

    Raises
    ------
    ProtocolError
        It has none.
    """
    fields = _unpacked(frame)[1]
    match fields:
        case {"error": str(code), "text": str(text)}:
            return code, text
    raise _malformed("an error has a name and a text")


def _check_unknown(frame: bytes) -> None:
    """An unknown message is an array that begins with a whole number."""
    if type(_unpacked(frame)[0]) is not int:
        raise _malformed("a message code is an integer")


def _unpacked(frame: bytes) -> list[Any]:
    try:
        parts: list[Any] = msgpack.unpackb(frame, strict_map_key=False)
    except (ValueError, TypeError, OverflowError) as error:  # among them all of msgpack's own
        raise _malformed(f"not msgpack: {type(error).__name__}") from None
    return parts


def _malformed(text: str) -> ProtocolError:
    return ProtocolError(ErrorCode.MALFORMED, text, CloseCode.MALFORMED)
