"""A meter charges what comes in on one connection, before anything of it is parsed.

The library answers a ping while it parses it, and a chunk of 256 kB holds 43 000 of them: whoever
counts messages only afterwards has paid for all of them already. So the heads of frames are
walked here first, and no further than the client has credit.
"""

from typing import Final

from esplanade.protocol.codes import MAX_CLIENT_FRAME_BYTES
from esplanade.server.net.limits import TokenBucket

CONTROL_RATE: Final = 5.0
"""Frames a second that are granted on top of messages: the pongs that answer our own pings."""

MAX_FRAME_BYTES: Final = 8 * MAX_CLIENT_FRAME_BYTES
"""Frames above the protocol's limit get a named error; above this the library refuses to read."""

MAX_HEAD_BYTES: Final = 16 * 1024
"""A request whose line and headers are longer is refused; the library alone would keep 1 MiB."""

_HEAD_END: Final = b"\r\n\r\n"


class FrameWalk:
    """Walks from the head of one WebSocket frame to the next (RFC 6455, section 5.2)."""

    __slots__ = ("_head", "_skip")

    def __init__(self) -> None:
        self._head = b""
        self._skip = 0

    @property
    def within_frame(self) -> bool:
        """Whether the last chunk ended within a frame."""
        return bool(self._skip or self._head)

    def begun(self, chunk: bytes, most: int) -> int:
        """The number of frames that begin in a chunk, counted up to `most` + 1 at the furthest.

        A frame begins with its first byte. Where the count has been broken off the walk is lost,
        and so has to be the connection.
        """
        count = 0
        if self._head:
            count = -1  # it was counted when its first byte came
            chunk = self._head + chunk
            self._head = b""
        at, size = self._skip, len(chunk)
        while at < size and count <= most:
            count += 1
            if at + 2 > size:
                break
            length = chunk[at + 1]
            end = at + (6 if length & 0x80 else 2)
            length &= 0x7F
            if length == 126:
                end += 2 + int.from_bytes(chunk[at + 2 : at + 4], "big")
                if at + 4 > size:
                    break
            elif length == 127:
                end += 8 + int.from_bytes(chunk[at + 2 : at + 10], "big")
                if at + 10 > size:
                    break
            else:
                end += length
            at = end
        if at < size:
            self._head, self._skip = chunk[at : at + 10], 0
        else:
            self._skip = at - size
        return count


class Meter:
    """Charges the chunks of one connection by frames and by bytes, from its first byte on.

    A chunk in which no frame begins costs as much as a frame, because it is as much work to
    take: a client that sends single bytes is charged for each.
    """

    def __init__(self, message_rate: float, now: float) -> None:
        self.grant(message_rate, now)
        self._walk = FrameWalk()
        self._in_request = True
        self._request_bytes = 0
        self._tail = b""
        self.began = 0
        """Frames that began in the last chunk."""

    def grant(self, message_rate: float, now: float) -> None:
        """Charge by another rate from now on, with all credit that it gives."""
        rate = message_rate + CONTROL_RATE
        self._frames = TokenBucket(rate, 2.0 * rate, now)
        byte_rate = rate * MAX_CLIENT_FRAME_BYTES
        self._bytes = TokenBucket(byte_rate, 2.0 * byte_rate + MAX_FRAME_BYTES, now)

    @property
    def within_frame(self) -> bool:
        """Whether the last chunk ended within a frame."""
        return self._walk.within_frame

    def prepay(self, frames: int, frame_bytes: int, now: float) -> bool:
        """Charge frames that are to come, if there is credit for them."""
        if not self._frames.take(now, frames):
            return False
        if self._bytes.take(now, frames * frame_bytes):
            return True
        self._frames.give(now, frames)
        return False

    def pay_back(self, frames: int, frame_bytes: int, now: float) -> None:
        """Give the credit back for frames that have not come."""
        self._frames.give(now, frames)
        self._bytes.give(now, frames * frame_bytes)

    def charge(self, chunk: bytes, now: float) -> str | None:
        """Charge a chunk as it came; the name of the limit that it breaks, if it breaks one."""
        if not self._bytes.take(now, len(chunk)):
            return "bytes"
        if self._in_request:
            joined = self._tail + chunk
            end = joined.find(_HEAD_END)
            self._request_bytes += len(chunk)
            if end < 0:
                self._tail = joined[1 - len(_HEAD_END) :]
                if self._request_bytes > MAX_HEAD_BYTES:
                    return "request"
                return None if self._frames.take(now) else "frames"
            self._in_request, self._tail = False, b""
            chunk = joined[end + len(_HEAD_END) :]
            if self._request_bytes - len(chunk) > MAX_HEAD_BYTES:
                return "request"
        credit = int(self._frames.available(now))
        count = self._walk.begun(chunk, credit)
        self.began = count
        return None if self._frames.take(now, max(count, 1)) else "frames"
