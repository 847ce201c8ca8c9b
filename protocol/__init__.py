"""The wire between browsers, bots and the server: codes, messages, codec, snapshot layout."""

from esplanade.protocol.codec import (
    decode_client,
    decode_server,
    encode,
    encode_snapshot,
    encode_steps,
    peek_snapshot,
)
from esplanade.protocol.codes import (
    VERSION,
    ByeCode,
    ClientCode,
    CloseCode,
    ErrorCode,
    Kind,
    Reason,
    ServerCode,
)
from esplanade.protocol.errors import ProtocolError

__all__ = [
    "VERSION",
    "ByeCode",
    "ClientCode",
    "CloseCode",
    "ErrorCode",
    "Kind",
    "ProtocolError",
    "Reason",
    "ServerCode",
    "decode_client",
    "decode_server",
    "encode",
    "encode_snapshot",
    "encode_steps",
    "peek_snapshot",
]
