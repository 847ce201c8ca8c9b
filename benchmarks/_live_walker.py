"""A client that counts what it is sent and decodes nothing.

It is a WebSocket client on a bare transport, so that the load takes little of the machine on which
the server runs.
"""

import asyncio
import time
from typing import Final, cast

from benchmarks._live_dialects import Dialect, handshake, pong

_TEXT_END: Final = b"\r\n\r\n"
_OPCODE, _CLOSE, _PING = 0x0F, 8, 9


class Walker(asyncio.Protocol):
    """One client. `received` counts all bytes after the handshake."""

    def __init__(self, dialect: Dialect, path: str, number: int, side_m: float) -> None:
        self._dialect = dialect
        self._path = path
        self._number = number
        self._side_m = side_m
        self._rest = b""
        self._upgraded = False
        self.welcomed = asyncio.Event()
        self.inside = False
        self.lost = False
        self.began_s = self.joined_s = 0.0
        self.direction = self.speed = 0.0
        self.received = self.snapshots = self.seq = 0

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self.transport = cast(asyncio.Transport, transport)
        self.transport.write(handshake(self._path))

    def connection_lost(self, _error: Exception | None) -> None:
        self.inside, self.lost = False, True

    def move(self) -> None:
        """Send the wish once more."""
        self.seq += 1
        self.transport.write(self._dialect.move(self.seq, self.direction, self.speed))

    def data_received(self, data: bytes) -> None:
        if self._rest:
            data = self._rest + data
            self._rest = b""
        if not self._upgraded:
            head, end, data = data.partition(_TEXT_END)
            if not end:
                self._rest = head
                return
            self._upgrade(head)
        begin, until = 0, len(data)
        while until - begin >= 2:
            size, head_bytes = data[begin + 1], 2
            if size >= 126:
                head_bytes = 4 if size == 126 else 10
                size = int.from_bytes(data[begin + 2 : begin + head_bytes])
            end_at = begin + head_bytes + size
            if end_at > until:
                break
            self._take(data[begin] & _OPCODE, data, begin + head_bytes, end_at)
            begin = end_at
        self.received += begin
        if begin < until:
            self._rest = data[begin:]

    def _upgrade(self, head: bytes) -> None:
        if b" 101 " not in head.partition(b"\r\n")[0] + b" ":
            raise ConnectionError(f"no WebSocket: {head[:200]!r}")
        self._upgraded = True
        if hello := self._dialect.hello(self._number, self._side_m):
            self.transport.write(hello)
        if self._dialect.welcome is None:
            self._enter()

    def _take(self, opcode: int, data: bytes, begin: int, end: int) -> None:
        if opcode == _PING:
            self.transport.write(pong(data[begin:end]))
            return
        if opcode == _CLOSE or end <= begin + self._dialect.code_at:
            return
        code = data[begin + self._dialect.code_at]
        if self._dialect.snapshot is None or code == self._dialect.snapshot:
            self.snapshots += 1
        elif code == self._dialect.welcome and not self.inside:
            if self._dialect.thanks:
                self.transport.write(self._dialect.thanks)
            self._enter()

    def _enter(self) -> None:
        self.inside, self.joined_s = True, time.perf_counter()
        self.welcomed.set()
