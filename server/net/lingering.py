"""The end of a connection whose request was answered before all of it was read.

A socket that is closed with unread bytes in it resets the connection, and the reset may overtake
the answer: a client that is told why its request was too long would then see a broken connection
instead. RFC 9112, section 9.6, asks the server to end its own half first and to read on for a
while.
"""

import asyncio
from collections.abc import Callable
from typing import Any, Final

LINGER_S: Final = 2.0
"""A client that has its answer may go on sending for so long."""

LINGER_BYTES: Final = 1024 * 1024
"""It may send so much; all of it is dropped unread."""


class LingeringTransport:
    """A transport whose `close` reads on, without a look at it, what its client still sends.

    It stands for the transport of the event loop in everything else. The protocol that receives
    the bytes asks `drops` first. `is_unread` tells whether a request is on its way of which not
    everything has been read.
    """

    def __init__(
        self,
        transport: asyncio.Transport,
        loop: asyncio.AbstractEventLoop,
        is_unread: Callable[[], bool],
    ) -> None:
        self._transport = transport
        self._loop = loop
        self._is_unread = is_unread
        self._limit: asyncio.TimerHandle | None = None
        self._left = LINGER_BYTES

    def __getattr__(self, name: str) -> Any:
        return getattr(self._transport, name)

    def is_closing(self) -> bool:
        return self._limit is not None or self._transport.is_closing()

    def close(self) -> None:
        """End once all is sent and, where a request is unread, once its client has ended too."""
        if self.is_closing() or not self._is_unread():
            self.forget()
            self._transport.close()
            return
        self._limit = self._loop.call_later(LINGER_S, self._transport.close)
        if self._transport.can_write_eof():
            self._transport.write_eof()
        self._transport.resume_reading()

    def drops(self, data: bytes) -> bool:
        """Whether the bytes come after the answer, and are to be dropped."""
        if self._limit is None:
            return False
        self._left -= len(data)
        if self._left < 0:
            self._transport.close()
        return True

    def forget(self) -> None:
        """Stop the clock: the connection is gone."""
        if self._limit is not None:
            self._limit.cancel()
