"""The hub joins sessions and the world: it seats people, collects their wishes, passes chat on."""

import asyncio
from collections.abc import Callable, Mapping
from typing import Any, Final

import structlog

from esplanade.protocol import ByeCode, CloseCode, ErrorCode, ProtocolError
from esplanade.protocol.messages import (
    Bye,
    Error,
    Hello,
    Move,
    MutePerson,
    Report,
    SetDoor,
    WalkTo,
)
from esplanade.server.checkpoint.returning import Left
from esplanade.server.checkpoint.rows import KeptSeat
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
from esplanade.server.net.names import Names, ReservedNameError
from esplanade.server.net.operator_keys import SERVICE, OperatorKeys, TooManyKeysError
from esplanade.server.net.pace_notices import PaceNotices
from esplanade.server.net.reporting import Reporting
from esplanade.server.net.route_requests import RouteRequests
from esplanade.server.net.seats import Seat, Seats
from esplanade.server.net.session import Session
from esplanade.server.net.walk_outs import WalkOuts
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
from esplanade.server.world.pace import Pace
from esplanade.server.world.routes import Route
from esplanade.server.world.zone import Zone

MAX_JOINS_PER_TICK: Final = 16
"""Each join costs every neighbour an enter message, so a crowd comes in over some ticks."""
NAMELESS: Final = "Guest"
"""The name of somebody who comes back with one that nobody may bear any more."""
MAX_LINES: Final = 1024
"""Lines of chat that may wait for the next tick, of all people together."""

log = structlog.get_logger(__name__)


class Hub:
    """All sessions of a zone.

    Between two ticks the hub keeps at most one movement for each person, the latest, and a list
    of those who came and went; the number of people bounds both. `drain` hands them to the tick.
    `derived` holds the facts about the scene that a welcome adds to those in the scene's file.
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
        self.sessions: dict[int, Session] = {}
        """Sessions that have been welcomed, by their avatar's id."""
        self._world = world
        self._audience = audience
        self._routes = route_requests
        self._settings = settings
        self._metrics = metrics
        self._welcomes = Welcomes(world, settings, server_time, derived)
        self._seats: Seats[Session] = Seats()
        self._keeper = keeper
        self._names = Names(world.actor_names)
        self._leases = Leases(world.moves)
        self._operator_keys = OperatorKeys(settings.operator_key.get_secret_value(), metrics)
        storeys = _storeys(derived)
        self.moderation = PeopleModeration(
            moderated,
            world,
            storeys,
            self.sessions,
            self._seats,
            self._kick,
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
        self._chat_gate = ChatGate(moderated, storeys)
        self._reporting = Reporting(moderated, self._reportable, self.moderation.where)
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
        has_seat = bool(hello.resume) and self._seats.find(hello.resume or "") is not None
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
        if avatar_id is None or avatar_id in self._walk_outs:
            return
        if isinstance(wish, Move):
            self._want(Steer(avatar_id, wish.seq, wish.direction, wish.speed))
            return
        try:
            self._routes.ask(Asker(session.address, avatar_id), wish)
        except ProtocolError as refusal:
            session.tell(refusal)

    def route_found(self, avatar_id: int, wish: WalkTo, route: Route | None) -> None:
        """Send a person along the route that was found, or tell them that there is none."""
        session = self.sessions.get(avatar_id)
        if session is None:
            return
        if avatar_id in self._walk_outs:
            self._walk_outs.route_found(avatar_id, route)
        elif route is not None:
            self._want(Follow(avatar_id, wish.seq, route))
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
                fault = ErrorCode.MUTED, text, None, {"seconds": round(muted_s, 1)}
                session.tell(ProtocolError(*fault))
                return
        now = asyncio.get_running_loop().time()
        try:
            text = self._chat_gate.pass_words(session.avatar_id or -session.ticket, text, now)
        except ProtocolError as fault:
            session.tell(fault)
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
            if self.by_commands:
                self.by_commands.ask(session, wish)
                return
            now = asyncio.get_running_loop().time()
            if now >= self._door_lines.get(wish.name, now):
                self._door_lines[wish.name] = now + DOOR_PAUSE_S
                log.info("door", name=wish.name, open=wish.open, id=session.avatar_id)
            self._doors[wish.name] = MoveDoor(wish.name, wish.open)
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

    def confirm(self, session: Session) -> None:
        """Note that a client that came back has its new token, so that the old one is void."""
        session.unconfirmed = False
        seat = None if session.avatar_id is None else self._seats.of(session.avatar_id)
        if seat is not None and seat.occupant is session:
            self._seats.confirm(seat)
            if self._keeper is not None:
                self._keeper.confirm(seat.avatar_id, seat.address, tuple(seat.digests))

    def depart(self, session: Session, comes_back: bool) -> None:
        """Let go of a session that has ended; its avatar waits if the person may come back."""
        if self._entrance is not None:
            self._entrance.end(session.admitted)
        if self._joining.pop(session.ticket, None) is not None:
            self._names.give_back(session.name)
        if session.avatar_id is None:
            return
        seat = self._seats.of(session.avatar_id)
        if seat is None or seat.occupant is not session:
            return
        comes_back = comes_back and seat.avatar_id not in self._walk_outs
        self.moderation.remember(session)
        self._unbind(seat)
        if comes_back and self._settings.resume_seconds > 0.0:
            self._seats.vacate(seat, self._run_for_s(asyncio.get_running_loop().time()))
            self._comings.append(Detach(seat.avatar_id))
        else:
            self._remove(seat)
        log.info("person gone", id=seat.avatar_id, name=seat.name, may_come_back=comes_back)

    # --- requests of the tick -----------------------------------------------------------------

    def drain(self, now: float, *, still: bool = False) -> list[Input]:
        """Return everything for the next tick: at most one movement a person, and a few joins.

        For a `still` tick, in which nobody moves, movements wait for the next one.
        """
        for seat in self._seats.vacant_since(self._run_for_s(now) - self._settings.resume_seconds):
            self._remove(seat)
        self._check_leases(now)
        self._walk_outs.check(now)
        # A line is said before its speaker goes.
        inputs: list[Input] = [*self._spoken(), *self._comings]
        at_the_door = [ticket for ticket in self._joining if ticket not in self._asked]
        for ticket in at_the_door[: min(MAX_JOINS_PER_TICK, self._world.state.ids_left)]:
            session, hello = self._joining[ticket]
            anywhere = session.is_operator or self._settings.crowd is not None
            inputs.append(Join(ticket, session.name, hello.at, anywhere))
            self._asked.add(ticket)
        if not still:
            inputs.extend(self._movements.values())
            self._movements = {}
        inputs.extend(self._doors.values())
        inputs.extend(self._watches.values())
        self._comings, self._doors, self._watches = [], {}, {}
        return inputs

    def _spoken(self) -> list[Say]:
        """The lines of those who are in the world; those at the door go on waiting."""
        lines, self._lines = self._lines, []
        self._lines = [line for line in lines if line[0].ticket in self._joining]
        spoken = []
        for session, text in lines:
            place = None if session.avatar_id is None else self.moderation.where(session.avatar_id)
            if session.avatar_id is None or place is None:
                continue
            try:
                self._chat_gate.check_place(place)
            except ProtocolError as fault:
                session.tell(fault)
            else:
                spoken.append(Say(session.avatar_id, text))
        return spoken

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
            self._seats.walks_in(avatar_id, session.operator)
            session.avatar_id = avatar_id
            self._keep_new(session, avatar_id)
        for ticket, avatar_id in frame.attached:
            seat = self._seats.of(avatar_id)
            # Somebody else may have come back to the avatar since; the later one has it.
            if seat is not None and seat.occupant is not None and seat.occupant.ticket == ticket:
                self._bind(seat.occupant, avatar_id, resumed=seat.occupant.resumes)

    async def close(self) -> None:
        """Say goodbye to everyone and wait until they are gone, or cut off."""
        text = "the server is shutting down"
        farewell = frames.message(Bye(reason=ByeCode.SHUTDOWN, text=text))
        everyone = [*self._seats.occupants(), *(session for session, _ in self._joining.values())]
        tasks = [session.dismiss(farewell, CloseCode.GOING_AWAY, text) for session in everyone]
        if tasks:
            await asyncio.wait(tasks)

    # --- seats --------------------------------------------------------------------------------

    def save_seats(self) -> dict[str, Any]:
        """The seats there are, and for how long each has waited; their rows say whose they are."""
        now = asyncio.get_running_loop().time()
        return {"next_id": self._world.state.next_id, "vacant_s": self._seats.vacant_s(now)}

    def restore(self, left: Left) -> None:
        """Let people come back to seats from before a restart; the world has their avatars."""
        now = asyncio.get_running_loop().time()
        for kept, waited_s in left.waiting:
            try:
                name = self._names.take(kept.name)
            except ReservedNameError:
                name = self._names.take(NAMELESS)
            digests = list(kept.digests)
            seat: Seat[Session] = Seat(kept.avatar, name, kept.address, None, digests)
            self._seats.restore(seat, now - waited_s)
        if self._keeper is not None:
            for avatar_id in left.gone:
                self._keeper.remove(avatar_id)

    def _keep_new(self, session: Session, avatar_id: int) -> None:
        """Write the seat of a newcomer, who is welcomed once it is committed."""
        seat = self._seats.of(avatar_id)
        if self._keeper is None or seat is None:
            self._bind(session, avatar_id, resumed=False)
            return
        place, digests = self._world.where(avatar_id), tuple(seat.digests)
        kept = KeptSeat(avatar_id, seat.name, seat.address, digests, place)
        self._when_kept(self._keeper.add(kept), session)

    def _when_kept(self, done: "asyncio.Future[bool]", session: Session) -> None:
        done.add_done_callback(lambda done: self._let_in(session, is_kept=done.result()))

    def _let_in(self, session: Session, *, is_kept: bool) -> None:
        """Let somebody look whose seat is in the store now, or end the session if it is not."""
        seat = None if session.avatar_id is None else self._seats.of(session.avatar_id)
        if seat is None or seat.occupant is not session:
            return
        if is_kept:
            self._comings += [Detach(seat.avatar_id), Attach(seat.avatar_id, session.ticket)]
            return
        text = "your seat cannot be kept just now; come again"
        self._unbind(seat)
        self._remove(seat)
        self._metrics.errors.labels(ErrorCode.SERVER_FULL.value).inc()
        farewell = frames.message(Error(error=ErrorCode.SERVER_FULL, text=text))
        session.dismiss(farewell, CloseCode.SERVER_FULL, ErrorCode.SERVER_FULL.value)

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
            if self._operator_keys.opens(key, session.address, now):
                session.operator = session.operator or SERVICE
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
            self.moderation.remember(session)
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
        self._seats.walks_in(seat.avatar_id, session.operator)
        session.operator = session.operator or seat.operator
        session.token = self._seats.renew(seat, token)
        session.ticket = self._next_ticket
        self._next_ticket += 1
        session.resumes = True
        self._comings.append(Detach(seat.avatar_id))
        if self._keeper is None:
            self._comings.append(Attach(seat.avatar_id, session.ticket))
            return
        digests = tuple(seat.digests)
        self._when_kept(self._keeper.change(seat.avatar_id, seat.address, digests), session)

    def _bind(self, session: Session, avatar_id: int, resumed: bool) -> None:
        self.sessions[avatar_id] = session
        if not session.wants_steps:
            self._audience.send_no_steps(avatar_id)
        session.outbox.welcome(self._welcomes.frame(session, avatar_id, resumed))
        self._pace_notices.tell_newcomer(session, self._pace.state)
        session.unconfirmed = resumed
        if resumed:
            self.moderation.greet(session)
        if session.fault_at_welcome is not None:
            session.tell(session.fault_at_welcome)
        self._metrics.joins.labels("resumed" if resumed else "new").inc()
        log.info("person here", id=avatar_id, name=session.name, resumed=resumed)

    def _unbind(self, seat: Seat[Session]) -> None:
        self.sessions.pop(seat.avatar_id, None)
        self._movements.pop(seat.avatar_id, None)
        self._watches.pop(seat.avatar_id, None)
        self._routes.forget(seat.avatar_id)
        self._walk_outs.forget(seat.avatar_id)
        self.moderation.lines.forget(seat.avatar_id)

    def _want(self, movement: Movement) -> None:
        if movement.id in self._movements:
            self._metrics.traffic.movements_superseded += 1
        self._movements[movement.id] = movement
        self._routes.forget(movement.id)

    def _remove(self, seat: Seat[Session]) -> None:
        self._seats.remove(seat)
        self._names.give_back(seat.name)
        self._comings.append(Leave(seat.avatar_id))
        if self._keeper is not None:
            self._keeper.remove(seat.avatar_id)

    def _run_for_s(self, now: float) -> float:
        """A clock that stands while the world does: nobody's seat is lost in a pause."""
        return now - self._pace.standing_s(now)

    def _vacant(self) -> int:
        return self._seats.vacant

    def _frames_waiting(self) -> int:
        return sum(session.outbox.waiting for session in self.sessions.values())


def _storeys(derived: Mapping[str, object]) -> list[float]:
    """The heights of the storeys among the facts that are derived from a scene."""
    found = derived.get("storeys", ())
    return [float(height) for height in found] if isinstance(found, list | tuple) else []
