"""The outbox of one client bounds what waits for it, and drops a client that does not read.

Frames are written straight to the transport, past the library's own queue and its awaiting; so
the state of the connection is checked here, and nothing is ever sent in fragments.

Policy. A client with more than `slow_bytes` unsent is slow: it gets no snapshots and no steps (the
next ones supersede them) and important frames wait in a bounded list. It is dropped when it stays
slow for `drop_seconds`, when `drop_bytes` lie unsent, or when the list overflows.
"""

import socket
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from websockets.asyncio.server import ServerConnection
from websockets.protocol import State

from esplanade.server.metrics import Traffic
from esplanade.server.net.sockets.system import NONE
from esplanade.server.settings import ServerSettings
from esplanade.server.world.audience import STEP_BYTES

MAX_WAITING_FRAMES: Final = 256
JOINING_PATIENCE_S: Final = 30.0
"""A client on a thin line may take this long to read its welcome, which holds the scene."""

SEND_BUFFER_BYTES: Final = 32 * 1024
UNSENT_LOW_WATER_BYTES: Final = 16 * 1024


@dataclass(frozen=True)
class SlowPolicy:
    """The limits beyond which a client is slow, and beyond which it is dropped."""

    slow_bytes: int
    drop_bytes: int
    drop_seconds: float

    @classmethod
    def of(cls, settings: ServerSettings) -> "SlowPolicy":
        return cls(settings.slow_bytes, settings.drop_bytes, settings.drop_seconds)


class Outbox:
    """Writes frames to one connection, in order, never waiting."""

    def __init__(
        self,
        connection: ServerConnection,
        policy: SlowPolicy,
        traffic: Traffic,
        descriptor: int = NONE,
    ) -> None:
        """`descriptor` is that of the connection's socket, if the system may be called with it."""
        self._connection = connection
        self._transport = connection.transport
        self._descriptor = descriptor
        self._usual = False
        """Whether the latest snapshot was written in the usual way and nothing waits since."""
        self._clear, self._place = bytearray(1), 0
        self.unsent = connection.transport.get_write_buffer_size
        """Returns the bytes that were written and that the client has not taken yet."""
        self._policy = policy
        self._traffic = traffic
        self._waiting: deque[bytes] = deque()
        self._slow_since: float | None = None
        self._patience_s = policy.drop_seconds
        self._allowance_bytes = 0
        self.dropped: str | None = None
        """The limit that the client broke, once it was dropped as too slow."""
        bound_kernel_buffers(connection)

    @property
    def waiting(self) -> int:
        """Important frames that wait for a slow client."""
        return len(self._waiting)

    @property
    def open(self) -> bool:
        """Whether anything may be written."""
        return self._connection.state is State.OPEN and self.dropped is None

    @property
    def clear(self) -> bool:
        """Whether the next snapshot may be sent past the transport, as far as is known."""
        return bool(self._clear[self._place])

    def use_transport(self) -> None:
        """Write everything by the transport from now on, as the connection is closing."""
        self._descriptor = NONE
        self._be_unusual()

    def report_to(self, clear: bytearray, place: int) -> int:
        """Keep there, from now on, whether a snapshot may be sent past the transport; see `look`.

        Returns the descriptor to which it may be sent then.
        """
        clear[place] = self._clear[self._place]
        self._clear, self._place = clear, place
        return self._descriptor

    def look(self) -> bool:
        """Find out whether the next snapshot may be sent past the transport.

        It may if nothing waits, and the transport holds nothing back and is not closing. That stays
        so until something is written to the transport, which whoever does so must tell (`fill`).
        """
        known = self._usual and self._descriptor != NONE
        is_clear = known and not self.unsent() and not self._transport.is_closing()
        self._clear[self._place] = is_clear
        return is_clear

    def fill(self) -> None:
        """Note that something was written to the transport."""
        self._clear[self._place] = False

    def send_rest(self, rest: bytes) -> None:
        """Write what the system did not take at once of a snapshot that was sent."""
        self.fill()
        self._transport.write(rest)

    def welcome(self, frame: bytes) -> None:
        """The first frame, however large: its size and the time to read it are granted."""
        self._be_unusual()
        self._allowance_bytes = len(frame)
        self._patience_s = max(self._policy.drop_seconds, JOINING_PATIENCE_S)
        if self.open:
            self._write(frame)

    def begin_anew(self) -> None:
        """Forget the frames that wait: they are of a zone where the client is no more."""
        self._waiting.clear()

    def post(self, frame: bytes) -> None:
        """Send a frame that must not be lost; it waits while the client is slow."""
        if not self.open:
            return
        if not self._waiting and self.unsent() <= self._policy.slow_bytes:
            self._write(frame)
        elif len(self._waiting) < MAX_WAITING_FRAMES:
            self._be_unusual()
            self._waiting.append(frame)
        else:
            self._drop("waiting")

    def offer(self, frame: bytes) -> bool:
        """Send a frame that a later one replaces; False if a slow client does not get it."""
        if not self.open or self._waiting or self.unsent() > self._policy.slow_bytes:
            return False
        self._write(frame)
        return True

    def snapshot(self, block: bytes, steps: int, now: float, first: Sequence[bytes] = ()) -> bool:
        """Send the frames that wait, then `first`, then a snapshot with the steps of its tick.

        `block` holds the frame of so many steps, if there are any, and that of the snapshot. It is
        called once a tick. The frames in `first` must not be lost; they wait while the client is
        slow. False if steps and snapshot were left out, both together.
        """
        self._be_unusual()
        if not self.open:
            return False
        unsent = self.unsent()
        if self._waiting or self._slow_since is not None or unsent > self._policy.slow_bytes:
            return self._snapshot_when_slow(block, steps, now, first, unsent)
        if self._allowance_bytes:
            self._patience_s, self._allowance_bytes = self._policy.drop_seconds, 0
        self._write_snapshot(block, steps, first)
        return True

    def _snapshot_when_slow(
        self, block: bytes, steps: int, now: float, first: Sequence[bytes], unsent: int
    ) -> bool:
        """The same for a client that is slow, or was until now."""
        if first and (self._waiting or unsent > self._policy.slow_bytes):
            for frame in first:
                self.post(frame)
            first = ()
            if not self.open:
                return False
        if unsent > self._policy.slow_bytes:
            self._traffic.snapshots_skipped += 1
            self._judge(unsent, now)
            return False
        self._slow_since = None
        self._patience_s, self._allowance_bytes = self._policy.drop_seconds, 0
        while self._waiting and self.unsent() <= self._policy.slow_bytes:
            self._write(self._waiting.popleft())
        if self._waiting:
            self._traffic.snapshots_skipped += 1
            return False
        self._write_snapshot(block, steps, first)
        return True

    def _write_snapshot(self, block: bytes, steps: int, first: Sequence[bytes]) -> None:
        """Write everything of a tick at once."""
        messages = 1
        if first:
            block = b"".join((*first, block))
            messages += len(first)
        if steps:
            messages += 1
        self._transport.write(block)
        self.count(messages, len(block), steps)
        self._usual = True

    def count(self, messages: int, size: int, steps: int) -> None:
        """Count what was sent, to whomever, of so many bytes."""
        traffic = self._traffic
        traffic.messages_out += messages
        traffic.bytes_out += size
        traffic.steps_out += steps
        traffic.step_bytes_out += steps * STEP_BYTES

    def flush(self) -> None:
        """Send all frames that wait, before the end of the connection."""
        while self._waiting and self.open:
            self._write(self._waiting.popleft())

    def _judge(self, unsent: int, now: float) -> None:
        if self._slow_since is None:
            self._slow_since = now
        if unsent > self._policy.drop_bytes + self._allowance_bytes:
            self._drop("bytes")
        elif now - self._slow_since > self._patience_s:
            self._drop("seconds")

    def _drop(self, why: str) -> None:
        # Closing would wait for a client that does not read; only abort ends it.
        self.dropped = why
        self.use_transport()
        self._waiting.clear()
        self._transport.abort()

    def _be_unusual(self) -> None:
        """Have the next snapshot written to the transport."""
        self._usual = False
        self.fill()

    def _write(self, frame: bytes) -> None:
        self.fill()
        self._transport.write(frame)
        self._traffic.messages_out += 1
        self._traffic.bytes_out += len(frame)


def bound_kernel_buffers(connection: ServerConnection) -> None:
    """Keep the kernel from hiding megabytes that a client has not read."""
    sock = connection.transport.get_extra_info("socket")
    sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SEND_BUFFER_BYTES)
    if hasattr(socket, "TCP_NOTSENT_LOWAT"):
        sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NOTSENT_LOWAT, UNSENT_LOW_WATER_BYTES)
