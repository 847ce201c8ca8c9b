"""The usual chunk of a client is one whole short frame, and needs no parser.

Most of what comes from clients are movements, ten a second from each, in a frame and a chunk of
their own. The library's parser, queue and task take several times as long for one of them as all
the rest of the server does. Everything else goes the library's way.
"""

from typing import Final

try:
    from websockets.speedups import apply_mask
except ImportError:  # the library was built without its compiled part
    from websockets.utils import apply_mask

_FINAL_BINARY: Final = 0x82
_MASKED: Final = 0x80
_HEAD_BYTES: Final = 6
"""Bytes of a masked frame before a payload of less than 126 bytes."""
_LONGEST: Final = 125


def payload_of(chunk: bytes) -> bytes | None:
    """The payload of a chunk that is one final, masked, binary frame of 125 bytes or less.

    The chunk has to begin where a frame begins (RFC 6455, section 5.2). None for any other.
    """
    size = len(chunk) - _HEAD_BYTES
    if not 0 <= size <= _LONGEST or chunk[0] != _FINAL_BINARY or chunk[1] != _MASKED | size:
        return None
    return apply_mask(chunk[_HEAD_BYTES:], chunk[2:_HEAD_BYTES])
