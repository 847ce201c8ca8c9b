"""Errors in messages on the wire."""

from collections.abc import Mapping

from esplanade.protocol.codes import CloseCode, ErrorCode


class ProtocolError(ValueError):
    """A frame that breaks the protocol; names the fault and how the connection ends.

    `close` is None where the fault does not end the connection.
    """

    def __init__(
        self,
        code: ErrorCode,
        text: str,
        close: CloseCode | None,
        args: Mapping[str, str | float] | None = None,
    ) -> None:
        super().__init__(text)
        self.code = code
        self.text = text
        self.close = close
        self.arguments = None if args is None else dict(args)
        """What the fault is about, by name, where a program can use it."""
