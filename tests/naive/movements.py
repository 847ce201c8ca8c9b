"""The movements that a chunk consists of, by the library's masks and the protocol's own decoder."""

from esplanade.protocol import ProtocolError, decode_client
from esplanade.protocol.messages import Move
from esplanade.server.net.whole_frames import payload_of


def movements_in(chunk: bytes) -> list[Move] | None:
    """All of them in their order; None if there is anything else in the chunk, or nothing."""
    found: list[Move] = []
    while chunk:
        size = 6 + (chunk[1] & 0x7F if len(chunk) > 1 else 0)
        payload = payload_of(chunk[:size])
        if payload is None:
            return None
        try:
            message = decode_client(payload)
        except ProtocolError:
            return None
        if not isinstance(message, Move):
            return None
        found.append(message)
        chunk = chunk[size:]
    return found or None
