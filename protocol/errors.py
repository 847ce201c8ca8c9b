"""Errors in messages on the wire."""

from esplanade.protocol.codes import CloseCode, ErrorCode


class ProtocolError(ValueError):
    """A frame that breaks the protocol; names the fault and how the connection ends.

    `close` is None where the fault does not end the connection.
    """

    def __init__(self, code: ErrorCode, text: str, close: CloseCode | None) -> None:
        super().__init__(text)
        self.code = code
        self.text = text
        self.close = close
