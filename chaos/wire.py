"""Bare WebSockets for attackers: bytes go out as they are, messages of the server come in."""

import socket
import struct
import time
from contextlib import suppress
from typing import Final, Self

import msgpack

from esplanade.protocol import VERSION, decode_server, encode
from esplanade.protocol.messages import Error, FromClient, Hello, ServerMessage, Welcome

SERVER: Final = "127.0.0.1"
ATTACKER: Final = "127.0.0.2"
"""Attackers come from here; limits for each address do not hold for 127.0.0.1."""

MASK: Final = bytes(4)
UPGRADE: Final = (
    b"GET /ws HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
    b"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: MDEyMzQ1Njc4OWFiY2RlZg==\r\n"
)
ANSWER_S: Final = 10.0
_BINARY: Final = 0x82
_CLOSE: Final = 0x88
_PIECE: Final = 1 << 16


class RefusedError(OSError):
    """The server has not let somebody in, or has ended the connection."""


def frame(payload: bytes, head: int = _BINARY) -> bytes:
    """A whole frame of a client, masked with zeros; `head` is its first byte."""
    size = len(payload)
    if size < 126:
        lengths = struct.pack(">B", 0x80 | size)
    elif size < 1 << 16:
        lengths = struct.pack(">BH", 0x80 | 126, size)
    else:
        lengths = struct.pack(">BQ", 0x80 | 127, size)
    return bytes([head]) + lengths + MASK + payload


def opened(port: int, address: str = ATTACKER, receive_bytes: int | None = None) -> socket.socket:
    """A TCP connection to the server from an address of this machine.

    Raises
    ------
    OSError
        The server does not take it.
    """
    made = socket.socket()
    try:
        if receive_bytes is not None:
            made.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_bytes)
        made.bind((address, 0))
        made.settimeout(ANSWER_S)
        made.connect((SERVER, port))
        made.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    except OSError:
        made.close()
        raise
    return made


class Wire:
    """One WebSocket, its handshake done.

    Raises
    ------
    OSError
        The server does not take the connection; `RefusedError` if it answers with anything but 101.
    """

    def __init__(
        self,
        port: int,
        address: str = ATTACKER,
        headers: bytes = b"",
        receive_bytes: int | None = None,
    ) -> None:
        self.socket = opened(port, address, receive_bytes)
        self.close_code: int | None = None
        self._buffer = b""
        try:
            self.socket.sendall(UPGRADE + headers + b"\r\n")
            while b"\r\n\r\n" not in self._buffer:
                self._read()
        except OSError:
            self.close()
            raise
        answer, _, self._buffer = self._buffer.partition(b"\r\n\r\n")
        if b" 101 " not in answer.split(b"\r\n")[0]:
            self.close()
            raise RefusedError(answer.split(b"\r\n")[0].decode("latin-1"))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Drop the connection, without a closing handshake."""
        self.socket.close()

    def send(self, message: FromClient) -> None:
        self.socket.sendall(frame(encode(message)))

    def leave(self) -> None:
        """Close in good order: the avatar leaves at once."""
        with suppress(OSError):
            self.socket.sendall(frame(struct.pack(">H", 1000), _CLOSE))
        self.close()

    def join(self, name: str, **fields: object) -> Welcome:
        """Say hello and wait for the welcome.

        Raises
        ------
        RefusedError
            The server said why not.
        """
        hello = {"name": name, "version": VERSION, **fields}  # nothing is checked at this end
        self.socket.sendall(frame(msgpack.packb([int(Hello.code), hello])))
        return self.welcome()

    def welcome(self) -> Welcome:
        """Wait for the welcome, see `join`."""
        while True:
            message = self.receive()
            if isinstance(message, Welcome):
                return message
            if isinstance(message, Error):
                raise RefusedError(f"{message.error}: {message.text}")

    def receive(self, within_s: float = ANSWER_S) -> ServerMessage:
        """Wait for the next message.

        Raises
        ------
        RefusedError
            The connection has ended; `close_code` says how, if the server said it.
        TimeoutError
            Nothing came in time.
        """
        end = time.monotonic() + within_s
        while True:
            found = self._next_frame()
            if found is not None:
                head, payload = found
                if head == _BINARY:
                    message = decode_server(payload)
                    if message is not None:
                        return message
                if head == _CLOSE:
                    self.close_code = int.from_bytes(payload[:2], "big") if payload else None
                    raise RefusedError(f"closed with {self.close_code}")
                continue
            left = end - time.monotonic()
            if left <= 0.0:
                raise TimeoutError
            self.socket.settimeout(left)
            self._read()

    def discard(self) -> None:
        """Read away whatever has come, and wait for nothing.

        Raises
        ------
        RefusedError
            The connection has ended.
        """
        self._buffer = b""
        self.socket.setblocking(False)
        with suppress(BlockingIOError):
            while self.socket.recv(_PIECE):
                pass
            raise RefusedError("the connection has ended")
        self.socket.settimeout(ANSWER_S)

    def _read(self) -> None:
        piece = self.socket.recv(_PIECE)
        if not piece:
            raise RefusedError("the connection has ended")
        self._buffer += piece

    def _next_frame(self) -> tuple[int, bytes] | None:
        """First byte and payload of the next frame that is whole; servers do not mask."""
        buffer = self._buffer
        if len(buffer) < 2:
            return None
        size, at = buffer[1], 2
        if size >= 126:
            at = 4 if size == 126 else 10
            size = int.from_bytes(buffer[2:at], "big")
        if len(buffer) < at or len(buffer) < at + size:
            return None
        self._buffer = buffer[at + size :]
        return buffer[0], buffer[at : at + size]
