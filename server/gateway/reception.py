"""The reception of a gateway: who comes in, to which zone, who goes, and who has gone elsewhere."""

import asyncio
from collections.abc import Callable, Sequence
from itertools import islice
from typing import Any, Final

import structlog
from nats.aio.client import Client
from nats.aio.msg import Msg

from esplanade.protocol import ByeCode, CloseCode, ErrorCode, ProtocolError
from esplanade.protocol.messages import Bye, Error, Hello
from esplanade.server.accounts.identity import Identity, digest_of
from esplanade.server.cluster.person_record import PersonRecord
from esplanade.server.cluster.seat_records import record_in
from esplanade.server.cluster.seats import ClusterSeat
from esplanade.server.copies import Copies
from esplanade.server.gateway.cluster_seats import ClusterSeats
from esplanade.server.gateway.meshes import Meshes
from esplanade.server.gateway.occupant import Occupant
from esplanade.server.gateway.views import Views, ZonesAwayError
from esplanade.server.gateway.zone_view import ZoneView
from esplanade.server.gateway.zone_wishes import ZoneWishes
from esplanade.server.kept import Kept
from esplanade.server.link.hints import MODERATION
from esplanade.server.link.subjects import Subjects
from esplanade.server.metrics import Metrics
from esplanade.server.moderation.bans import Ban
from esplanade.server.moderation.sharing import SharedModeration
from esplanade.server.net import frames
from esplanade.server.net.banned import check_ban, farewell_of, is_banned, only
from esplanade.server.net.entrance import Entrance
from esplanade.server.net.names import ReservedNameError, check_reserved, like
from esplanade.server.net.operator_keys import (
    SERVICE,
    OperatorKeys,
    TooManyKeysError,
    operator_of,
)
from esplanade.server.net.session import Session
from esplanade.server.net.sockets.reading import Reading
from esplanade.server.settings import ServerSettings
from esplanade.server.store.store import Store, StoreError

BATCH_S: Final = 0.05
"""The time between two batches of wishes of people."""
LOOK_S: Final = 0.1
"""So often the seats of those are read whom no zone shows."""
FAREWELLS: Final = 5
PAUSE_S: Final = 0.1
LAST_S: Final = 20.0
"""When a gateway ends it says goodbye to so many at once, or to more so that it takes no longer
than 20 s, with a pause after them."""
PATIENCE_S: Final = 15.0
"""A newcomer whom no zone has shown by then is sent away; a person who was in is not."""

_REPLACED: Final = frames.message(
    Bye(reason=ByeCode.REPLACED, text="somebody came in with your resume token")
)

log = structlog.get_logger(__name__)


class Reception:
    """Hands each session on to the zone where its seat is, and goes with it where the seat goes."""

    def __init__(
        self,
        gateway: str,
        start: Copies,
        store: Store,
        broker: Client,
        subjects: Subjects,
        settings: ServerSettings,
        metrics: Metrics,
        kept: Kept,
        entrance: Entrance,
        meshes: Meshes,
    ) -> None:
        """`gateway` is the name of this process, `start` the zone that newcomers enter. `store` is
        that of this process alone, `kept` what all processes share."""
        self.views = Views(
            gateway, store, broker, subjects, settings, metrics, meshes, self.depart, self.confirm
        )
        self._gateway = gateway
        self._start = start.names[0]
        self._copies = start if len(start.names) > 1 else None
        self._broker = broker
        self._subjects = subjects
        self._settings = settings
        self._metrics = metrics
        self._seats = ClusterSeats(store, gateway)
        self._directory = kept.directory
        self._moderated = kept.moderation
        self._moderation = SharedModeration(kept.moderation)
        self._entrance = entrance
        self._keys = OperatorKeys(settings.operator_key.get_secret_value(), metrics)
        self._places: dict[Session, tuple[ZoneView, Occupant]] = {}
        self._tasks: set[asyncio.Task[Any]] = set()
        self._reading: Reading | None = None
        self._closing = False
        metrics.gauge("clients", "People connected", lambda: self.people)

    @property
    def people(self) -> int:
        """The people who are connected here."""
        return len(self._places)

    @property
    def hindrance(self) -> str | None:
        """The reason for which nobody should be sent here; None if people may come in."""
        return "stopping" if self._closing else None

    # --- requests of sessions that are in no zone ----------------------------------------------

    @property
    def server_time(self) -> Callable[[], float]:
        """Returns the seconds of the clock of the zone that newcomers enter."""
        view = self.views.get(self._start)
        return (lambda: 0.0) if view is None else view.server_time

    @property
    def wishes(self) -> ZoneWishes:
        """The wishes of those who are in the zone that newcomers enter.

        Raises
        ------
        ProtocolError
            The zone is not there.
        """
        view = self.views.get(self._start)
        if view is None:
            raise ZonesAwayError(self._start)
        return view.wishes

    def read_by(self, reading: Reading | None) -> None:
        """Let what people send be looked for there too, before each batch."""
        self._reading = reading

    def moved(
        self,
        avatar_ids: Sequence[int],
        numbers: Sequence[int],
        directions_rad: Sequence[float],
        speeds_mps: Sequence[float],
    ) -> None:
        """Take movements of many people, each for the zone where the person is."""
        for view in self.views:
            view.wishes.moved(avatar_ids, numbers, directions_rad, speeds_mps)

    def confirm(self, session: Session) -> None:
        """Note that a client has its newest token, so that the old one is void."""
        session.unconfirmed = False
        place = self._places.get(session)
        if place is not None:
            self._seats.confirm(place[1].person, place[1].generation)

    async def receive(self, session: Session, hello: Hello) -> None:
        """Give a person a seat, or the one that they had, and a place in its zone.

        Raises
        ------
        ProtocolError
            They may not come in, or cannot just now.
        """
        if self._closing:
            raise ZonesAwayError(self._start)
        self._check_ban(session, hello)
        session.admitted = await self._entrance.check(
            hello.admission, session.address, session.identity, await self._has_seat(hello)
        )
        session.operator = session.admitted.operator
        try:
            await self._seat(session, hello)
        except ProtocolError:
            await self._entrance.turn_away(session.admitted)
            raise

    async def _seat(self, session: Session, hello: Hello) -> None:
        """Give somebody who may come in a seat, and a place in its zone."""
        self._check_key(session, hello.operator)
        resumed = False
        found: tuple[ClusterSeat, str] | None = None
        if hello.resume:
            keep_us = round(self._settings.resume_seconds * 1e6)
            found = await self._seats.resume(hello.resume, keep_us)
            resumed = found is not None
        if found is None:
            found = await self._take(session, hello)
        seat, session.token = found
        session.name, session.resumes = seat.name, resumed
        now_s = asyncio.get_running_loop().time()
        record = record_in(seat)
        if resumed and record.account and session.operator is None:
            session.operator = await self._again(record)
        who = Occupant(seat.person, seat.generation, session, record, resumed, now_s)
        who.look = hello.look if resumed else None
        try:
            view = await self.views.opened(seat.zone)
            self._check_ban(session, hello)  # one may have come to hold meanwhile
        except ProtocolError:
            if not resumed:
                await self._seats.leave(seat.person, seat.generation)
            raise
        if not self._replace(who):
            session.dismiss(_REPLACED, CloseCode.REPLACED, ByeCode.REPLACED.value)
            return
        self._places[session] = view, who
        view.add(who)

    def depart(self, session: Session, comes_back: bool) -> None:
        """Let go of a session that has ended."""
        self._entrance.end(session.admitted)
        place = self._places.pop(session, None)
        if place is not None:
            view, who = place
            view.remove(who, comes_back=comes_back)
            log.info("person gone", person=who.person, may_come_back=comes_back)

    async def _take(self, session: Session, hello: Hello) -> tuple[ClusterSeat, str]:
        """Make a seat for a newcomer, where there is room."""
        try:
            check_reserved(hello.name)
        except ReservedNameError as error:
            raise ProtocolError(
                ErrorCode.NAME_RESERVED, str(error), CloseCode.NAME_RESERVED
            ) from None
        view = await self.views.opened(self._start)
        if len(self._places) >= self._settings.max_clients:
            raise _full(self._settings.max_clients)
        if self._copies is None and view.people >= view.most_people:
            raise _full(view.most_people)
        record = PersonRecord(
            address=session.address,
            place=hello.at,
            anywhere=session.is_operator,
            operator=session.is_operator,
            account=_account_of(session),
            wished=session.wished,
            look=tuple(hello.look or ()),
        )
        names, copies = like(hello.name), self._copies
        if copies is None:
            return await self._seats.take(self._start, names, record)
        found = await self._seats.take_in(copies, session.wished_zone, names, record)
        if found is None:
            raise _full(copies.most_people * len(copies.names))
        return found

    def _replace(self, who: Occupant) -> bool:
        """Part with a session of this gateway whose seat this one has taken; False if that one has
        taken it later."""
        for view in self.views:
            other = view.occupants.get(who.person)
            if other is None:
                continue
            if other.generation > who.generation:
                return False
            self._places.pop(other.session, None)
            view.replaced(other)
        return True

    def _check_ban(self, session: Session, hello: Hello) -> None:
        moderated = self._moderated
        now_us = moderated.now_us()
        check_ban(moderated.bans, now_us, hello.name, session.address, hello.resume)

    async def _has_seat(self, hello: Hello) -> bool:
        """Whether somebody comes back to a seat; only those are asked about whom it concerns."""
        if not hello.resume or not (self._settings.closed or hello.admission is not None):
            return False
        keep_us = round(self._settings.resume_seconds * 1e6)
        return await self._seats.has(hello.resume, keep_us)

    async def _again(self, record: PersonRecord) -> Identity | None:
        """The operator who comes back to an avatar, with the rights that the account has now."""
        operator = operator_of(record.account, record.address, moves_doors=record.operator)
        try:
            return None if operator is None else await self._directory.again(operator)
        except StoreError as error:
            log.warning("an operator comes back without rights", why=str(error))
            return None

    def _turn_out(self, ban: Ban, person: int | None) -> int:
        """Send those of this gateway out whom a ban is of, in whatever zone they are."""
        alone, now_us = only(ban), self._moderated.now_us()
        found = []
        for session, (_, who) in self._places.items():
            names = session.wished, session.name
            digests = [] if not session.token else [digest_of(session.token)]
            is_meant = is_banned(alone, now_us, names, session.address, digests)
            if is_meant or who.person == person:
                found.append(session)
        for session in found:
            self.depart(session, comes_back=False)
            session.dismiss(farewell_of(ban), CloseCode.BANNED, ByeCode.BANNED.value)
        return len(found)

    def _check_key(self, session: Session, key: str | None) -> None:
        now_s = asyncio.get_running_loop().time()
        try:
            if self._keys.opens(key, session.address, now_s):
                session.operator = session.operator or SERVICE
        except TooManyKeysError as error:
            session.fault_at_welcome = ProtocolError(ErrorCode.KEY_UNREAD, str(error), None)

    # --- the whole gateway --------------------------------------------------------------------

    async def run(self) -> None:
        """Send what people want, and look after those whom no zone shows, until cancelled."""
        answers = await self._broker.subscribe(
            self._subjects.gateway(self._gateway), cb=self.views.answered
        )
        hints = await self._broker.subscribe(self._subjects.control, cb=self._hear)
        self._begin(self._seats.run())
        self._begin(self._look())
        self._begin(self._moderation.run())
        self._moderated.turns_out.append(self._turn_out)
        loop = asyncio.get_running_loop()
        due = loop.time()
        try:
            while True:
                due = max(due + BATCH_S, loop.time())
                await asyncio.sleep(due - loop.time())
                if self._reading is not None:
                    self._reading.deliver()
                    self._reading.tell_heard()
                await self.views.send()
        finally:
            self._moderated.turns_out.remove(self._turn_out)
            if not self._broker.is_closed:
                await answers.unsubscribe()
                await hints.unsubscribe()

    async def _hear(self, message: Msg) -> None:
        if message.data == MODERATION:
            self._moderation.hear()

    async def close(self) -> None:
        """Say goodbye to everyone, who may come back at another gateway, and stop.

        A crowd goes bit by bit, so that it does not come to the others all at once.
        """
        self._closing = True
        text = "this gateway is shutting down; come again"
        farewell = frames.message(Bye(reason=ByeCode.SHUTDOWN, text=text))
        ending = []
        together = max(FAREWELLS, -(-len(self._places) * PAUSE_S // LAST_S))
        while leaving := list(islice(self._places, int(together))):
            for session in leaving:
                self.depart(session, comes_back=True)
                ending.append(session.dismiss(farewell, CloseCode.GOING_AWAY, text))
            await self.views.send()
            if self._places:
                await asyncio.sleep(PAUSE_S)
        if ending:
            await asyncio.wait(ending)
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        await self.views.close()

    # --- seats that are elsewhere -------------------------------------------------------------

    async def _look(self) -> None:
        """Go with those whom their zone shows no more to where their seats are."""
        while True:
            await asyncio.sleep(LOOK_S)
            now_s = asyncio.get_running_loop().time()
            missing = [
                (view, who) for view in self.views for who in view.missing(now_s - LOOK_S / 2)
            ]
            if not missing:
                continue
            try:
                found = await self._seats.of([who.person for _, who in missing])
            except StoreError as error:
                log.debug("seats are not found", why=str(error))
                await asyncio.sleep(5 * LOOK_S)
                continue
            for view, who in missing:
                await self._follow(view, who, found.get(who.person), now_s)

    async def _follow(
        self, view: ZoneView, who: Occupant, seat: ClusterSeat | None, now_s: float
    ) -> None:
        if self._places.get(who.session) != (view, who):
            return
        if seat is None or seat.generation != who.generation:
            del self._places[who.session]
            if seat is not None:
                view.replaced(who)
                return
            view.hand_over(who)
            text = "your seat has been given up"
            farewell = frames.message(Bye(reason=ByeCode.SILENT, text=text))
            who.session.dismiss(farewell, CloseCode.SILENT, ByeCode.SILENT.value)
        elif seat.zone != view.zone:
            try:
                there = await self.views.opened(seat.zone)
            except ProtocolError:
                return  # it is tried again
            who.record = record_in(seat).model_copy(
                update={"muted": tuple(view.muted_by(who.person))}
            )
            view.hand_over(who)
            self._places[who.session] = there, who
            who.since_s = now_s
            there.add(who)
        elif not who.is_in and now_s - who.since_s > PATIENCE_S:
            away = ZonesAwayError(view.zone)
            self.depart(who.session, comes_back=True)
            farewell = frames.message(Error(error=away.code, text=away.text))
            who.session.dismiss(farewell, CloseCode.BUSY, away.code.value)

    def _begin(self, work: Any) -> None:
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._ended)

    def _ended(self, task: "asyncio.Task[Any]") -> None:
        self._tasks.discard(task)
        if not task.cancelled() and (error := task.exception()) is not None:
            log.error("a part of the gateway has failed", exc_info=error)


def _full(most_people: int) -> ProtocolError:
    text = f"there is room for {most_people} people, all taken"
    return ProtocolError(ErrorCode.SERVER_FULL, text, CloseCode.SERVER_FULL)


def _account_of(session: Session) -> str:
    """The account of an operator who walks in as oneself; empty for everybody else."""
    operator = session.operator
    return "" if operator is None or operator.via != "pass" else operator.account or ""
