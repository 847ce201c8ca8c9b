"""One WebSocket to the server, from hello to goodbye: frames in, messages out."""

import asyncio
from pathlib import Path
from typing import Final, Self

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake, InvalidURI

from esplanade.bots.address import websocket_url
from esplanade.bots.errors import Disconnected, Refused, TimedOut, Unreachable
from esplanade.bots.trust import HIDDEN_BYTES, tls_context
from esplanade.protocol import ProtocolError, decode_server, encode
from esplanade.protocol.messages import Error, FromClient, Hello, Welcome

OPEN_TIMEOUT_S: Final = 10.0
CLOSE_TIMEOUT_S: Final = 2.0

MAX_FRAME_BYTES: Final = 16 * 1024 * 1024
"""The largest frame is welcome, which carries the scene."""

QUEUED_FRAMES: Final = 64
"""A bot that falls this far behind stops reading and TCP holds the server's frames back.

Under TLS some more wait in between, see `HIDDEN_BYTES`.
"""

NO_CLOSE_CODE: Final = 1006


class Connection:
    """A connection that the server has welcomed."""

    def __init__(self, socket: ClientConnection, welcome: Welcome) -> None:
        self._socket = socket
        self.welcome = welcome

    @classmethod
    async def open(cls, url: str, hello: Hello, trust: Path | None = None) -> Self:
        """Connect, say hello and wait for welcome.

        With `trust`, a server that speaks TLS must have exactly the certificate in that file.

        Raises
        ------
        ValueError
            `url` is no address, or `trust` no certificate.
        TimedOut
            It takes too long.
        Unreachable
            Nobody is there, or no server of ours.
        Refused
            The server does not let this client in.
        """
        address = websocket_url(url)
        secure = address.startswith("wss:")
        try:
            socket = await connect(
                address,
                compression=None,
                max_size=MAX_FRAME_BYTES,
                max_queue=QUEUED_FRAMES,
                open_timeout=OPEN_TIMEOUT_S,
                close_timeout=CLOSE_TIMEOUT_S,
                proxy=None,
                ssl=tls_context(trust) if secure else None,
            )
        except TimeoutError:
            raise TimedOut(f"{address}: no connection within {OPEN_TIMEOUT_S:g} s") from None
        except (OSError, InvalidHandshake, InvalidURI) as error:
            raise Unreachable(f"{address}: {str(error) or type(error).__name__}") from error
        if secure:
            socket.transport.set_read_buffer_limits(HIDDEN_BYTES)  # type: ignore[attr-defined]
        try:
            async with asyncio.timeout(OPEN_TIMEOUT_S):
                await socket.send(encode(hello))
                return cls(socket, await _welcome(socket))
        except TimeoutError:
            socket.transport.abort()
            raise TimedOut(f"{address}: no welcome within {OPEN_TIMEOUT_S:g} s") from None
        except BaseException:
            socket.transport.abort()
            raise

    async def send(self, message: FromClient) -> int:
        """Send one message and return the bytes of its frame.

        Raises
        ------
        Disconnected
            The connection has ended.
        """
        frame = encode(message)
        try:
            await self._socket.send(frame)
        except ConnectionClosed as error:
            raise _disconnected(error) from None
        return len(frame)

    async def receive(self) -> bytes:
        """The next frame.

        Raises
        ------
        Disconnected
            The connection has ended.
        """
        try:
            frame = await self._socket.recv(decode=False)
        except ConnectionClosed as error:
            raise _disconnected(error) from None
        return frame

    async def close(self) -> None:
        """Say goodbye; a server that does not answer is left after two seconds."""
        await self._socket.close()


async def _welcome(socket: ClientConnection) -> Welcome:
    """The answer to hello; messages that this version does not know are passed over."""
    try:
        message = None
        while message is None:
            message = decode_server(await socket.recv(decode=False))
    except ProtocolError as error:
        raise Unreachable(f"what answers speaks another protocol: {error.text}") from None
    except ConnectionClosed as error:
        ended = _disconnected(error)
        raise Refused(str(ended.code), ended.reason or "closed without a word") from None
    if isinstance(message, Error):
        raise Refused(str(message.error), message.text)
    if not isinstance(message, Welcome):
        raise Unreachable(f"expected welcome, not {type(message).__name__.lower()}")
    return message


def _disconnected(error: ConnectionClosed) -> Disconnected:
    """The reason that the server gave when it ended the connection, if it gave one."""
    if error.rcvd is None:
        return Disconnected(NO_CLOSE_CODE, "lost")
    return Disconnected(error.rcvd.code, error.rcvd.reason)
