"""Errors in messages on the wire."""

from collections.abc import Mapping
from typing import Any

from esplanade.protocol.codes import CloseCode, ErrorCode


class ProtocolError(ValueError):
    """A frame that breaks the protocol; names the fault and how the connection ends.

    `close` is None where the fault does not end the connection; `arguments` are for programs.
    """

    def __init__(
        self,
        code: ErrorCode,
        text: str,
        close: CloseCode | None,
        arguments: Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(text)
        self.code = code
        self.text = text
        self.close = close
        self.arguments = dict(arguments or {})
