"""The frames of a zone, from its host to gateways over NATS.

A frame that cannot go out at once is left out: the next one makes the gap known, and a gateway then
asks for the whole state. So neither end waits for the other, and nothing old is ever applied.
"""

import asyncio
from collections import Counter, deque
from collections.abc import Callable
from typing import Final

import structlog
from nats.aio.client import Client
from nats.aio.msg import Msg
from nats.aio.subscription import Subscription
from nats.errors import Error as NatsError

from esplanade.server.cluster.frame_gate import FrameGate, Verdict
from esplanade.server.link.frame_parts import Assembly, FrameError, FrameKey, parts_of
from esplanade.server.link.subjects import Subjects

ASK_S: Final = 0.3
"""A question without an answer is asked again after so long."""
FRAMES_WAITING: Final = 64
"""A gateway that has taken none of so many frames begins anew with the whole state."""
FRAMES_HELD: Final = 32
"""The most frames that are held while the whole state is waited for, which those right after it may
overtake."""
PARTS_WAITING: Final = 1024
BYTES_WAITING: Final = 64 * 1024 * 1024
"""Bounds of what the library keeps for a receiver that does not read."""

_SYNC: Final = b"sync"

Body = bytes
Whole = Callable[[], tuple[FrameKey, Body]]
"""Makes the whole state of a zone, as it is after the newest frame."""

log = structlog.get_logger(__name__)


class FrameSender:
    """The end of a host: it sends each frame to everyone, and the whole state to who asks."""

    def __init__(self, broker: Client, subjects: Subjects, zone: str, whole: Whole) -> None:
        self._broker = broker
        self._frames = subjects.frames(zone)
        self._questions = subjects.questions(zone)
        self._whole = whole
        self._answering: Subscription | None = None
        self.left_out = 0
        """Frames that did not go out, since the broker was away or did not read."""

    async def start(self) -> None:
        """Answer questions from now on."""
        self._answering = await self._broker.subscribe(self._questions, cb=self._answer)

    async def stop(self) -> None:
        """Answer no more."""
        if self._answering is not None and not self._broker.is_closed:
            await self._answering.unsubscribe()

    async def publish(self, key: FrameKey, body: Body) -> bool:
        """Send a frame to all gateways; returns whether it went out.

        Raises
        ------
        FrameError
            The frame is too large.
        """
        if await self._send(self._frames, key, body):
            return True
        self.left_out += 1
        return False

    async def _answer(self, question: Msg) -> None:
        if question.data == _SYNC and question.reply:
            await self._send(question.reply, *self._whole())

    async def _send(self, subject: str, key: FrameKey, body: Body) -> bool:
        # While it is away the library would keep what is sent, and send it late.
        if not self._broker.is_connected:
            return False
        try:
            for part in parts_of(key, body):
                await self._broker.publish(subject, part)
        except NatsError:
            return False
        return True


class FrameReceiver:
    """The end of a gateway: frames of one zone without a gap, the whole state first."""

    def __init__(self, broker: Client, subjects: Subjects, zone: str) -> None:
        self._broker = broker
        self._zone = zone
        self._frames = subjects.frames(zone)
        self._questions = subjects.questions(zone)
        self._inbox = broker.new_inbox()
        self._gate = FrameGate()
        self._changes, self._wholes = Assembly(), Assembly()
        self._ready: asyncio.Queue[tuple[FrameKey, Body]] = asyncio.Queue(FRAMES_WAITING)
        self._held: deque[tuple[FrameKey, Body]] = deque(maxlen=FRAMES_HELD)
        self._subscriptions: list[Subscription] = []
        self._wanted = asyncio.Event()
        self._asking: asyncio.Task[None] | None = None
        self.refused: Counter[str] = Counter()
        """Frames that were not applied, by why: `stale`, `bad`."""
        self.resyncs: Counter[str] = Counter()
        """The number of times that the whole state was asked for, by why: `start`, `gap`, `epoch`,
        `slow`, `bad`."""

    async def start(self) -> None:
        """Take in frames from now on, and ask for the whole state."""
        for subject, take in ((self._inbox, self._take_whole), (self._frames, self._take)):
            subscription = await self._broker.subscribe(
                subject,
                cb=take,
                pending_msgs_limit=PARTS_WAITING,
                pending_bytes_limit=BYTES_WAITING,
            )
            self._subscriptions.append(subscription)
        self._begin_anew("start")
        self._asking = asyncio.create_task(self._ask())

    async def stop(self) -> None:
        """Take in no more."""
        if self._asking is not None:
            self._asking.cancel()
        if not self._broker.is_closed:
            for subscription in self._subscriptions:
                await subscription.unsubscribe()

    async def next(self) -> tuple[FrameKey, Body]:
        """The next frame. A whole state stands for all before it, and ends what was known."""
        return await self._ready.get()

    def begin_anew(self) -> None:
        """Begin with the whole state again: a frame that came says nothing that can be read."""
        self._gate.lost()
        self._begin_anew("bad")

    async def _take(self, message: Msg) -> None:
        frame = self._read(self._changes, message)
        if frame is not None:
            self._judge(frame)

    def _judge(self, frame: tuple[FrameKey, Body]) -> None:
        key, epoch, at = frame[0], self._gate.epoch, self._gate.tick
        match self._gate.judge(key.epoch, key.tick):
            case Verdict.APPLY:
                self._put(frame)
            case Verdict.DROP:
                self.refused["stale"] += 1
            case Verdict.RESYNC:
                self._held.append(frame)
                if key.epoch != epoch or at is not None:
                    self._begin_anew("gap" if key.epoch == epoch else "epoch")

    async def _take_whole(self, message: Msg) -> None:
        frame = self._read(self._wholes, message)
        if frame is None:
            return
        key = frame[0]
        if key.is_whole and self._gate.whole(key.epoch, key.tick) is Verdict.APPLY:
            self._put(frame)
            held, self._held = self._held, deque(maxlen=FRAMES_HELD)
            for each in held:
                if each[0].tick > key.tick:
                    self._judge(each)
        else:
            self.refused["stale"] += 1

    def _read(self, assembly: Assembly, message: Msg) -> tuple[FrameKey, Body] | None:
        try:
            return assembly.take(message.data)
        except FrameError as error:
            self.refused["bad"] += 1
            log.warning("bad part of a frame", zone=self._zone, error=str(error))
            return None

    def _put(self, frame: tuple[FrameKey, Body]) -> None:
        if self._ready.full():
            while not self._ready.empty():
                self._ready.get_nowait()
            self._gate.lost()
            self._begin_anew("slow")
        else:
            self._ready.put_nowait(frame)

    def _begin_anew(self, why: str) -> None:
        self.resyncs[why] += 1
        self._wanted.set()

    async def _ask(self) -> None:
        """Ask for the whole state whenever it is wanted, until it has come."""
        while True:
            await self._wanted.wait()
            self._wanted.clear()
            while self._gate.tick is None:
                if self._broker.is_connected:
                    try:
                        await self._broker.publish(self._questions, _SYNC, reply=self._inbox)
                    except NatsError as error:
                        log.debug("a question was not sent", zone=self._zone, error=str(error))
                await asyncio.sleep(ASK_S)
