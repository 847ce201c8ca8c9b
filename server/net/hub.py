"""The hub joins sessions and the world: who comes and goes, and what the next tick is given."""

import asyncio
from collections.abc import Callable, Mapping
from typing import Any

from esplanade.protocol import ByeCode, CloseCode, ErrorCode, ProtocolError
from esplanade.protocol.looks import Look
from esplanade.protocol.messages import Bye, Hello
from esplanade.server.checkpoint.returning import Left
from esplanade.server.checkpoint.seat_keeper import SeatKeeper
from esplanade.server.metrics import Metrics
from esplanade.server.moderation.state import ModerationState
from esplanade.server.net import frames
from esplanade.server.net.arrivals import Arrival
from esplanade.server.net.chat_gate import ChatGate
from esplanade.server.net.departures import Departures
from esplanade.server.net.entrance import Entrance
from esplanade.server.net.leases import ANSWER_S, PING_S, Leases
from esplanade.server.net.moderation import PeopleModeration
from esplanade.server.net.operator_keys import SERVICE, OperatorKeys, TooManyKeysError
from esplanade.server.net.pace_notices import PaceNotices
from esplanade.server.net.pending_inputs import PendingInputs
from esplanade.server.net.person import Person
from esplanade.server.net.reporting import Reporting
from esplanade.server.net.route_requests import RouteRequests
from esplanade.server.net.seating import Seating
from esplanade.server.net.session import Session
from esplanade.server.net.sockets.reading import Reading
from esplanade.server.net.surroundings import Surroundings
from esplanade.server.net.waiting_lines import WaitingLines
from esplanade.server.net.walk_outs import WalkOuts
from esplanade.server.net.welcomes import Welcomes
from esplanade.server.net.wishes import Wishes
from esplanade.server.settings import ServerSettings
from esplanade.server.world.audience import Audience
from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import Input
from esplanade.server.world.pace import Pace
from esplanade.server.world.routes import Point
from esplanade.server.world.zone import Zone


class Hub:
    """All sessions of a zone.

    Who has a seat is the business of `Seating`, what they want that of `Wishes`; what waits for the
    next tick is in `PendingInputs`, which `drain` hands to the tick. `derived` holds the facts of
    the scene that a welcome adds to those in the scene's file.
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
        surroundings: Surroundings | None = None,
    ) -> None:
        """The `entrance` is told of those who go. With a `keeper`, nobody is welcomed before their
        seat is in the store. Without `surroundings`, the zone is the whole world.
        """
        self.server_time = server_time
        self._world = world
        self._audience = audience
        self._routes = route_requests
        self._pending = PendingInputs(metrics, self._unread)
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
            arrived=self._arrived,
            names=None if surroundings is None else surroundings.names,
        )
        self.sessions = self._seating.sessions
        """Sessions that have been welcomed, by their avatar's id."""
        self._leases = Leases(world.moves, self._listen)
        self.reading: Reading | None = None
        """Reads what people send, where the event loop alone does not."""
        self._operator_keys = OperatorKeys(settings.operator_key.get_secret_value(), metrics)
        storeys = _storeys(derived)
        self.moderation = PeopleModeration(
            moderated,
            world,
            storeys,
            self.sessions,
            self._seating.seats,
            lambda person: self._seating.give_up(self.sessions[person]),
            lambda: self.now_s,
            0 if surroundings is None else surroundings.first_line,
        )
        self._entrance = entrance
        self._pace = pace or Pace()
        self._pace_notices = PaceNotices(self.sessions, server_time)
        self._pace.changed.append(self._pace_notices.tell_all)
        self._walk_outs = self.moderation.walk_outs = WalkOuts(
            world,
            self.sessions,
            route_requests,
            lambda movement: self.wishes.want(movement),  # noqa: PLW0108 - made below
            self.moderation.has_walked_out,
        )
        self._departures = Departures(world, self.sessions)
        if surroundings is not None:
            self._departures.open(surroundings.portals, surroundings.go)
        self._lines = WaitingLines(
            self.moderation, ChatGate(moderated, storeys), self._seating.is_at_the_door, metrics
        )
        self.wishes = Wishes(
            world,
            audience,
            route_requests,
            self._pending,
            self.sessions,
            self.moderation,
            self._walk_outs,
            self._departures,
            self._lines,
            Reporting(moderated, self.moderation),
        )
        """Wishes of the people who have a seat."""
        metrics.gauge("frames_waiting", "Frames that wait for slow clients", self._frames_waiting)

    # --- coming and going ---------------------------------------------------------------------

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

    def has_seat(self, token: str) -> bool:
        """Whether a token takes a seat in this zone."""
        return self._seating.seats.find(token) is not None

    @property
    def people(self) -> int:
        """Those who are in, who wait to come in, and for whom a place is kept."""
        return self._seating.people

    @property
    def now_s(self) -> float:
        """Seconds of the event loop."""
        return asyncio.get_running_loop().time()

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
        self.moderation.close()
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
        self._departures.forget(avatar_id)
        self.moderation.lines.forget(avatar_id)

    def _run_for_s(self, now: float) -> float:
        """A clock that stands while the world does: nobody's seat is lost in a pause."""
        return now - self._pace.standing_s(now)

    # --- from zone to zone --------------------------------------------------------------------

    def expect(self, arrival: Arrival) -> None:
        """Keep a place for somebody who comes from another zone, and let them in.

        Raises
        ------
        ProtocolError
            There is no room.
        """
        self._seating.expect(arrival)

    def release(self, avatar_id: int, session: Session | None) -> Person | None:
        """Let somebody out to another zone; None if they do not go any more."""
        if avatar_id not in self._departures or avatar_id in self._walk_outs:
            return None
        muted = self.moderation.lines.muted_by(avatar_id)
        silent_s = self.moderation.mutes.left_s(avatar_id)
        since_s = self._seating.seats.vacant_from(avatar_id)
        seat = self._seating.release(avatar_id, session)
        if seat is None:
            return None
        self.moderation.mutes.put(avatar_id, 0.0)
        return Person(
            avatar_id,
            seat.name,
            seat.address,
            tuple(seat.digests),
            seat.operator,
            muted,
            None if since_s is None else self._run_for_s(self.now_s) - since_s,
            silent_s,
            self._seating.kept_in,
        )

    def where(self, avatar_id: int) -> Point:
        """Where somebody who has a seat is, x, y and height, metres."""
        return self._world.where(avatar_id)

    def name_of(self, avatar_id: int) -> str:
        """The name of somebody who has a seat."""
        return self._world.state.names[self._world.state.slot(avatar_id)]

    def look_of(self, avatar_id: int) -> Look:
        """The look of somebody who has a seat."""
        return self._world.state.look(avatar_id)

    def stays(self, avatar_id: int) -> None:
        """Let somebody walk on in this zone whom another one does not let in."""
        self._departures.stay(avatar_id)

    def close_exits(self) -> None:
        """Let nobody go through portals any more."""
        self._departures.open((), None)

    def send_out(self) -> list[tuple[int, Session | None]]:
        """Let everyone who is in stand and go; returns the avatars, and the sessions of those that
        have one. Call it again until nobody is left."""
        found = []
        for seat in self._seating.seats.all():
            if seat.avatar_id not in self._departures and seat.avatar_id not in self._walk_outs:
                self._departures.go(seat.avatar_id)
                self._routes.forget(seat.avatar_id)
                self._pending.stand(seat.avatar_id)
                found.append((seat.avatar_id, seat.occupant))
        return found

    def _arrived(self, session: Session | None, person: Person) -> None:
        """Take in all that goes along with somebody who comes from another zone."""
        if session is not None:
            session.enter(self)
            session.watching = None
        self._departures.arrived(person.id)
        self.moderation.mutes.put(person.id, person.silent_s)
        for speaker in person.muted:
            self.moderation.lines.mute(person.id, speaker, muted=True)

    def _check_departures(self) -> None:
        """Let those stand who go to another zone, and keep no places for long."""
        for avatar_id in self._departures.check(self._walk_outs.__contains__):
            self._routes.forget(avatar_id)
            self._pending.stand(avatar_id)
        self._seating.end_arrivals(self.now_s)

    # --- requests of the tick -----------------------------------------------------------------

    def drain(self, now: float, *, still: bool = False) -> list[Input]:
        """Return everything for the next tick: at most one movement a person, and a few joins.

        For a `still` tick, in which nobody moves, movements wait for the next one.
        """
        if self.reading is not None:
            self.reading.deliver()
        self._seating.end_waiting(self._run_for_s(now))
        self._check_leases(now)
        self._walk_outs.check(now)
        self._check_departures()
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

    def _listen(self) -> None:
        if self.reading is not None:
            self.reading.tell_heard()

    def _unread(self) -> int:
        """Movements of these sessions that wait where they were read."""
        return (
            0
            if self.reading is None
            else sum(map(self.sessions.__contains__, self.reading.waiting()))
        )

    def _frames_waiting(self) -> int:
        return sum(session.outbox.waiting for session in self.sessions.values())


def _storeys(derived: Mapping[str, object]) -> list[float]:
    """The heights of the storeys among the facts that are derived from a scene."""
    found = derived.get("storeys", ())
    return [float(height) for height in found] if isinstance(found, list | tuple) else []
