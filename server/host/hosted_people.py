"""The people of a zone whose clients are at gateways: who belongs here, and who steers.

Who belongs here is what the seats in the database say; a gateway's word for it only makes the host
look.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import partial

import structlog

from esplanade.planning import MovedEnd
from esplanade.protocol import ErrorCode, ProtocolError
from esplanade.protocol.looks import Look, known_look
from esplanade.protocol.messages import Notice, WalkTo
from esplanade.server.cluster.occupations import Occupations
from esplanade.server.cluster.person_record import PersonRecord, encode_record
from esplanade.server.cluster.seat_records import record_in
from esplanade.server.cluster.seats import ClusterSeat
from esplanade.server.host.answering import Answering
from esplanade.server.host.guests import Guests, HostedGuest, Telling
from esplanade.server.host.host_moderation import HostModeration
from esplanade.server.host.seat_desk import SeatDesk
from esplanade.server.net.moved_goals import notice_of, refusal_of
from esplanade.server.net.pending_inputs import PendingInputs
from esplanade.server.net.route_requests import RouteRequests
from esplanade.server.net.walk_outs import WalkOuts
from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import (
    Attach,
    Detach,
    Follow,
    Input,
    Join,
    Leave,
    SetLook,
)
from esplanade.server.world.routes import Point, Route
from esplanade.server.world.state import PERSON
from esplanade.server.world.zone import Zone

log = structlog.get_logger(__name__)


class HostedPeople:
    """Takes what gateways say of people and what the database says of their seats, and makes
    inputs of the next tick of it."""

    def __init__(
        self,
        world: Zone,
        routes: RouteRequests,
        pending: PendingInputs,
        desk: SeatDesk,
        answering: Answering,
    ) -> None:
        self.occupations = Occupations()
        self.leaving: set[int] = set()
        """Those who stand in a portal until the other zone has a place for them."""
        self._moving: dict[int, ClusterSeat] = {}
        """Those whose seats are being moved, and who are shown by no zone meanwhile."""
        self._world = world
        self._routes = routes
        self._pending = pending
        self._desk = desk
        self._answering = answering
        self._joins: dict[int, Join] = {}
        self._records: dict[int, PersonRecord] = {}
        self._seats: dict[int, ClusterSeat] = {}
        self._expelled: set[int] = set()
        """Those who were sent out, and whose seats may be found yet."""
        self.guests = Guests(
            world,
            self.occupations,
            self.seat_of,
            self.record_of,
            Telling(self.occupations, answering),
        )
        """Those whose avatars are here, as the parts that look after people know them."""
        self.moderation: HostModeration | None = None
        """Looks after them for operators."""
        self.welcomed: list[Callable[[HostedGuest], None]] = []
        """Called with each who has come in, or has come back."""

    # --- who comes and goes -------------------------------------------------------------------

    def is_known(self, person: int) -> bool:
        """Whether somebody has an avatar here, and their seat has been read."""
        return self.occupations.of(person) is not None and person in self._world.state

    @property
    def walk_outs(self) -> WalkOuts | None:
        """Those who are being walked out by operators."""
        return None if self.moderation is None else self.moderation.walk_outs

    def is_walked_out(self, person: int) -> bool:
        """Whether operators have somebody walk to the way out."""
        return self.walk_outs is not None and person in self.walk_outs

    def is_led(self, person: int) -> bool:
        """Whether somebody goes where they are sent, and not where they want."""
        return person in self.leaving or self.is_walked_out(person)

    def look(self) -> None:
        """Read the seats soon, since a gateway says that somebody belongs here."""
        self._desk.look()

    def attach(self, person: int, generation: int, gateway: str, now_s: float) -> None:
        """Let a client look and steer who has taken the seat later than the one before."""
        if self.occupations.attach(person, generation, gateway, now_s):
            self._end(person)
            self._pending.come(Detach(person), Attach(person, generation))

    def present(self, gateway: str, held: Mapping[int, int], now_s: float) -> None:
        """Take in whom a gateway still serves, with the generation of each."""
        for person in self.occupations.present(gateway, held, now_s):
            self._desk.reoccupy(person, held[person], gateway)

    def depart(self, person: int, generation: int, *, comes_back: bool) -> None:
        """Let somebody go whose connection has ended, if nobody has taken the seat since."""
        if not self.occupations.detach(person, generation):
            return
        self._end(person)
        if comes_back:
            self._pending.come(Detach(person))
            self._desk.vacate(person, generation)
        else:
            self._remove(person)
            self._desk.leave(person, generation)

    # --- what the seats say -------------------------------------------------------------------

    def take_seats(self, found: list[ClusterSeat], now_s: float) -> None:
        """Take in all seats of the zone: those belong here who have one, and nobody else."""
        self._expelled &= {seat.person for seat in found}
        found = [seat for seat in found if seat.person not in self._expelled]
        here = {seat.person for seat in found}
        for seat in found:
            known = self.occupations.of(seat.person)
            if known is None or known.generation < seat.generation:
                self.occupations.restore(seat.person, seat.generation, seat.gateway, now_s)
                if seat.person in self._world.state:
                    self._end(seat.person)
                    self._pending.come(Detach(seat.person), Attach(seat.person, seat.generation))
            self._seats[seat.person] = seat
            if seat.person not in self._records:
                self._records[seat.person] = record_in(seat)
            is_known = seat.person in self._world.state or seat.person in self._moving
            if not is_known and seat.person not in self._joins:
                self._join(seat)
        for person in self._people() - here:
            self.gone(person)

    def gone(self, person: int) -> None:
        """Take out somebody whose seat is not here any more."""
        self._end(person)
        self._remove(person)

    def _join(self, seat: ClusterSeat) -> None:
        record = self.record_of(seat.person)
        if record.silent_s and self.moderation is not None:
            self.moderation.mutes.put(seat.person, record.silent_s)
        self._joins[seat.person] = Join(
            seat.generation,
            seat.name,
            record.place,
            record.anywhere,
            id=seat.person,
            look=known_look(record.look),
        )

    def _people(self) -> set[int]:
        state = self._world.state
        return set(state.ids[state.of_kind(PERSON)].tolist())

    def _remove(self, person: int) -> None:
        self._pending.come(Leave(person))
        self._joins.pop(person, None)
        guest = self.guests.known(person)
        if guest is not None and self.moderation is not None:
            self.moderation.remember(guest)
        self.guests.forget(person)
        self._records.pop(person, None)
        self._seats.pop(person, None)
        self.leaving.discard(person)
        self.occupations.forget(person)

    def _end(self, person: int) -> None:
        self._routes.forget(person)
        self._pending.forget(person)

    # --- the tick -----------------------------------------------------------------------------

    def drain(self, lines: Sequence[Input], now_s: float, *, still: bool = False) -> list[Input]:
        """Return everything for the next tick, with the lines of chat.

        For a `still` tick, in which nobody moves, movements wait for the next one.
        """
        if self.walk_outs is not None:
            self.walk_outs.check(now_s)
        for person, generation in self.occupations.silent(now_s).items():
            log.info("person lost", person=person, generation=generation)
            self._end(person)
            self._pending.come(Detach(person))
            self._desk.vacate(person, generation)
        joins, self._joins = list(self._joins.values()), {}
        return self._pending.drain(lines, joins, still=still)

    def told(self, frame: Frame) -> None:
        """Note who has come in with a tick. Whoever has found no room is tried again when the
        seats are read next."""
        for _, person in frame.joined:
            log.info("person here", person=person)
        for _, person in (*frame.joined, *frame.attached):
            guest = self.guests.get(person)
            if guest is not None:
                for welcome in self.welcomed:
                    welcome(guest)

    def route_found(
        self, person: int, wish: WalkTo, route: Route | None, moved: MovedEnd | None
    ) -> None:
        """Send a person along the route that was found, or tell them that there is none."""
        known = self.occupations.of(person)
        if known is None or known.gateway is None:
            return
        tell = partial(self._answering.tell, known.gateway, person, known.generation)
        if self.walk_outs is not None and self.is_walked_out(person):
            self.walk_outs.route_found(person, route)
            return
        if route is not None:
            self._pending.move(Follow(person, wish.seq, route))
            if moved is not None:
                notice = notice_of(wish, moved)
                self._answering.post(known.gateway, person, known.generation, notice)
        elif moved is not None and wish.strict:
            tell(refusal_of(wish, moved))
        else:
            text = f"no way leads to ({wish.x:.2f}, {wish.y:.2f}, {wish.z:.2f})"
            tell(ProtocolError(ErrorCode.NO_PATH, text, None))

    # --- from zone to zone --------------------------------------------------------------------

    def mute(self, person: int, muted: tuple[int, ...]) -> None:
        """Note whom somebody does not want to hear, in the seat too; it may come again."""
        record = self.record_of(person)
        if person in self._seats and record.muted != muted:
            self._records[person] = record = record.model_copy(update={"muted": muted})
            self._desk.keep(person, encode_record(record))

    def wear(self, person: int, look: Look) -> None:
        """Let somebody look otherwise, and note it in the seat too; it may come again."""
        record = self.record_of(person)
        if person in self._seats and record.look != look:
            self._records[person] = record = record.model_copy(update={"look": tuple(look)})
            self._desk.keep(person, encode_record(record))
        if person in self._world.state and self._world.state.look(person) != look:
            self._pending.wear(SetLook(person, look))

    def expel(self, person: int) -> None:
        """Send somebody out for good, whoever has taken the seat last."""
        self._expelled.add(person)
        self._desk.expel(person)
        self.gone(person)

    def seat_of(self, person: int) -> ClusterSeat | None:
        """The seat of somebody who belongs here, as it was read last."""
        return self._seats.get(person)

    def record_of(self, person: int) -> PersonRecord:
        """The record of somebody who belongs here."""
        return self._records.get(person, PersonRecord())

    def record_to_go(self, person: int) -> PersonRecord:
        """The record of somebody as it is to be in the zone to which they go."""
        record = self.record_of(person)
        if self.moderation is None:
            return record
        return record.model_copy(update={"silent_s": self.moderation.muted_s(person)})

    def steered(self) -> set[int]:
        """Those whose clients are there, and who have an avatar."""
        found = set()
        for person in self._people():
            known = self.occupations.of(person)
            if known is not None and known.gateway is not None and person in self._seats:
                found.add(person)
        return found

    def leave_by(self, person: int) -> None:
        """Let somebody stand who goes to another zone."""
        self.leaving.add(person)
        self._routes.forget(person)
        self._pending.stand(person)

    def stay(self, person: int, why: Notice) -> None:
        """Let somebody move again who was not let in elsewhere, and tell them why."""
        self.leaving.discard(person)
        known = self.occupations.of(person)
        if known is not None and known.gateway is not None:
            self._answering.post(known.gateway, person, known.generation, why)

    def hide(self, person: int) -> None:
        """Show somebody no more while nobody knows whose they are."""
        seat = self._seats.get(person)
        if seat is not None:
            self._moving[person] = seat
            self._end(person)
            self._pending.come(Leave(person))

    def moved(self, person: int, *, is_here: bool, at: Point) -> None:
        """Take in what became of a seat: whoever is here yet stands where they were."""
        seat = self._moving.pop(person, None)
        self.leaving.discard(person)
        if is_here and seat is not None:
            name = seat.name
            look = known_look(self.record_of(person).look)
            self._joins[person] = Join(
                seat.generation, name, at, anywhere=True, id=person, look=look
            )
        else:
            self._remove(person)
