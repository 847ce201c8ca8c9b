"""One connection of the port for people: the library's, with a meter before its parser."""

import asyncio
from collections.abc import Callable
from typing import Final

from websockets.asyncio.server import Server
from websockets.datastructures import Headers
from websockets.http11 import Request
from websockets.protocol import State
from websockets.server import ServerProtocol

from esplanade.protocol import CloseCode, ErrorCode
from esplanade.protocol.messages import Error
from esplanade.server.metrics import Metrics
from esplanade.server.net import frames
from esplanade.server.net.connections import Place
from esplanade.server.net.leases import HeardConnection
from esplanade.server.net.metering import Meter
from esplanade.server.net.refusals import Refusals
from esplanade.server.net.sockets.reading import FRAME_BYTES, Reading
from esplanade.server.net.sockets.system import NONE, descriptor_of
from esplanade.server.net.whole_frames import payload_of

CLOSE_S: Final = 2.0
"""A client that has not answered the closing handshake by then is cut off."""

GRACE_S: Final = 1.0
"""A client that floods has so long to read why it is closed; nothing more of it is read."""

FRAME_S: Final = 15.0
"""A frame that has begun must be whole within this time."""

_FAULTS: Final = {
    "frames": (ErrorCode.FLOODING, CloseCode.FLOODING, "too many frames"),
    "bytes": (ErrorCode.FLOODING, CloseCode.FLOODING, "too many bytes"),
    "slow_frame": (
        ErrorCode.MALFORMED,
        CloseCode.MALFORMED,
        f"a frame was not whole within {FRAME_S:g} s",
    ),
}
"""The error and close code for each limit of the meter, or of time."""


_FORGOTTEN: Final = Request("", Headers())
"""The library takes what comes as a request for as long as there is none."""


class WatchedProtocol(ServerProtocol):
    """Tells when it is no longer open."""

    when_closing: Callable[[], None] | None = None

    @property
    def state(self) -> State:
        return self._state

    @state.setter
    def state(self, state: State) -> None:
        self._state = state
        if self.when_closing is not None and state is not State.OPEN:
            self.when_closing()


class Connection(HeardConnection):
    """Charges every chunk before the library sees it, and ends a client that sends too much."""

    def __init__(
        self,
        protocol: WatchedProtocol,
        server: Server,
        place: Place,
        meter: Meter,
        metrics: Metrics,
        refusals: Refusals,
        reading: Reading | None = None,
    ) -> None:
        """With `reading`, its socket may be read there while it sends nothing but movements."""
        # Leases ping those who are silent, and end them.
        super().__init__(protocol, server, ping_interval=None, close_timeout=CLOSE_S)
        self.place = place
        self.answering = False
        """Whether an HTTP answer is on its way: what the client sends meanwhile is not parsed."""
        self.take_at_once: Callable[[bytes], bool] | None = None
        """Takes the payload of a frame that was read whole, or says that it is for the parser."""
        self.wished_zone: str | None = None
        """The copy of the zone for newcomers that the request named."""
        self.identity: str | None = None
        """What a trusted proxy calls the client, if it has checked that."""
        self.descriptor = NONE
        """That of the socket, if the system may be called with it."""
        self._answered = False
        self._client_ended = False
        self._meter = meter
        self._metrics = metrics
        self._refusals = refusals
        self._reading = reading
        self.closing: list[Callable[[], None]] = []
        """Called, maybe more than once, when nothing more is to be written but a farewell."""
        self.when_written: Callable[[], None] | None = None
        """Called when the library has written to the transport."""
        protocol.when_closing = self._close
        self._deaf = False
        self._held = b""
        self._held_frames = 0
        self._turn: asyncio.TimerHandle | None = None
        self._end: asyncio.TimerHandle | None = None
        self._frame_end: asyncio.TimerHandle | None = None

    @property
    def client_address(self) -> str:
        """The key of the client's address, by which limits go (`addresses.address_key`)."""
        return self.place.address

    def send_data(self) -> None:
        super().send_data()
        if self.when_written is not None:
            self.when_written()

    def grant(self, message_rate: float) -> None:
        """Let the client send so many messages a second from now on."""
        self._meter.grant(message_rate, self.loop.time())

    async def asked(self) -> Request:
        """Wait for the request.

        Raises
        ------
        ConnectionResetError
            The connection has ended without one that can be read.
        """
        await asyncio.wait(
            [self.request_rcvd, self.connection_lost_waiter], return_when=asyncio.FIRST_COMPLETED
        )
        if self.request is None:
            raise ConnectionResetError
        return self.request

    def forget_request(self) -> None:
        """Let go of the headers of an opened WebSocket, which nobody asks for again."""
        self.request, self.response = _FORGOTTEN, None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        super().connection_made(transport)
        self.descriptor = descriptor_of(self.transport)
        self.place.cut = self.transport.abort
        if not self.place.present:  # it was given to somebody else while this one was opening
            self.transport.abort()

    def connection_lost(self, exc: Exception | None) -> None:
        for timer in (self._end, self._frame_end, self._turn):
            if timer is not None:
                timer.cancel()
        super().connection_lost(exc)
        self._close()
        self.place.leave()

    def read_at_once(self, avatar_id: int) -> None:
        """Read the socket together with others, as long as movements of that avatar come."""
        if self._reading is not None and not self._deaf:
            self._reading.enter(self, avatar_id)

    def read_alone(self) -> None:
        """Let the event loop read the socket."""
        if self._reading is not None:
            self._reading.leave(self)

    def prepay(self, frames: int, now: float) -> bool:
        """Charge frames that are to come; whether there was credit for them."""
        if not self._meter.prepay(frames, FRAME_BYTES, now):
            return False
        if self.place.prepay(frames, now):
            return True
        self._meter.pay_back(frames, FRAME_BYTES, now)
        return False

    def pay_back(self, frames: int, now: float) -> None:
        """Give the credit back for frames that have not come."""
        self._meter.pay_back(frames, FRAME_BYTES, now)
        self.place.pay_back(frames, now)

    def _close(self) -> None:
        self.read_alone()
        for each in self.closing:
            each()

    def data_received(self, data: bytes) -> None:
        if self._deaf:
            self.transport.pause_reading()  # the library may have resumed it
            return
        at_head = not (self._held or self._meter.within_frame)
        excess = self._meter.charge(data, self.loop.time())
        if excess is not None:
            self._refuse(excess)
            return
        self.heard = True
        self._held += data
        self._held_frames += max(self._meter.began, 1)
        if self._turn is None:
            self._parse_held(at_head)
        else:
            self.transport.pause_reading()  # the library may have resumed it

    def _go_on(self) -> None:
        """Parse what had to wait, and read again."""
        self._turn = None
        if not self._deaf and not self.transport.is_closing():
            self.transport.resume_reading()
            self._parse_held()

    def _parse_held(self, at_head: bool = False) -> None:
        """Parse what is paid for, now or when it is the turn of the client's address.

        `at_head` says that it is one chunk, which begins where a frame begins.
        """
        delay_s = self.place.delay(self._held_frames, self.loop.time())
        if delay_s:
            self.transport.pause_reading()
            self._turn = self.loop.call_later(delay_s, self._go_on)
            return
        data, self._held, self._held_frames = self._held, b"", 0
        if at_head and self._taken_at_once(data):
            return
        if not self.answering:
            super().data_received(data)
            self._watch_frame()
            if self._end is None and self.protocol.close_expected():
                self._end_within(CLOSE_S)

    def _taken_at_once(self, chunk: bytes) -> bool:
        """Whether nothing that came before waits in the library, and the chunk was taken."""
        if self.take_at_once is None or self.protocol.state is not State.OPEN:
            return False
        if self.protocol.expect_continuation_frame or len(self.recv_messages.frames):
            return False
        payload = payload_of(chunk)
        return payload is not None and self.take_at_once(payload)

    def eof_received(self) -> bool | None:  # type: ignore[override]
        if self.answering:
            self._client_ended = True
            return not self._answered and self.transport.can_write_eof()
        super().eof_received()
        return None

    def end_answer(self) -> None:
        """Tell the client of an HTTP answer that this was all; the connection ends when it goes."""
        self._answered = True
        if self._client_ended or not self.transport.can_write_eof():
            self.transport.close()
        else:
            self.transport.write_eof()

    def _watch_frame(self) -> None:
        """Give a frame that has begun and is not whole a time in which it must be."""
        if self._frame_end is not None and (self._meter.began or not self._meter.within_frame):
            self._frame_end.cancel()
            self._frame_end = None
        if self._frame_end is None and self._meter.within_frame:
            self._frame_end = self.loop.call_later(FRAME_S, self._refuse, "slow_frame")

    def _refuse(self, excess: str) -> None:
        """End the connection with its name, if it has come so far that it can be told."""
        self._deaf = True
        self.transport.pause_reading()
        self._refusals.flood(excess, self.client_address)
        if self.protocol.state is not State.OPEN or excess not in _FAULTS:
            self.transport.abort()
            return
        error, code, text = _FAULTS[excess]
        self._metrics.errors.labels(error.value).inc()
        self._metrics.closes.labels(code.name.lower()).inc()
        self.transport.write(frames.message(Error(error=error, text=text)))
        self.protocol.fail(code, error.value)
        self.send_data()
        self._end_within(GRACE_S)

    def _end_within(self, seconds: float) -> None:
        if self._end is not None:
            self._end.cancel()
        self._end = self.loop.call_later(seconds, self.transport.abort)
