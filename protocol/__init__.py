"""The wire between browsers, bots and the server: codes, messages, codec, snapshot layout."""

from esplanade.protocol.codec import (
    decode_client,
    decode_server,
    encode,
    encode_snapshot,
    encode_steps,
    peek_snapshot,
    peek_version,
)
from esplanade.protocol.codes import (
    SERVED_VERSIONS,
    VERSION,
    ByeCode,
    ClientCode,
    CloseCode,
    ErrorCode,
    Gesture,
    Kind,
    NoticeCode,
    Outcome,
    Reason,
    ServerCode,
)
from esplanade.protocol.errors import ProtocolError

__all__ = [
    "SERVED_VERSIONS",
    "VERSION",
    "ByeCode",
    "ClientCode",
    "CloseCode",
    "ErrorCode",
    "Gesture",
    "Kind",
    "NoticeCode",
    "Outcome",
    "ProtocolError",
    "Reason",
    "ServerCode",
    "decode_client",
    "decode_server",
    "encode",
    "encode_snapshot",
    "encode_steps",
    "peek_snapshot",
    "peek_version",
]
