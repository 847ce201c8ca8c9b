"""All connections of a port from their first moment on: bounded in number, cut off at the end.

The library knows a connection only once its opening handshake is done; until then a client that
sends nothing would be counted by nobody, and a stopping server would wait for it.
"""

import asyncio
from collections.abc import Callable
from contextlib import suppress
from typing import Any, Final, cast

from websockets.asyncio.server import Server, ServerConnection

SHUT_S: Final = 2.0
"""Connections that are still open this long after a port was closed are cut off."""


class Connections:
    """The connections of one port; those beyond `most` are cut off as they come."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._open: set[ServerConnection] = set()
        self.refused = 0
        """Connections that were cut off because there were too many."""

    def __len__(self) -> int:
        return len(self._open)

    @property
    def factory(self) -> type[ServerConnection]:
        """The class that `websockets.serve` makes connections with."""

        def make(*args: Any, **kwargs: Any) -> ServerConnection:
            return _Listed(self._come, self._open.discard, *args, **kwargs)

        # The library only ever calls it.
        return cast(type[ServerConnection], make)

    async def shut(self, server: Server) -> None:
        """Close the port, wait a moment for its connections to end, cut off the others."""
        server.close()
        with suppress(TimeoutError):
            async with asyncio.timeout(SHUT_S):
                await server.wait_closed()
        for connection in list(self._open):
            connection.transport.abort()
        await server.wait_closed()

    def _come(self, connection: ServerConnection) -> None:
        self._open.add(connection)
        if len(self._open) > self._most:
            self.refused += 1
            connection.transport.abort()


class _Listed(ServerConnection):
    """A connection that reports when it opens and when it is gone."""

    def __init__(
        self,
        on_open: Callable[[ServerConnection], None],
        on_gone: Callable[[ServerConnection], None],
        *args: Any,
        **kwargs: Any,
    ) -> None:
        super().__init__(*args, **kwargs)
        self._on_open = on_open
        self._on_gone = on_gone

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        super().connection_made(transport)
        self._on_open(self)

    def connection_lost(self, exc: Exception | None) -> None:
        super().connection_lost(exc)
        self._on_gone(self)
