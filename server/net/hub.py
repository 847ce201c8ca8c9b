"""The hub joins sessions and the world: it seats people, collects their wishes, passes chat on."""

import asyncio
from collections.abc import Callable, Mapping
from typing import Final

import structlog

from esplanade.planning import MovedEnd
from esplanade.protocol import ByeCode, CloseCode, ErrorCode, ProtocolError
from esplanade.protocol.messages import Bye, Hello, Move, SetDoor, WalkTo
from esplanade.server.metrics import Metrics
from esplanade.server.net import frames
from esplanade.server.net.fair_queue import Asker
from esplanade.server.net.ground_work import DOOR_PAUSE_S
from esplanade.server.net.leases import ANSWER_S, PING_S, Leases
from esplanade.server.net.moderation import PeopleModeration
from esplanade.server.net.moved_goals import notice_of, refusal_of
from esplanade.server.net.names import Names, ReservedNameError
from esplanade.server.net.operator_keys import OperatorKeys, TooManyKeysError
from esplanade.server.net.route_requests import RouteRequests
from esplanade.server.net.seats import Seat, Seats
from esplanade.server.net.session import Session
from esplanade.server.net.welcomes import Welcomes
from esplanade.server.settings import ServerSettings
from esplanade.server.world.audience import Audience
from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import (
    Attach,
    Detach,
    Follow,
    Input,
    Join,
    Leave,
    MoveDoor,
    Movement,
    Say,
    Stand,
    Steer,
    Watch,
)
from esplanade.server.world.routes import Route
from esplanade.server.world.zone import Zone

MAX_JOINS_PER_TICK: Final = 16
"""Each join costs every neighbour an enter message, so a crowd comes in over some ticks."""
MAX_LINES: Final = 1024
"""Lines of chat that may wait for the next tick, of all people together."""

log = structlog.get_logger(__name__)


class Hub:
    """All sessions of a zone.

    Between two ticks the hub keeps at most one movement for each person, the latest, and a list
    of those who came and went; the number of people bounds both. `drain` hands them to the tick.
    `derived` holds the facts about the scene that a welcome adds to those in the scene's file.
    """

    def __init__(
        self,
        world: Zone,
        audience: Audience,
        route_requests: RouteRequests,
        settings: ServerSettings,
        metrics: Metrics,
        server_time: Callable[[], float],
        derived: Mapping[str, object],
    ) -> None:
        self.server_time = server_time
        self.sessions: dict[int, Session] = {}
        """Sessions that have been welcomed, by their avatar's id."""
        self._world = world
        self._audience = audience
        self._routes = route_requests
        self._settings = settings
        self._metrics = metrics
        self._welcomes = Welcomes(world, settings, server_time, derived)
        self._seats: Seats[Session] = Seats()
        self._names = Names(world.actor_names)
        self._leases = Leases(world.moves)
        self._operator_keys = OperatorKeys(settings.operator_key.get_secret_value(), metrics)
        self.moderation = PeopleModeration(
            self.sessions, self._kick, lambda: asyncio.get_running_loop().time()
        )
        self._next_ticket = 1
        self._joining: dict[int, tuple[Session, Hello]] = {}
        self._comings: list[Attach | Detach | Leave | Stand] = []
        self._movements: dict[int, Movement] = {}
        self._doors: dict[str, MoveDoor] = {}
        self._watches: dict[int, Watch] = {}
        self._lines: list[tuple[Session, str]] = []
        self._asked: set[int] = set()
        """Tickets of those who wait to join and have been sent to the zone."""
        self._door_lines: dict[str, float] = {}
        """Wishes for a door are logged as often as it may move: from when on, by its name."""
        metrics.gauge("clients", "People connected", lambda: len(self.sessions))
        metrics.gauge(
            "clients_away",
            "Avatars that wait for a lost person",
            self._vacant,
        )
        metrics.gauge("joining", "People who wait to join", lambda: len(self._joining))
        metrics.gauge(
            "lines_waiting",
            "Lines of chat that wait for the next tick",
            lambda: len(self._lines),
        )
        metrics.gauge("frames_waiting", "Frames that wait for slow clients", self._frames_waiting)
        metrics.gauge(
            "movements_waiting",
            "Movements that wait for the next tick",
            lambda: len(self._movements),
        )

    # --- requests of sessions -----------------------------------------------------------------

    def admit(self, session: Session, hello: Hello) -> None:
        """Let a newcomer wait to join, or give a person who comes back their own avatar.

        Raises
        ------
        ProtocolError
            The world is full, or the name is one that nobody may bear.
        """
        self._check_key(session, hello.operator)
        seat = self._seats.find(hello.resume) if hello.resume else None
        if seat is not None:
            self._resume(seat, session, hello.resume or "")
            return
        if len(self._seats) + len(self._joining) >= self._settings.max_clients:
            self._make_room()
        try:
            session.name = self._names.take(hello.name)
        except ReservedNameError as error:
            raise ProtocolError(
                ErrorCode.NAME_RESERVED, str(error), CloseCode.NAME_RESERVED
            ) from None
        session.ticket = self._next_ticket
        self._joining[session.ticket] = session, hello
        self._next_ticket += 1

    def move(self, session: Session, wish: Move | WalkTo) -> None:
        """Keep the wish for the next tick; it takes the place of an earlier one."""
        avatar_id = session.avatar_id
        if avatar_id is None:
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
        if route is not None:
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
        if len(self._lines) >= MAX_LINES:
            session.refuse_line("all", "too many people talk at once; nobody heard your line")
            return
        if session.avatar_id is not None:
            muted_s = self.moderation.muted_s(session.avatar_id)
            if muted_s > 0.0:
                text = f"an operator has muted you for {muted_s:.0f} s more; nobody heard your line"
                session.tell(ProtocolError(ErrorCode.MUTED, text, None))
                return
        self._metrics.chat_lines.inc()
        self._lines.append((session, text))

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
            self._watches[session.avatar_id] = Watch(session.avatar_id, actor_id)

    def set_door(self, session: Session, wish: SetDoor) -> None:
        """Open or close a door soon, if the session may; the latest wish for a door wins."""
        if not session.is_operator:
            fault = ErrorCode.FORBIDDEN, "only operators open and close doors"
        elif wish.name not in self._world.doors.states():
            fault = ErrorCode.INVALID, f"set_door: the scene has no door {wish.name!r}"
        else:
            now = asyncio.get_running_loop().time()
            if now >= self._door_lines.get(wish.name, now):
                self._door_lines[wish.name] = now + DOOR_PAUSE_S
                log.info("door", name=wish.name, open=wish.open, id=session.avatar_id)
            self._doors[wish.name] = MoveDoor(wish.name, wish.open)
            return
        session.tell(ProtocolError(*fault, None))

    def confirm(self, session: Session) -> None:
        """Note that a client that came back has its new token, so that the old one is void."""
        session.unconfirmed = False
        seat = None if session.avatar_id is None else self._seats.of(session.avatar_id)
        if seat is not None and seat.occupant is session:
            self._seats.confirm(seat)

    def depart(self, session: Session, comes_back: bool) -> None:
        """Let go of a session that has ended; its avatar waits if the person may come back."""
        if self._joining.pop(session.ticket, None) is not None:
            self._names.give_back(session.name)
        if session.avatar_id is None:
            return
        seat = self._seats.of(session.avatar_id)
        if seat is None or seat.occupant is not session:
            return
        self._unbind(seat)
        if comes_back and self._settings.resume_seconds > 0.0:
            self._seats.vacate(seat, asyncio.get_running_loop().time())
            self._comings.append(Detach(seat.avatar_id))
        else:
            self._remove(seat)
        log.info("person gone", id=seat.avatar_id, name=seat.name, may_come_back=comes_back)

    # --- requests of the tick -----------------------------------------------------------------

    def drain(self, now: float) -> list[Input]:
        """Return everything for the next tick: at most one movement a person, and a few joins."""
        for seat in self._seats.vacant_since(now - self._settings.resume_seconds):
            self._remove(seat)
        self._check_leases(now)
        # A line is said before its speaker goes.
        inputs: list[Input] = [*self._spoken(), *self._comings]
        at_the_door = [ticket for ticket in self._joining if ticket not in self._asked]
        for ticket in at_the_door[:MAX_JOINS_PER_TICK]:
            session, hello = self._joining[ticket]
            anywhere = session.is_operator or self._settings.crowd is not None
            inputs.append(Join(ticket, session.name, hello.at, anywhere))
            self._asked.add(ticket)
        inputs.extend(self._movements.values())
        inputs.extend(self._doors.values())
        inputs.extend(self._watches.values())
        self._comings, self._movements, self._doors, self._watches = [], {}, {}, {}
        return inputs

    def _spoken(self) -> list[Say]:
        """The lines of those who are in the world; those at the door go on waiting."""
        lines, self._lines = self._lines, []
        self._lines = [line for line in lines if line[0].ticket in self._joining]
        return [
            Say(session.avatar_id, text) for session, text in lines if session.avatar_id is not None
        ]

    def welcome(self, frame: Frame) -> None:
        """Welcome the people whom the tick has let in, before anything else is sent to them."""
        for ticket, avatar_id in frame.joined:
            self._asked.discard(ticket)
            if ticket not in self._joining:
                # The person went while the zone made the avatar.
                self._comings.append(Leave(avatar_id))
                continue
            session, _ = self._joining.pop(ticket)
            session.token = self._seats.issue(avatar_id, session.name, session.address, session)
            session.avatar_id = avatar_id
            self._bind(session, avatar_id, resumed=False)
        for ticket, avatar_id in frame.attached:
            seat = self._seats.of(avatar_id)
            # Somebody else may have come back to the avatar since; the later one has it.
            if seat is not None and seat.occupant is not None and seat.occupant.ticket == ticket:
                self._bind(seat.occupant, avatar_id, resumed=True)

    async def close(self) -> None:
        """Say goodbye to everyone and wait until they are gone, or cut off."""
        text = "the server is shutting down"
        farewell = frames.message(Bye(reason=ByeCode.SHUTDOWN, text=text))
        everyone = [*self.sessions.values(), *(session for session, _ in self._joining.values())]
        tasks = [session.dismiss(farewell, CloseCode.GOING_AWAY, text) for session in everyone]
        if tasks:
            await asyncio.wait(tasks)

    # --- seats --------------------------------------------------------------------------------

    def _make_room(self) -> None:
        """Take a vacant seat away, so that a newcomer finds room.

        Raises
        ------
        ProtocolError
            None is vacant.
        """
        seat = self._seats.yielding()
        if seat is None:
            raise ProtocolError(
                ErrorCode.SERVER_FULL,
                f"there is room for {self._settings.max_clients} people, all taken",
                CloseCode.SERVER_FULL,
            )
        self._metrics.seats_yielded.inc()
        self._remove(seat)
        log.info("vacant seat yielded", id=seat.avatar_id, name=seat.name, address=seat.address)

    def _check_key(self, session: Session, key: str | None) -> None:
        now = asyncio.get_running_loop().time()
        try:
            session.is_operator = self._operator_keys.opens(key, session.address, now)
        except TooManyKeysError as error:
            session.fault_at_welcome = ProtocolError(ErrorCode.KEY_UNREAD, str(error), None)

    def _check_leases(self, now: float) -> None:
        """Let avatars of silent clients stand, and end connections that are silent for long."""
        leases = ((avatar_id, session.lease) for avatar_id, session in self.sessions.items())
        lapsed, gone = self._leases.check(leases, now)
        for avatar_id in lapsed:
            self._movements.pop(avatar_id, None)
            self._routes.forget(avatar_id)
            self._comings.append(Stand(avatar_id))
            text = f"your avatar stands, because nothing came from you for {PING_S + ANSWER_S:g} s"
            self.sessions[avatar_id].tell(ProtocolError(ErrorCode.LEASE_ENDED, text, None))
        for avatar_id in gone:
            session = self.sessions[avatar_id]
            text = "nothing came from you for too long"
            farewell = frames.message(Bye(reason=ByeCode.SILENT, text=text))
            self.depart(session, comes_back=True)
            session.dismiss(farewell, CloseCode.SILENT, ByeCode.SILENT.value)

    def _kick(self, session: Session) -> None:
        """Give up the seat of a session: whoever had it comes back as somebody new."""
        seat = None if session.avatar_id is None else self._seats.of(session.avatar_id)
        if seat is not None and seat.occupant is session:
            self._unbind(seat)
            self._remove(seat)

    def _resume(self, seat: Seat[Session], session: Session, token: str) -> None:
        before = self._seats.occupy(seat, session, session.address)
        if before is not None:
            self._unbind(seat)
            text = "somebody came in with your resume token"
            farewell = frames.message(Bye(reason=ByeCode.REPLACED, text=text))
            before.dismiss(farewell, CloseCode.REPLACED, ByeCode.REPLACED.value)
        session.avatar_id, session.name = seat.avatar_id, seat.name
        session.token = self._seats.renew(seat, token)
        session.ticket = self._next_ticket
        self._next_ticket += 1
        self._comings += [Detach(seat.avatar_id), Attach(seat.avatar_id, session.ticket)]

    def _bind(self, session: Session, avatar_id: int, resumed: bool) -> None:
        self.sessions[avatar_id] = session
        if not session.wants_steps:
            self._audience.send_no_steps(avatar_id)
        session.outbox.welcome(self._welcomes.frame(session, avatar_id, resumed))
        session.unconfirmed = resumed
        if session.fault_at_welcome is not None:
            session.tell(session.fault_at_welcome)
        self._metrics.joins.labels("resumed" if resumed else "new").inc()
        log.info("person here", id=avatar_id, name=session.name, resumed=resumed)

    def _unbind(self, seat: Seat[Session]) -> None:
        self.sessions.pop(seat.avatar_id, None)
        self._movements.pop(seat.avatar_id, None)
        self._watches.pop(seat.avatar_id, None)
        self._routes.forget(seat.avatar_id)

    def _want(self, movement: Movement) -> None:
        if movement.id in self._movements:
            self._metrics.traffic.movements_superseded += 1
        self._movements[movement.id] = movement
        self._routes.forget(movement.id)

    def _remove(self, seat: Seat[Session]) -> None:
        self._seats.remove(seat)
        self._names.give_back(seat.name)
        self._comings.append(Leave(seat.avatar_id))

    def _vacant(self) -> int:
        return self._seats.vacant

    def _frames_waiting(self) -> int:
        return sum(session.outbox.waiting for session in self.sessions.values())
