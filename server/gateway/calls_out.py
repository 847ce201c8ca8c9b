"""Requests of operators at this gateway that hosts answer: their begin, and what comes back."""

import asyncio
import secrets
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager, suppress
from typing import Final

import structlog
from nats.aio.client import Client
from nats.aio.msg import Msg
from nats.errors import Error as NatsError

from esplanade.server.link.calls import (
    ALIVE_S,
    PARTS_UNDER_WAY,
    SILENT_S,
    Added,
    Alive,
    Answered,
    Call,
    CallError,
    Closed,
    Gone,
    Said,
    Written,
    decode_answered,
    encode_added,
    encode_call,
)
from esplanade.server.link.subjects import Subjects

MOST_PARTS: Final = PARTS_UNDER_WAY + 2
"""Parts of an answer that wait to be written; no host that keeps to the rules sends more."""
NOBODY: Final = "503"
"""The status that a broker answers with where nobody takes a message."""

Owner = Callable[[str, bool], Awaitable[int | None]]
"""Tells the epoch of a zone's owner, looked up anew if that is said; None if it has none."""

log = structlog.get_logger(__name__)


class NoHostError(Exception):
    """No host has the zone now; the request has reached nobody."""


class CallLostError(Exception):
    """The host does not answer any more; it may have done what was asked, or not."""


class CallsOut:
    """Sends requests to the hosts of zones. All of it belongs to one event loop."""

    def __init__(self, gateway: str, subjects: Subjects, owner: Owner) -> None:
        self.gateway = gateway
        self._subjects = subjects
        self._owner = owner
        self._broker: Client | None = None
        self._open: dict[str, OpenCall] = {}

    @property
    def under_way(self) -> int:
        """Requests that hosts are answering."""
        return len(self._open)

    @asynccontextmanager
    async def over(self, broker: Client) -> AsyncIterator[None]:
        """Send requests over a broker."""
        subject = f"{self._subjects.called(self.gateway)}.*"
        subscription = await broker.subscribe(subject, cb=self._take)
        self._broker = broker
        try:
            yield
        finally:
            self._broker = None
            if not broker.is_closed:
                with suppress(NatsError):
                    await subscription.unsubscribe()

    def new_name(self) -> str:
        """A name for a request that no other has, and that nobody guesses."""
        return secrets.token_hex(16)

    @asynccontextmanager
    async def begun(self, zone: str, call: Call) -> AsyncIterator["OpenCall"]:
        """Send a request to the host of a zone; the first part of the answer has come then.

        Raises
        ------
        NoHostError
            Nobody has the zone now, or no broker is there.
        CallLostError
            The host has not answered in time.
        """
        found = await self._sent(zone, call, anew=False)
        if found is None:
            found = await self._sent(zone, call, anew=True)
        if found is None:
            raise NoHostError(zone)
        beating = asyncio.create_task(found.beat())
        try:
            yield found
        finally:
            beating.cancel()
            del self._open[call.name]
            await found.leave()

    async def _sent(self, zone: str, call: Call, *, anew: bool) -> "OpenCall | None":
        """Send a request to the owner that is known, or looked up anew; None if nobody takes it."""
        broker, epoch = self._broker, await self._owner(zone, anew)
        if broker is None or not broker.is_connected or epoch is None:
            return None
        subject = self._subjects.calls(zone, epoch)
        opened = self._open[call.name] = OpenCall(broker, f"{subject}.{call.name}")
        reply = f"{self._subjects.called(self.gateway)}.{call.name}"
        try:
            await broker.publish(subject, encode_call(call), reply=reply)
            await opened.first()
        except (NoHostError, NatsError):
            del self._open[call.name]
            return None
        except BaseException:
            del self._open[call.name]
            await opened.leave()
            raise
        return opened

    async def _take(self, message: Msg) -> None:
        opened = self._open.get(message.subject.rpartition(".")[2])
        if opened is not None:
            opened.take(message)


class OpenCall:
    """A request that a host answers."""

    def __init__(self, broker: Client, subject: str) -> None:
        self._broker = broker
        self._subject = subject
        self._parts: asyncio.Queue[tuple[int, Answered] | Exception] = asyncio.Queue(MOST_PARTS)
        self._first: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._number = 0
        self._over = False

    def take(self, message: Msg) -> None:
        """Take in what has come back."""
        said: tuple[int, Answered] | Exception
        if not message.data and (message.headers or {}).get("Status") == NOBODY:
            said = NoHostError()
        else:
            try:
                said = decode_answered(message.data)
            except CallError as error:
                log.warning("bad answer to a request of an operator", error=str(error))
                said = CallLostError(str(error))
        is_alive = not isinstance(said, Exception) and isinstance(said[1], Alive)
        # A part for which there is no room is missed by its number, as one that was lost.
        if self._parts.empty() or not (is_alive or self._parts.full()):
            self._parts.put_nowait(said)
        if not self._first.done():
            if isinstance(said, Exception):
                self._first.set_exception(said)
            else:
                self._first.set_result(None)

    async def first(self) -> None:
        """Wait until the host has the request.

        Raises
        ------
        NoHostError
            Nobody has it.
        CallLostError
            Nobody has said so in time.
        """
        try:
            async with asyncio.timeout(SILENT_S):
                await asyncio.shield(self._first)
        except TimeoutError:
            raise CallLostError("the host does not answer") from None

    async def next(self) -> Answered:
        """The next part of the answer; say when it is `written`.

        Raises
        ------
        CallLostError
            The host does not answer any more, or a part is missing.
        """
        while True:
            try:
                async with asyncio.timeout(SILENT_S):
                    said = await self._parts.get()
            except TimeoutError:
                raise CallLostError("the host does not answer any more") from None
            if isinstance(said, Exception):
                raise CallLostError(str(said))
            number, answered = said
            if number != self._number + (not isinstance(answered, Alive)):
                raise CallLostError("a part of the answer is lost")
            if isinstance(answered, Alive):
                continue
            self._number = number
            self._over = self._over or isinstance(answered, Closed)
            return answered

    async def written(self) -> None:
        """Say that the client has been written all that has come."""
        await self._add(Written(self._number))

    async def say(self, text: str) -> None:
        """Pass on what the client of a socket has sent."""
        await self._add(Said(text))

    async def leave(self) -> None:
        """Say that nobody wants any more of the answer."""
        if not self._over:
            await self._add(Gone())

    async def beat(self) -> None:
        """Say now and then that somebody waits for the answer."""
        while True:
            await asyncio.sleep(ALIVE_S)
            await self._add(Alive())

    def ended(self) -> None:
        """Note that the answer is whole."""
        self._over = True

    async def _add(self, added: Added) -> None:
        with suppress(NatsError):
            await self._broker.publish(self._subject, encode_added(added))
