"""Seats people: who waits at the door, who is in, who comes back, and who goes."""

import asyncio
from collections.abc import Callable
from typing import Any, Final

import structlog

from esplanade.protocol import ByeCode, CloseCode, ErrorCode, ProtocolError
from esplanade.protocol.messages import Bye, Error, Hello, Travel
from esplanade.server.checkpoint.returning import Left
from esplanade.server.checkpoint.rows import KeptSeat
from esplanade.server.checkpoint.seat_keeper import SeatKeeper
from esplanade.server.metrics import Metrics
from esplanade.server.net import frames
from esplanade.server.net.arrivals import Arrival, Arrivals
from esplanade.server.net.names import Names, ReservedNameError
from esplanade.server.net.newcomers import Newcomers
from esplanade.server.net.pending_inputs import PendingInputs
from esplanade.server.net.person import Person
from esplanade.server.net.seats import Seat, Seats
from esplanade.server.net.session import Session
from esplanade.server.net.welcomes import Welcomes
from esplanade.server.settings import ServerSettings
from esplanade.server.world.audience import Audience
from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import Attach, Detach, Join, Leave, SetLook
from esplanade.server.world.zone import Zone

NAMELESS: Final = "Guest"
"""The name of somebody who comes back with one that nobody may bear any more."""

log = structlog.get_logger(__name__)


class Seating:
    """Gives people seats in a zone, and takes them away. With a `keeper`, nobody is welcomed
    before their seat is in the store."""

    def __init__(  # noqa: PLR0913 (those who are told of comings and goings count)
        self,
        world: Zone,
        audience: Audience,
        settings: ServerSettings,
        metrics: Metrics,
        welcomes: Welcomes,
        pending: PendingInputs,
        keeper: SeatKeeper | None,
        *,
        greet: Callable[[Session, bool], None],
        leaving: Callable[[Session], None],
        forget: Callable[[int], None],
        arrived: Callable[[Session | None, Person], None],
        names: Names | None = None,
    ) -> None:
        """`greet` is told of each who is welcomed, and whether they came back; `leaving` of a
        session whose connection ends, `forget` of the avatar that it has no more, and `arrived` of
        those who have come from another zone, before they are welcomed. `names` are those of the
        whole world, where there are other zones."""
        self.sessions: dict[int, Session] = {}
        """Sessions that have been welcomed, by their avatar's id."""
        self.seats: Seats[Session] = Seats()
        self._world = world
        self._audience = audience
        self._settings = settings
        self._metrics = metrics
        self._welcomes = welcomes
        self._pending = pending
        self._keeper = keeper
        self._greet = greet
        self._leaving = leaving
        self._forget = forget
        self._arrived = arrived
        self._names = names or Names()
        self._names.reserve(world.actor_names)
        self._arrivals = Arrivals()
        self._newcomers = Newcomers(world, anywhere=settings.crowd is not None)
        metrics.gauge("clients", "People connected", lambda: len(self.sessions))
        metrics.gauge(
            "clients_away", "Avatars that wait for a lost person", lambda: self.seats.vacant
        )
        metrics.gauge("joining", "People who wait to join", lambda: len(self._newcomers))

    # --- coming -------------------------------------------------------------------------------

    def admit(self, session: Session, hello: Hello) -> None:
        """Let a newcomer wait to join, or give a person who comes back their own avatar.

        Raises
        ------
        ProtocolError
            The world is full, or the name is one that nobody may bear.
        """
        seat = self.seats.find(hello.resume) if hello.resume else None
        if seat is not None:
            self._resume(seat, session, hello)
            return
        self._find_room()
        try:
            session.name = self._names.take(hello.name)
        except ReservedNameError as error:
            raise ProtocolError(
                ErrorCode.NAME_RESERVED, str(error), CloseCode.NAME_RESERVED
            ) from None
        self._newcomers.add(session, hello)

    def is_at_the_door(self, session: Session) -> bool:
        """Whether somebody waits to join."""
        return session in self._newcomers

    @property
    def kept_in(self) -> str:
        """The zone that rows of seats in the store name; empty where nothing is kept."""
        return "" if self._keeper is None else self._keeper.zone

    @property
    def people(self) -> int:
        """Those who have a seat, who wait to join, or for whom a place is kept."""
        return len(self.seats) + len(self._newcomers) + len(self._arrivals)

    def joins(self) -> list[Join]:
        """Inputs by which those come in who come from other zones, and a few of those who wait."""
        return [*self._arrivals.joins(), *self._newcomers.joins()]

    def welcome(self, frame: Frame) -> None:
        """Welcome the people whom the tick has let in, before anything else is sent to them."""
        for ticket, avatar_id in frame.joined:
            arrival = self._arrivals.take(ticket)
            if arrival is not None:
                self._take_in(arrival, ticket)
                continue
            session = self._newcomers.let_in(ticket)
            if session is None:
                # The person went while the zone made the avatar.
                self._pending.come(Leave(avatar_id))
                continue
            session.token = self.seats.issue(avatar_id, session.name, session.address, session)
            self.seats.walks_in(avatar_id, session.operator)
            session.avatar_id = avatar_id
            self._keep_new(session, avatar_id)
        for session in self._newcomers.refused():
            self._names.give_back(session.name)
            self._turn_away(session, "nobody can stand where people come in just now; come again")
        for ticket, avatar_id in frame.attached:
            seat = self.seats.of(avatar_id)
            # Somebody else may have come back to the avatar since; the later one has it.
            if seat is not None and seat.occupant is not None and seat.occupant.ticket == ticket:
                self._bind(seat.occupant, avatar_id, resumed=seat.occupant.resumes)

    def confirm(self, session: Session) -> None:
        """Note that a client that came back has its new token, so that the old one is void."""
        session.unconfirmed = False
        seat = None if session.avatar_id is None else self.seats.of(session.avatar_id)
        if seat is not None and seat.occupant is session:
            self.seats.confirm(seat)
            if self._keeper is not None:
                self._keeper.confirm(seat.avatar_id, seat.address, tuple(seat.digests))

    def _resume(self, seat: Seat[Session], session: Session, hello: Hello) -> None:
        before = self.seats.occupy(seat, session, session.address)
        if before is not None:
            self._unbind(seat)
            text = "somebody came in with your resume token"
            farewell = frames.message(Bye(reason=ByeCode.REPLACED, text=text))
            before.dismiss(farewell, CloseCode.REPLACED, ByeCode.REPLACED.value)
        session.avatar_id, session.name = seat.avatar_id, seat.name
        self.seats.walks_in(seat.avatar_id, session.operator)
        session.operator = session.operator or seat.operator
        session.token = self.seats.renew(seat, hello.resume or "")
        session.ticket = self._newcomers.new_ticket()
        session.resumes = True
        if hello.look is not None:
            self._pending.wear(SetLook(seat.avatar_id, hello.look))
        self._pending.come(Detach(seat.avatar_id))
        if self._keeper is None:
            self._pending.come(Attach(seat.avatar_id, session.ticket))
            return
        digests = tuple(seat.digests)
        self._when_kept(self._keeper.change(seat.avatar_id, seat.address, digests), session)

    def _find_room(self) -> None:
        """See to it that one more finds room; takes a vacant seat away for that, if need be.

        Raises
        ------
        ProtocolError
            None is vacant.
        """
        if self.people < self._settings.max_clients:
            return
        seat = self.seats.yielding()
        if seat is None:
            raise ProtocolError(
                ErrorCode.SERVER_FULL,
                f"there is room for {self._settings.max_clients} people, all taken",
                CloseCode.SERVER_FULL,
            )
        self._metrics.seats_yielded.inc()
        self._remove(seat)
        log.info("vacant seat yielded", id=seat.avatar_id, name=seat.name, address=seat.address)

    def _bind(self, session: Session, avatar_id: int, resumed: bool) -> None:
        self._show(session, avatar_id, self._welcomes.frame(session, avatar_id, resumed))
        session.unconfirmed = resumed
        self._greet(session, resumed)
        if session.fault_at_welcome is not None:
            session.tell(session.fault_at_welcome)
        self._metrics.joins.labels("resumed" if resumed else "new").inc()
        log.info("person here", id=avatar_id, name=session.name, resumed=resumed)

    def _show(self, session: Session, avatar_id: int, welcome: bytes) -> None:
        """Let a session look through the eyes of an avatar from now on."""
        self.sessions[avatar_id] = session
        if not session.wants_steps:
            self._audience.send_no_steps(avatar_id)
        session.outbox.welcome(welcome)

    # --- from zone to zone --------------------------------------------------------------------

    def expect(self, arrival: Arrival) -> None:
        """Keep a place for somebody who comes from another zone, and let them in.

        Raises
        ------
        ProtocolError
            There is no room.
        """
        self._find_room()
        self._arrivals.expect(self._newcomers.new_ticket(), arrival)

    def release(self, avatar_id: int, session: Session | None) -> Seat[Session] | None:
        """Take the seat of somebody who goes to another zone out of this one, and the avatar;
        None if it is not that session's any more."""
        seat = self.seats.of(avatar_id)
        if seat is None or seat.occupant is not session:
            return None
        if session is not None:
            self._leaving(session)
        self._unbind(seat)
        self.seats.remove(seat)
        self._pending.come(Leave(seat.avatar_id))
        return seat

    def end_arrivals(self, now_s: float) -> None:
        """Keep no places any more for those whom the zone has not let in for long."""
        for arrival in self._arrivals.end_waiting(now_s):
            arrival.fail("it does not let you in just now")

    def _take_in(self, arrival: Arrival, ticket: int) -> None:
        """Give somebody their seat here, whose avatar has come into the zone."""
        person, session = arrival.release(), arrival.session
        if person is None:
            self._pending.come(Leave(arrival.id))
            return
        digests = list(person.digests)
        seat: Seat[Session] = Seat(
            person.id, person.name, person.address, session, digests, person.operator
        )
        if self._keeper is not None:
            place, own = self._world.where(person.id), tuple(digests)
            kept = KeptSeat(person.id, person.name, person.address, own, place)
            self._keeper.bring(kept, person.kept_in)
        if session is None:
            now_s = asyncio.get_running_loop().time()
            self.seats.restore(seat, now_s - (person.waited_s or 0.0))
            self._arrived(None, person)
            # Nobody looks through these eyes yet.
            self._pending.come(Detach(person.id))
            return
        self.seats.put(seat)
        session.ticket = ticket
        self._arrived(session, person)
        travel = frames.message(Travel(zone=arrival.zone, portal=arrival.portal))
        session.outbox.begin_anew()
        self._show(session, person.id, travel + self._welcomes.frame(session, person.id, False))
        self._greet(session, True)
        self._metrics.joins.labels("travelled").inc()
        log.info("person here", id=person.id, name=person.name, zone=arrival.zone)

    # --- going --------------------------------------------------------------------------------

    def depart(self, session: Session, comes_back: bool, now_s: float) -> None:
        """Let go of a session that has ended; its avatar waits if the person may come back."""
        if self._newcomers.drop(session):
            self._names.give_back(session.name)
        if session.avatar_id is None:
            return
        seat = self.seats.of(session.avatar_id)
        if seat is None or seat.occupant is not session:
            return
        self._leaving(session)
        self._unbind(seat)
        if comes_back and self._settings.resume_seconds > 0.0:
            self.seats.vacate(seat, now_s)
            self._pending.come(Detach(seat.avatar_id))
        else:
            self._remove(seat)
        log.info("person gone", id=seat.avatar_id, name=seat.name, may_come_back=comes_back)

    def end_waiting(self, now_s: float) -> None:
        """Take the avatars away that have waited for their person for too long."""
        for seat in self.seats.vacant_since(now_s - self._settings.resume_seconds):
            self._remove(seat)

    def everyone(self) -> list[Session]:
        """All who are in, and those at the door."""
        return [*self.seats.occupants(), *self._newcomers]

    def give_up(self, session: Session) -> None:
        """Give up the seat of a session: whoever had it comes back as somebody new."""
        seat = None if session.avatar_id is None else self.seats.of(session.avatar_id)
        if seat is not None and seat.occupant is session:
            self._leaving(session)
            self._unbind(seat)
            self._remove(seat)

    def _unbind(self, seat: Seat[Session]) -> None:
        self.sessions.pop(seat.avatar_id, None)
        self._pending.forget(seat.avatar_id)
        self._forget(seat.avatar_id)

    def _remove(self, seat: Seat[Session]) -> None:
        self.seats.remove(seat)
        self._names.give_back(seat.name)
        self._pending.come(Leave(seat.avatar_id))
        if self._keeper is not None:
            self._keeper.remove(seat.avatar_id)

    # --- the store ----------------------------------------------------------------------------

    def save_seats(self) -> dict[str, Any]:
        """The seats there are, and for how long each has waited; their rows say whose they are."""
        now = asyncio.get_running_loop().time()
        given_up = [] if self._keeper is None else self._keeper.given_up
        return {"given_up": given_up, "vacant_s": self.seats.vacant_s(now)}

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
            self.seats.restore(seat, now - waited_s)
        if self._keeper is not None:
            for avatar_id in left.gone:
                self._keeper.remove(avatar_id)

    def _keep_new(self, session: Session, avatar_id: int) -> None:
        """Write the seat of a newcomer, who is welcomed once it is committed."""
        seat = self.seats.of(avatar_id)
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
        seat = None if session.avatar_id is None else self.seats.of(session.avatar_id)
        if seat is None or seat.occupant is not session:
            return
        if is_kept:
            self._pending.come(Detach(seat.avatar_id), Attach(seat.avatar_id, session.ticket))
            return
        text = "your seat cannot be kept just now; come again"
        self._unbind(seat)
        self._remove(seat)
        self._turn_away(session, text)

    def _turn_away(self, session: Session, text: str) -> None:
        """End the session of somebody who cannot come in now, and tell them why."""
        self._metrics.errors.labels(ErrorCode.SERVER_FULL.value).inc()
        farewell = frames.message(Error(error=ErrorCode.SERVER_FULL, text=text))
        session.dismiss(farewell, CloseCode.SERVER_FULL, ErrorCode.SERVER_FULL.value)
