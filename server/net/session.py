"""A session reads one connection of one person, from its hello to its end."""

import asyncio
import time
from collections.abc import Callable
from typing import Final, Protocol

import msgpack
from websockets.exceptions import ConnectionClosed
from websockets.frames import CloseCode as LibraryCode

from esplanade.protocol import (
    SERVED_VERSIONS,
    VERSION,
    ClientCode,
    CloseCode,
    ErrorCode,
    ProtocolError,
    decode_client,
    peek_version,
)
from esplanade.protocol.looks import Look
from esplanade.protocol.messages import (
    ChatLine,
    ChooseLook,
    ClientMessage,
    Error,
    Hello,
    MakeGesture,
    Move,
    MutePerson,
    Ping,
    Pong,
    Presence,
    Report,
    SetDoor,
    WalkTo,
    Watch,
)
from esplanade.server.accounts.identity import Identity
from esplanade.server.accounts.rights import Right
from esplanade.server.metrics import Metrics
from esplanade.server.net import frames
from esplanade.server.net.connection import CLOSE_S, Connection
from esplanade.server.net.entrance import Admitted
from esplanade.server.net.leases import Lease
from esplanade.server.net.limits import TokenBucket
from esplanade.server.net.outbox import Outbox, SlowPolicy
from esplanade.server.net.refusals import Refusals
from esplanade.server.settings import ServerSettings

CHAT_BURST: Final = 5
GESTURE_BURST: Final = 3
GESTURES_PER_S: Final = 1.0
LOOK_BURST: Final = 3
LOOKS_PER_S: Final = 1.0
_PAIR: Final = msgpack.Packer().pack_array_header(2)
_MOVEMENT: Final = _PAIR + msgpack.packb(int(ClientCode.MOVE))
"""A movement begins with these bytes; it may begin otherwise too, but hardly any client does so."""
_LINE: Final = _PAIR + msgpack.packb(int(ClientCode.CHAT))
"""Likewise a line of chat."""
_CODES_OF_OURS: Final = frozenset(code for code in CloseCode if code >= 4000)


class SessionWishes(Protocol):
    """The wishes of a person who is in; `Wishes` takes them."""

    def move(self, session: "Session", wish: Move | WalkTo) -> None:
        """Move the person's avatar in the next tick."""

    def say(self, session: "Session", text: str) -> None:
        """Pass a line of chat on to everyone who has the speaker in view."""

    def watch(self, session: "Session", actor_id: int | None) -> None:
        """Send the plans of an actor from now on, or of none."""

    def set_door(self, session: "Session", wish: SetDoor) -> None:
        """Open or close a door in the next tick, if the session may."""

    def report(self, session: "Session", report: Report) -> None:
        """Put a report about somebody before moderators."""

    def mute(self, session: "Session", wish: MutePerson) -> None:
        """Send no lines of somebody to the session any more, or send them again."""

    def presence(self, session: "Session", away: bool) -> None:
        """Let everyone who has the person in view know that they are away, or there again."""

    def gesture(self, session: "Session", gesture: int) -> None:
        """Let the person's avatar make a gesture in the next tick."""

    def look(self, session: "Session", look: Look) -> None:
        """Let the person's avatar look otherwise from the next tick on."""


class SessionRequests(Protocol):
    """The requests that a session passes on; the hub fulfils them."""

    @property
    def server_time(self) -> Callable[[], float]:
        """Returns the seconds of the world's clock."""

    @property
    def wishes(self) -> SessionWishes:
        """Takes what the person wants."""

    def confirm(self, session: "Session") -> None:
        """Note that the client has read its welcome: it has sent something since."""

    def depart(self, session: "Session", comes_back: bool) -> None:
        """Let go of a session that has ended."""


class Reception(SessionRequests, Protocol):
    """The requests of a session that is not in yet; the front door fulfils them."""

    async def receive(self, session: "Session", hello: Hello) -> None:
        """Give the person a place in a zone, or raise ProtocolError."""


class Session:
    """Reads one connection; every fault of the client ends here, with its name."""

    def __init__(
        self,
        connection: Connection,
        reception: Reception,
        settings: ServerSettings,
        metrics: Metrics,
        refusals: Refusals,
    ) -> None:
        now = asyncio.get_running_loop().time()
        self.outbox = Outbox(
            connection, SlowPolicy.of(settings), metrics.traffic, connection.descriptor
        )
        connection.closing.append(self.outbox.use_transport)
        connection.when_written = self.outbox.fill
        self.address = connection.client_address
        """The key by which limits of the client's address go."""
        self.lease = Lease(connection)
        self.avatar_id: int | None = None
        """Set once the hub has a seat for this session."""
        self.ticket = 0
        """The number of the session among those that wait to join; 0 while it does not wait."""
        self.token = ""
        """The seat's resume token, which is never logged."""
        self.name = ""
        self.wished = ""
        """The name that the person asked for; the server may have added a number."""
        self.since_us = time.time_ns() // 1000
        """When the connection was made, microseconds since 1970."""
        self.last_seq = 0
        """The number of the latest movement that came."""
        self.version = VERSION
        """The version that the client speaks, once it has said hello."""
        self.wants_steps = True
        self.watching: int | None = None
        self.operator: Identity | None = None
        """The operator who has walked in, with the rights from then."""
        self.admitted = Admitted()
        """What the client was let in by."""
        self.fault_at_welcome: ProtocolError | None = None
        """The fault of a hello that lets the client in all the same; it is told of it then."""
        self.resumes = False
        """Whether it has taken a seat that there was."""
        self.unconfirmed = False
        """Whether the client got a renewed token that it may not have read yet."""
        self._connection = connection
        self._reception = reception
        self._hub: SessionRequests = reception
        self._metrics = metrics
        self._refusals = refusals
        self._hello_timeout_s = settings.hello_timeout_s
        self._lines = TokenBucket(settings.chat_rate, CHAT_BURST, now)
        self._gestures = TokenBucket(GESTURES_PER_S, GESTURE_BURST, now)
        self._looks = TokenBucket(LOOKS_PER_S, LOOK_BURST, now)
        self._dismissal: asyncio.Task[None] | None = None

    @property
    def is_operator(self) -> bool:
        """Whether the client may move doors, and come in anywhere."""
        return self.operator is not None and Right.DOORS in self.operator.rights

    @property
    def identity(self) -> str | None:
        """The name that a trusted proxy has for the client; None without one."""
        return self._connection.identity

    @property
    def wished_zone(self) -> str | None:
        """The copy of the zone for newcomers that the address named which the client called."""
        return self._connection.wished_zone

    def enter(self, hub: SessionRequests) -> None:
        """Have another fulfil the requests from now on: the hub of the zone where the person is."""
        self._hub = hub

    async def run(self) -> None:
        """Serve the connection from its hello to its end."""
        try:
            await self._enter()
            self._connection.take_at_once = self._take_movement
            async for frame in self._connection:
                # A client that was dismissed may go on talking until the connection ends.
                if self._dismissal is not None:
                    continue
                if self._talks_too_fast(frame):
                    self._count(frame)
                    self.refuse_line("rate", "you talk too fast")
                else:
                    self._take(self._decode(frame))
        except ProtocolError as fault:
            self.tell(fault)
            self._refusals.fault(fault.code.value, self.address)
            self._hub.depart(self, comes_back=False)
            await self._close(fault.close or CloseCode.NORMAL, fault.code.value)
        except ConnectionClosed as closed:
            if self._broke_a_limit(closed):
                self._hub.depart(self, comes_back=False)
            else:
                self._count_end(closed)
        finally:
            self._end()
        if self._dismissal:
            await self._dismissal

    def tell(self, fault: ProtocolError) -> None:
        """Tell the client of a fault in something that it sent."""
        self._metrics.errors.labels(fault.code.value).inc()
        self.outbox.post(
            frames.message(Error(error=fault.code, text=fault.text, arguments=fault.arguments))
        )

    def refuse_line(self, why: str, text: str) -> None:
        """Tell the client that nobody hears its line of chat, and note that."""
        self._refusals.line(why, self.address)
        self.tell(ProtocolError(ErrorCode.FLOODING, text, None))

    def dismiss(self, farewell: bytes, code: CloseCode, reason: str) -> asyncio.Task[None]:
        """End the connection in good order, with a last frame."""
        if self._dismissal is None:
            self._connection.read_alone()
            self.outbox.post(farewell)
            self._dismissal = asyncio.create_task(self._close(code, reason))
        return self._dismissal

    async def _enter(self) -> None:
        """Wait for the hello and pass it on; nobody keeps it once the person is in."""
        hello = await self._hello()
        self._connection.place.settle()
        self.name, self.wants_steps = hello.name, hello.steps
        self.wished = hello.name
        await self._reception.receive(self, hello)
        if self.admitted.bot is not None:
            self._connection.grant(self.admitted.bot.message_rate)

    async def _hello(self) -> Hello:
        try:
            async with asyncio.timeout(self._hello_timeout_s):
                frame = await self._connection.recv()
        except TimeoutError:
            raise ProtocolError(
                ErrorCode.HELLO_TIMEOUT,
                f"no hello within {self._hello_timeout_s:g} s",
                CloseCode.HELLO_TIMEOUT,
            ) from None
        # The hello of a version that is not served may hold anything else.
        version = peek_version(frame)
        if version is not None and version not in SERVED_VERSIONS:
            *older, newest = map(str, SERVED_VERSIONS)
            served = f"{', '.join(older)} and {newest}"
            raise ProtocolError(
                ErrorCode.UNSUPPORTED_VERSION,
                f"this server speaks version {served}, the client {version}",
                CloseCode.UNSUPPORTED_VERSION,
            )
        message = self._decode(frame)
        if not isinstance(message, Hello):
            raise ProtocolError(
                ErrorCode.HELLO_EXPECTED,
                f"the first message must be hello, not {message.code.name.lower()}",
                CloseCode.HELLO_EXPECTED,
            )
        self.version = message.version
        return message

    def _take_movement(self, frame: bytes) -> bool:
        """Take a movement as soon as it is read; whether it was one, and a good one."""
        if self._dismissal is not None or not frame.startswith(_MOVEMENT):
            return False
        try:
            message = decode_client(frame)
        except ProtocolError:
            return False
        self._count(frame)
        self._take(message)
        if self.avatar_id is not None and isinstance(message, Move):
            self._connection.read_at_once(self.avatar_id)
        return True

    def _talks_too_fast(self, frame: bytes | str) -> bool:
        """Whether a frame is a line of chat that need not be looked at, as it comes too soon."""
        if isinstance(frame, str) or not frame.startswith(_LINE):
            return False
        return self._lines.available(asyncio.get_running_loop().time()) < 1.0

    def _count(self, frame: bytes | str) -> None:
        self._metrics.traffic.messages_in += 1
        self._metrics.traffic.bytes_in += len(frame)

    def _decode(self, frame: bytes | str) -> ClientMessage:
        self._count(frame)
        if isinstance(frame, str):
            raise ProtocolError(
                ErrorCode.MALFORMED, "a text frame; messages are binary", CloseCode.MALFORMED
            )
        return decode_client(frame)

    def _take(self, message: ClientMessage) -> None:
        if self.unconfirmed:
            self._hub.confirm(self)
        match message:
            case Move() | WalkTo():
                self.last_seq = message.seq
                self._hub.wishes.move(self, message)
            case Ping():
                now_s = self._hub.server_time()
                self.outbox.post(frames.message(Pong(nonce=message.nonce, server_time=now_s)))
            case ChatLine():
                self._say(message)
            case Watch():
                self._hub.wishes.watch(self, message.id)
            case SetDoor():
                self._hub.wishes.set_door(self, message)
            case Report():
                self._hub.wishes.report(self, message)
            case MutePerson():
                self._hub.wishes.mute(self, message)
            case Presence() | MakeGesture() | ChooseLook():
                self._take_manners(message)
            case Hello():
                raise ProtocolError(ErrorCode.INVALID, "hello comes only once", CloseCode.INVALID)

    def _say(self, line: ChatLine) -> None:
        if self._lines.take(asyncio.get_running_loop().time()):
            self._hub.wishes.say(self, line.text)
        else:
            self.refuse_line("rate", "you talk too fast")

    def _take_manners(self, message: Presence | MakeGesture | ChooseLook) -> None:
        match message:
            case Presence():
                self._hub.wishes.presence(self, message.away)
            case MakeGesture():
                self._make_gesture(message)
            case ChooseLook():
                self._choose_look(message)

    def _make_gesture(self, wish: MakeGesture) -> None:
        if self._gestures.take(asyncio.get_running_loop().time()):
            self._hub.wishes.gesture(self, wish.gesture)
        else:
            text = f"you make gestures too fast; {GESTURES_PER_S:g} in a second is enough"
            self.tell(ProtocolError(ErrorCode.FLOODING, text, None))

    def _choose_look(self, wish: ChooseLook) -> None:
        if self._looks.take(asyncio.get_running_loop().time()):
            self._hub.wishes.look(self, wish.look)
        else:
            text = f"you change your look too fast; {LOOKS_PER_S:g} in a second is enough"
            self.tell(ProtocolError(ErrorCode.FLOODING, text, None))

    def _broke_a_limit(self, closed: ConnectionClosed) -> bool:
        """Whether the connection itself has ended the client, told it why, and counted that."""
        return (
            self._dismissal is None
            and closed.sent is not None
            and not closed.rcvd_then_sent
            and closed.sent.code in _CODES_OF_OURS
        )

    def _count_end(self, closed: ConnectionClosed) -> None:
        """Count an end that the library made itself: a broken or too large frame, a lost client."""
        if self._dismissal is None and closed.sent is not None and not closed.rcvd_then_sent:
            why = LibraryCode(closed.sent.code).name.lower()
            self._metrics.closes.labels(why).inc()
            self._refusals.fault(why, self.address)

    def _end(self) -> None:
        if self.outbox.dropped:
            self._refusals.slow(self.outbox.dropped, self.address)
            self._metrics.closes.labels(CloseCode.TOO_SLOW.name.lower()).inc()
        # A client that closes with 1000 means to go; any other end may be a tunnel or a reload.
        self._hub.depart(self, comes_back=self._connection.close_code != CloseCode.NORMAL)

    async def _close(self, code: CloseCode, reason: str) -> None:
        self.outbox.flush()
        self._metrics.closes.labels(code.name.lower()).inc()
        try:
            async with asyncio.timeout(CLOSE_S):
                await self._connection.close(code, reason)
        except TimeoutError:
            # The library waits for a buffer to drain that the client never reads.
            self._connection.transport.abort()
