"""One zone as a gateway shows it: its frames, their audience, and the people who are in it."""

import asyncio
import math
from collections.abc import Callable
from dataclasses import replace
from time import perf_counter
from typing import Final

import structlog
from nats.aio.client import Client
from nats.errors import Error as NatsError

from esplanade.planning.grid.grid import ADULT
from esplanade.protocol import ByeCode, CloseCode, ErrorCode, ProtocolError
from esplanade.protocol.messages import Bye, Travel, Welcome
from esplanade.server.gateway.frame_clock import FrameClock
from esplanade.server.gateway.occupant import Occupant
from esplanade.server.gateway.silence_notices import SilenceNotices
from esplanade.server.gateway.upward import Upward
from esplanade.server.gateway.zone_wishes import ZoneWishes
from esplanade.server.link.answers import Answer
from esplanade.server.link.batches import encode_batch
from esplanade.server.link.frame_format import decode_frame
from esplanade.server.link.frame_parts import FrameError, FrameKey
from esplanade.server.link.frames_over_nats import Body, FrameReceiver
from esplanade.server.link.subjects import Subjects
from esplanade.server.link.whole_state import WholeState
from esplanade.server.link.zone_description import ZoneDescription
from esplanade.server.metrics import Metrics
from esplanade.server.net import frames
from esplanade.server.net.delivery import Delivery
from esplanade.server.net.leases import ANSWER_S, PING_S, Leases
from esplanade.server.net.lines import Lines
from esplanade.server.net.session import Session
from esplanade.server.net.welcomes import with_scene
from esplanade.server.settings import ServerSettings
from esplanade.server.world.audience import Audience
from esplanade.server.world.frame import Frame
from esplanade.server.world.stage_times import StageTimes

KNOWN_S: Final = 0.7
"""Somebody whom the zone shows is let in after so long at the latest."""
HOLD_S: Final = 0.5
"""A zone is told of everyone whom this gateway serves there so often."""

MOST_TOLD: Final = 16
"""Frames of a host for somebody who is not welcomed yet; further ones are left out."""

log = structlog.get_logger(__name__)


class ZoneView:
    """The people of a gateway in one zone.

    An occupant is `added` when the seat is written, and welcomed once the zone shows the avatar.
    Whom the zone shows no more is asked about in the database (`missing`): the seat may have gone
    to another zone.
    """

    def __init__(
        self,
        zone: str,
        description: ZoneDescription,
        gateway: str,
        broker: Client,
        subjects: Subjects,
        settings: ServerSettings,
        metrics: Metrics,
        depart: Callable[[Session, bool], None],
        confirm: Callable[[Session], None],
    ) -> None:
        self.zone = zone
        self.occupants: dict[int, Occupant] = {}
        """Everyone whose seat is here, by their numbers."""
        self.sessions: dict[int, Session] = {}
        """The sessions of those who have been welcomed."""
        self.depart_session = depart
        self._confirm = confirm
        self._description = description
        self._broker = broker
        self._inputs = subjects.inputs(zone)
        self._settings = settings
        self._metrics = metrics
        self._tick_s = 1.0 / description.world_rules.tick_rate
        self._receiver = FrameReceiver(broker, subjects, zone)
        self.known = WholeState()
        self._clock = FrameClock(self._tick_s)
        self._lines = Lines()
        self._upward = Upward(gateway)
        self._times = StageTimes(perf_counter)
        self._audience = Audience(description.world_rules, description.origin_m, self._times)
        self.wishes = ZoneWishes(
            self.occupants, self._audience, self.known, self._lines, self._upward
        )
        self._delivery = Delivery(
            self._audience,
            self.sessions,
            description.world_rules.tick_rate,
            self.wishes.stop_watching,
            self._lines,
        )
        self._leases = Leases(self._moves)
        self._silence = SilenceNotices(self.sessions, self.server_time)
        self._detached: list[int] = []
        self._epoch = 0
        self._heard: int | None = None
        """The tick of the owner's newest frame, -1 while it is a new owner; None before all."""
        self._tick = 0
        self._shift = 0
        self._held_s = -math.inf
        receiver = self._receiver
        metrics.total(
            "frames_refused",
            "Frames that were stale or damaged",
            lambda: sum(receiver.refused.values()),
        )
        metrics.total(
            "resyncs",
            "Whole states that were asked for after a gap, or at first",
            lambda: sum(receiver.resyncs.values()),
        )
        self.heard_s: float | None = None
        """When the newest frame came, seconds of the loop; None before the first."""

    # --- requests of sessions -----------------------------------------------------------------

    def server_time(self) -> float:
        """Seconds of the zone's clock."""
        if self._silence.silent:
            return self._tick * self._tick_s
        return self._clock.at(asyncio.get_running_loop().time()) + self._shift * self._tick_s

    def confirm(self, session: Session) -> None:
        """Note that the client has read its welcome."""
        self._confirm(session)

    def depart(self, session: Session, comes_back: bool) -> None:
        """Let go of a session that has ended."""
        self.depart_session(session, comes_back)

    # --- who is here --------------------------------------------------------------------------

    @property
    def people(self) -> int:
        """The people in the whole zone, wherever their connections are."""
        return self.known.people

    @property
    def most_people(self) -> int:
        """The most people who may be in the zone."""
        return self._description.people

    def add(self, who: Occupant) -> None:
        """Take in somebody whose seat is here; they are welcomed once the zone shows them."""
        self.occupants[who.person] = who
        who.session.enter(self)
        who.session.avatar_id = who.person
        for muted in who.record.muted:
            self._lines.mute(who.person, muted, muted=True)
        self._upward.hold(who)

    def remove(self, who: Occupant, *, comes_back: bool) -> None:
        """Let somebody go whose connection has ended, and tell the zone."""
        self._forget(who)
        self._upward.depart(who, comes_back=comes_back)

    def hand_over(self, who: Occupant) -> None:
        """Let somebody go whose seat is in another zone, or another's."""
        self._forget(who)

    def missing(self, since_s: float) -> list[Occupant]:
        """Those whom the zone has not shown since that moment, seconds of the loop."""
        return [
            who
            for who in self.occupants.values()
            if who.person not in self.known and who.since_s <= since_s
        ]

    def muted_by(self, person: int) -> frozenset[int]:
        """Those whom a person does not want to hear."""
        return self._lines.muted_by(person)

    def _forget(self, who: Occupant) -> None:
        if self.occupants.get(who.person) is not who:
            return
        del self.occupants[who.person]
        self._lines.forget(who.person)
        if self.sessions.pop(who.person, None) is not None:
            self._detached.append(who.person)

    def _moves(self, person: int) -> bool:
        who = self.occupants.get(person)
        return who is not None and who.moves

    # --- down ---------------------------------------------------------------------------------

    async def run(self) -> None:
        """Show the frames of the zone until cancelled."""
        await self._receiver.start()
        try:
            while True:
                key, body = await self._receiver.next()
                try:
                    self._take(key, body)
                except FrameError as error:
                    log.warning("bad frame", zone=self.zone, tick=key.tick, error=str(error))
                    self._receiver.begin_anew()
        finally:
            await self._receiver.stop()

    def _take(self, key: FrameKey, body: Body) -> None:
        now_s, start = asyncio.get_running_loop().time(), perf_counter()
        self._times.begin()
        frame = decode_frame(body)
        self.heard_s = now_s
        if key.epoch != self._epoch:
            log.info("another owner", zone=self.zone, epoch=key.epoch)
            self._epoch = key.epoch
            self._clock.begin()
            self._heard = None if self._heard is None else -1
            # Ticks never fall for a client, whatever a new owner has found.
            self._shift = max(0, self._tick + 1 - frame.tick) if self._tick else 0
        self._clock.take(frame.tick, now_s, frame.rate)
        if key.is_whole:
            frame = self.known.difference(frame, heard=self._heard)
            self._held_s = -math.inf  # the zone may have taken everyone here for lost
        else:
            self._upward.acknowledge(frame.acks)
        self.known.take(frame)
        self._heard, self._tick = frame.tick, frame.tick + self._shift
        self._silence.heard()
        self._take_tickets(frame)
        attached = self._welcome(frame, now_s)
        told = replace(
            frame, tick=self._tick, joined=[], attached=attached, detached=self._detached
        )
        self._detached = []
        news = self._audience.take(told)
        with self._times.stage("write"):
            self._delivery.deliver(news, now_s)
        for person in self.sessions:
            self.occupants[person].since_s = now_s
        self._metrics.tick_took(perf_counter() - start, self._times.seconds)

    def _take_tickets(self, frame: Frame) -> None:
        """Take in which occupations the zone knows; whose seat somebody has taken since goes."""
        for generation, person in (*frame.joined, *frame.attached):
            who = self.occupants.get(person)
            if who is None:
                continue
            if who.generation < generation:
                self.replaced(who)
            elif who.generation == generation:
                who.is_known = True

    def replaced(self, who: Occupant) -> None:
        """Part with somebody whose seat somebody else has taken."""
        self.hand_over(who)
        text = "somebody came in with your resume token"
        farewell = frames.message(Bye(reason=ByeCode.REPLACED, text=text))
        who.session.dismiss(farewell, CloseCode.REPLACED, ByeCode.REPLACED.value)

    def _shows(self, who: Occupant, now_s: float) -> bool:
        """Whether somebody is in the zone, and nobody else steers them any more.

        The frame that tells of an occupation may be missed, so it is waited for for a while only.
        """
        waited = who.is_known or now_s - who.since_s > KNOWN_S
        return waited and who.person in self.known

    def _welcome(self, frame: Frame, now_s: float) -> list[tuple[int, int]]:
        """Welcome those whom the zone shows now; returns them as an audience wants them.

        Nothing is shown to whoever has left the zone until it is known where the seat is.
        """
        left = self.sessions.keys() & set(frame.left)
        left |= {person for person in self.sessions if person not in self.known}
        for person in left:
            del self.sessions[person]
            self._detached.append(person)
        attached = []
        if len(self.occupants) > len(self.sessions):
            for who in self.occupants.values():
                if who.person not in self.sessions and self._shows(who, now_s):
                    self._let_in(who)
                    attached.append((who.generation, who.person))
        return attached

    def _let_in(self, who: Occupant) -> None:
        session = who.session
        session.watching = None
        self.sessions[who.person] = session
        if not session.wants_steps:
            self._audience.send_no_steps(who.person)
        welcome = with_scene(self._welcome_of(who), self._description.scene)
        if who.is_in:
            session.outbox.begin_anew()
            travel = Travel(zone=self.zone, portal=who.record.portal)
            welcome = frames.message(travel) + welcome
        session.outbox.welcome(welcome)
        if not who.is_in:
            session.unconfirmed = who.resumed
            if session.fault_at_welcome is not None:
                session.tell(session.fault_at_welcome)
            self._metrics.joins.labels("resumed" if who.resumed else "new").inc()
        else:
            self._metrics.joins.labels("travelled").inc()
        who.is_in = True
        for told in who.told:
            session.outbox.post(told)
        who.told.clear()
        for line in who.lines:
            self._upward.say(who, line)
        who.lines.clear()
        log.info("person here", person=who.person, zone=self.zone, resumed=who.resumed)

    def _welcome_of(self, who: Occupant) -> Welcome:
        rules, session = self._description.world_rules, who.session
        return Welcome(
            version=session.version,
            id=who.person,
            name=session.name,
            resume=session.token,
            resumed=who.resumed,
            scene={},
            tick=self._tick,
            tick_rate=rules.tick_rate,
            server_time=self.server_time(),
            resume_seconds=self._description.resume_seconds,
            radius=rules.person_radius_m,
            clearance=rules.person_clearance_m,
            body_height=ADULT.height_m,
            step_height=ADULT.step_on_m,
            max_speed=rules.person_max_speed_mps,
            walk_speed=min(rules.person_walk_speed_mps, rules.person_max_speed_mps),
            origin=self._description.origin_m,
            doors=self.known.doors,
            operator=session.is_operator,
        )

    def answered(self, answer: Answer) -> None:
        """Pass on what the host says to somebody alone."""
        who = self.occupants.get(answer.person)
        if who is None or who.generation != answer.generation:
            return
        if answer.close is not None:
            self.hand_over(who)
            who.session.dismiss(answer.frame, answer.close, answer.reason)
        elif not answer.frame:
            self.replaced(who)
        elif who.person in self.sessions:
            who.session.outbox.post(answer.frame)
        elif len(who.told) < MOST_TOLD:
            who.told.append(answer.frame)

    # --- up -----------------------------------------------------------------------------------

    async def send(self) -> None:
        """Send what people want since the last call, and now and then who is here."""
        now_s = asyncio.get_running_loop().time()
        self._check_leases(now_s)
        self._silence.check(self.heard_s, now_s)
        if self._epoch == 0 or not self._broker.is_connected:
            return  # nobody would take it; the newest of everything waits
        held: list[tuple[int, int]] = []
        if now_s - self._held_s >= HOLD_S:
            self._held_s = now_s
            held = [(who.person, who.generation) for who in self.occupants.values()]
            for who in self.occupants.values():
                if who.mutes:  # the batch that has said so before may be lost
                    self._upward.mute(who, self._lines.muted_by(who.person))
                if who.away is not None:
                    self._upward.be_away(who, who.away)
                if who.look is not None:
                    self._upward.wear(who, who.look)
        batch = self._upward.batch(self._epoch, held, now_s)
        if batch is None:
            return
        try:
            await self._broker.publish(self._inputs, encode_batch(batch))
        except NatsError as error:
            log.debug("a batch was not sent", zone=self.zone, error=str(error))

    def _check_leases(self, now_s: float) -> None:
        """Let avatars of silent clients stand, and end connections that are silent for long."""
        leases = ((person, session.lease) for person, session in self.sessions.items())
        lapsed, gone = self._leases.check(leases, now_s)
        for person in lapsed:
            who = self.occupants[person]
            who.moves = False
            self._upward.stand(who)
            text = f"your avatar stands, because nothing came from you for {PING_S + ANSWER_S:g} s"
            who.session.tell(ProtocolError(ErrorCode.LEASE_ENDED, text, None))
        for person in gone:
            session = self.sessions[person]
            farewell = frames.message(
                Bye(reason=ByeCode.SILENT, text="nothing came from you for too long")
            )
            self.depart_session(session, True)
            session.dismiss(farewell, CloseCode.SILENT, ByeCode.SILENT.value)
