"""The hub joins sessions and the world: it collects people's wishes, and passes chat on."""

import asyncio
from collections.abc import Callable, Mapping
from typing import Any

import structlog

from esplanade.planning import MovedEnd
from esplanade.protocol import ByeCode, CloseCode, ErrorCode, ProtocolError
from esplanade.protocol.messages import (
    Bye,
    Hello,
    Move,
    MutePerson,
    Report,
    SetDoor,
    WalkTo,
)
from esplanade.server.checkpoint.returning import Left
from esplanade.server.checkpoint.seat_keeper import SeatKeeper
from esplanade.server.metrics import Metrics
from esplanade.server.moderation.state import ModerationState
from esplanade.server.net import frames
from esplanade.server.net.chat_gate import ChatGate
from esplanade.server.net.door_commands import DoorCommands
from esplanade.server.net.entrance import Entrance
from esplanade.server.net.fair_queue import Asker
from esplanade.server.net.ground_work import DOOR_PAUSE_S
from esplanade.server.net.leases import ANSWER_S, PING_S, Leases
from esplanade.server.net.lines import MOST_MUTED
from esplanade.server.net.moderation import PeopleModeration
from esplanade.server.net.moved_goals import notice_of, refusal_of
from esplanade.server.net.operator_keys import SERVICE, OperatorKeys, TooManyKeysError
from esplanade.server.net.pace_notices import PaceNotices
from esplanade.server.net.pending_inputs import PendingInputs
from esplanade.server.net.reporting import Reporting
from esplanade.server.net.route_requests import RouteRequests
from esplanade.server.net.seating import Seating
from esplanade.server.net.session import Session
from esplanade.server.net.waiting_lines import WaitingLines
from esplanade.server.net.walk_outs import WalkOuts
from esplanade.server.net.welcomes import Welcomes
from esplanade.server.settings import ServerSettings
from esplanade.server.world.audience import Audience
from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import Follow, Input, MoveDoor, Movement, Steer, Watch
from esplanade.server.world.pace import Pace
from esplanade.server.world.routes import Route
from esplanade.server.world.zone import Zone

log = structlog.get_logger(__name__)


class Hub:
    """All sessions of a zone.

    Who has a seat is the business of `Seating`; what waits for the next tick is in `PendingInputs`,
    which `drain` hands to the tick. `derived` holds the facts about the scene that a welcome adds
    to those in the scene's file.
    """

    def __init__(  # noqa: PLR0913, PLR0917 (every part of the network meets here)
        self,
        world: Zone,
        audience: Audience,
        route_requests: RouteRequests,
        settings: ServerSettings,
        metrics: Metrics,
        server_time: Callable[[], float],
        derived: Mapping[str, object],
        moderated: ModerationState,
        entrance: Entrance | None = None,
        pace: Pace | None = None,
        keeper: SeatKeeper | None = None,
    ) -> None:
        """Without an entrance nobody is asked what lets them in.

        With a `keeper`, nobody is welcomed before their seat is in the store.
        """
        self.server_time = server_time
        self._world = world
        self._audience = audience
        self._routes = route_requests
        self._pending = PendingInputs(metrics)
        self._seating = Seating(
            world,
            audience,
            settings,
            metrics,
            Welcomes(world, settings, server_time, derived),
            self._pending,
            keeper,
            greet=self._greet,
            leaving=lambda session: self.moderation.remember(session),  # noqa: PLW0108 - made below
            forget=self._forget,
        )
        self.sessions = self._seating.sessions
        """Sessions that have been welcomed, by their avatar's id."""
        self._leases = Leases(world.moves)
        self._operator_keys = OperatorKeys(settings.operator_key.get_secret_value(), metrics)
        storeys = _storeys(derived)
        self.moderation = PeopleModeration(
            moderated,
            world,
            storeys,
            self.sessions,
            self._seating.seats,
            self._seating.give_up,
            lambda: asyncio.get_running_loop().time(),
        )
        self._entrance = entrance
        self.by_commands: DoorCommands | None = None
        """Carries out what operators want who have walked in by a pass."""
        self._pace = pace or Pace()
        self._pace_notices = PaceNotices(self.sessions, server_time)
        self._pace.changed.append(self._pace_notices.tell_all)
        self._walk_outs = self.moderation.walk_outs = WalkOuts(
            world, self.sessions, route_requests, self._want, self.moderation.has_walked_out
        )
        self._lines = WaitingLines(
            self.moderation, ChatGate(moderated, storeys), self._seating.is_at_the_door, metrics
        )
        self._reporting = Reporting(moderated, self._reportable, self.moderation.where)
        self._door_lines: dict[str, float] = {}
        """Wishes for a door are logged as often as it may move: from when on, by its name."""
        metrics.gauge("frames_waiting", "Frames that wait for slow clients", self._frames_waiting)

    # --- coming and going ---------------------------------------------------------------------

    async def receive(self, session: Session, hello: Hello) -> None:
        """Find out whether a client may come in, and admit it.

        Raises
        ------
        ProtocolError
            It may not, or there is no room.
        """
        if self._entrance is None:
            self.admit(session, hello)
            return
        has_seat = bool(hello.resume) and self._seating.seats.find(hello.resume or "") is not None
        session.admitted = admitted = await self._entrance.check(
            hello.admission, session.address, session.identity, has_seat
        )
        session.operator = admitted.operator
        try:
            self.admit(session, hello)
        except ProtocolError:
            await self._entrance.turn_away(admitted)
            raise

    def admit(self, session: Session, hello: Hello) -> None:
        """Let a newcomer wait to join, or give a person who comes back their own avatar.

        Raises
        ------
        ProtocolError
            A ban keeps them out, the world is full, or the name is one that nobody may bear.
        """
        self.moderation.check_ban(hello.name, session.address, hello.resume)
        self._check_key(session, hello.operator)
        self._seating.admit(session, hello)

    def confirm(self, session: Session) -> None:
        """Note that a client that came back has its new token, so that the old one is void."""
        self._seating.confirm(session)

    def depart(self, session: Session, comes_back: bool) -> None:
        """Let go of a session that has ended; its avatar waits if the person may come back."""
        if self._entrance is not None:
            self._entrance.end(session.admitted)
        comes_back = comes_back and session.avatar_id not in self._walk_outs
        now = asyncio.get_running_loop().time()
        self._seating.depart(session, comes_back, self._run_for_s(now))

    def welcome(self, frame: Frame) -> None:
        """Welcome the people whom the tick has let in, before anything else is sent to them."""
        self._seating.welcome(frame)

    def save_seats(self) -> dict[str, Any]:
        """The seats there are, and for how long each has waited; their rows say whose they are."""
        return self._seating.save_seats()

    def restore(self, left: Left) -> None:
        """Let people come back to seats from before a restart; the world has their avatars."""
        self._seating.restore(left)

    async def close(self) -> None:
        """Say goodbye to everyone and wait until they are gone, or cut off."""
        text = "the server is shutting down"
        farewell = frames.message(Bye(reason=ByeCode.SHUTDOWN, text=text))
        tasks = [
            session.dismiss(farewell, CloseCode.GOING_AWAY, text)
            for session in self._seating.everyone()
        ]
        if tasks:
            await asyncio.wait(tasks)

    def _check_key(self, session: Session, key: str | None) -> None:
        now = asyncio.get_running_loop().time()
        try:
            if self._operator_keys.opens(key, session.address, now):
                session.operator = session.operator or SERVICE
        except TooManyKeysError as error:
            session.fault_at_welcome = ProtocolError(ErrorCode.KEY_UNREAD, str(error), None)

    def _greet(self, session: Session, came_back: bool) -> None:
        """Tell somebody who is welcomed what they have missed."""
        self._pace_notices.tell_newcomer(session, self._pace.state)
        if came_back:
            self.moderation.greet(session)

    def _forget(self, avatar_id: int) -> None:
        """Forget what is under way for an avatar whose connection has ended."""
        self._routes.forget(avatar_id)
        self._walk_outs.forget(avatar_id)
        self.moderation.lines.forget(avatar_id)

    def _run_for_s(self, now: float) -> float:
        """A clock that stands while the world does: nobody's seat is lost in a pause."""
        return now - self._pace.standing_s(now)

    # --- wishes of people ---------------------------------------------------------------------

    def move(self, session: Session, wish: Move | WalkTo) -> None:
        """Keep the wish for the next tick; it takes the place of an earlier one."""
        avatar_id = session.avatar_id
        if avatar_id is None or avatar_id in self._walk_outs:
            return
        if isinstance(wish, Move):
            self._want(Steer(avatar_id, wish.seq, wish.direction, wish.speed))
            return
        try:
            self._routes.ask(Asker(session.address, avatar_id), wish)
        except ProtocolError as refusal:
            session.tell(refusal)

    def route_found(
        self, avatar_id: int, wish: WalkTo, route: Route | None, moved: MovedEnd | None
    ) -> None:
        """Send a person along the route that was found, or tell them that there is none.

        They are also told where it leads instead, if nobody can stand where they wanted to go.
        """
        session = self.sessions.get(avatar_id)
        if session is None:
            return
        if avatar_id in self._walk_outs:
            self._walk_outs.route_found(avatar_id, route)
        elif route is not None:
            self._want(Follow(avatar_id, wish.seq, route))
            if moved is not None:
                session.outbox.post(frames.message(notice_of(wish, moved)))
        elif moved is not None and wish.strict:
            session.tell(refusal_of(wish, moved))
        else:
            text = f"no way leads to ({wish.x:.2f}, {wish.y:.2f}, {wish.z:.2f})"
            session.tell(ProtocolError(ErrorCode.NO_PATH, text, None))

    def say(self, session: Session, text: str) -> None:
        """Say a line in the next tick; that of somebody at the door waits until they are in."""
        self._lines.put(session, text)

    def watch(self, session: Session, actor_id: int | None) -> None:
        """Send the plans of an actor from now on, or of none."""
        if actor_id is not None and not (
            session.avatar_id is not None
            and self._audience.is_actor(actor_id)
            and self._audience.sees(session.avatar_id, actor_id)
        ):
            session.tell(
                ProtocolError(ErrorCode.INVALID, f"watch: {actor_id} is no actor in view", None)
            )
            actor_id = None
        self._watch(session, actor_id)

    def stop_watching(self, session: Session) -> None:
        """Send no more plans: the actor is out of view."""
        self._watch(session, None)

    def _watch(self, session: Session, actor_id: int | None) -> None:
        session.watching = actor_id
        if session.avatar_id is not None:
            self._pending.watch(Watch(session.avatar_id, actor_id))

    def set_door(self, session: Session, wish: SetDoor) -> None:
        """Open or close a door soon, if the session may; the latest wish for a door wins."""
        if not session.is_operator:
            fault = ErrorCode.FORBIDDEN, "only operators open and close doors"
        elif wish.name not in self._world.doors.states():
            fault = ErrorCode.INVALID, f"set_door: the scene has no door {wish.name!r}"
        else:
            if self.by_commands:
                self.by_commands.ask(session, wish)
                return
            now = asyncio.get_running_loop().time()
            if now >= self._door_lines.get(wish.name, now):
                self._door_lines[wish.name] = now + DOOR_PAUSE_S
                log.info("door", name=wish.name, open=wish.open, id=session.avatar_id)
            self._pending.move_door(MoveDoor(wish.name, wish.open))
            return
        session.tell(ProtocolError(*fault, None))

    def report(self, session: Session, report: Report) -> None:
        """Put a report about somebody before moderators, and tell the person so."""
        made = self._reporting.take(session, report, asyncio.get_running_loop().time())
        if made is not None:
            log.info("person reported", report=made.id, id=made.person, by=made.reporter)
            about = {
                "report": made.id,
                "who": made.reporter,
                "other": made.person,
                "name": made.name,
                "text": made.text,
                "place": made.place,
            }
            self.moderation.happened("report", about)

    def mute(self, session: Session, wish: MutePerson) -> None:
        """Send no lines of somebody to the session any more, or send them again."""
        avatar_id = session.avatar_id
        if avatar_id is None:
            return
        if not self.moderation.lines.mute(avatar_id, wish.id, muted=wish.muted):
            text = f"you have muted {MOST_MUTED} people, no more can be at once"
            session.tell(ProtocolError(ErrorCode.FLOODING, text, None))

    def _reportable(self, avatar_id: int) -> str | None:
        """The name of a person or an actor who is here, or of a person who has just left."""
        if avatar_id in self._world.state:
            return self._world.state.names[self._world.state.slot(avatar_id)]
        known = self.moderation.known(avatar_id)
        return None if known is None else known.name

    def _want(self, movement: Movement) -> None:
        self._pending.move(movement)
        self._routes.forget(movement.id)

    # --- requests of the tick -----------------------------------------------------------------

    def drain(self, now: float, *, still: bool = False) -> list[Input]:
        """Return everything for the next tick: at most one movement a person, and a few joins.

        For a `still` tick, in which nobody moves, movements wait for the next one.
        """
        self._seating.end_waiting(self._run_for_s(now))
        self._check_leases(now)
        self._walk_outs.check(now)
        return self._pending.drain(self._lines.drain(), self._seating.joins(), still=still)

    def _check_leases(self, now: float) -> None:
        """Let avatars of silent clients stand, and end connections that are silent for long."""
        leases = ((avatar_id, session.lease) for avatar_id, session in self.sessions.items())
        lapsed, gone = self._leases.check(leases, now)
        for avatar_id in lapsed:
            self._routes.forget(avatar_id)
            self._pending.stand(avatar_id)
            text = f"your avatar stands, because nothing came from you for {PING_S + ANSWER_S:g} s"
            self.sessions[avatar_id].tell(ProtocolError(ErrorCode.LEASE_ENDED, text, None))
        for avatar_id in gone:
            session = self.sessions[avatar_id]
            text = "nothing came from you for too long"
            farewell = frames.message(Bye(reason=ByeCode.SILENT, text=text))
            self.depart(session, comes_back=True)
            session.dismiss(farewell, CloseCode.SILENT, ByeCode.SILENT.value)

    def _frames_waiting(self) -> int:
        return sum(session.outbox.waiting for session in self.sessions.values())


def _storeys(derived: Mapping[str, object]) -> list[float]:
    """The heights of the storeys among the facts that are derived from a scene."""
    found = derived.get("storeys", ())
    return [float(height) for height in found] if isinstance(found, list | tuple) else []
