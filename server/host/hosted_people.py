"""The people of a zone whose clients are at gateways: who belongs here, and who steers.

Who belongs here is what the seats in the database say; a gateway's word for it only makes the host
look.
"""

from collections.abc import Mapping, Sequence
from functools import partial

import structlog

from esplanade.planning import MovedEnd
from esplanade.protocol import ErrorCode, ProtocolError
from esplanade.protocol.messages import Notice, WalkTo
from esplanade.server.cluster.occupations import Occupations
from esplanade.server.cluster.person_record import PersonRecord, RecordError, decode_record
from esplanade.server.cluster.seats import ClusterSeat
from esplanade.server.host.answering import Answering
from esplanade.server.host.seat_desk import SeatDesk
from esplanade.server.net.moved_goals import notice_of, refusal_of
from esplanade.server.net.pending_inputs import PendingInputs
from esplanade.server.net.route_requests import RouteRequests
from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import (
    Attach,
    Detach,
    Follow,
    Input,
    Join,
    Leave,
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

    # --- who comes and goes -------------------------------------------------------------------

    def is_known(self, person: int) -> bool:
        """Whether somebody has an avatar here, and their seat has been read."""
        return self.occupations.of(person) is not None and person in self._world.state

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
        here = {seat.person for seat in found}
        for seat in found:
            known = self.occupations.of(seat.person)
            if known is None or known.generation < seat.generation:
                self.occupations.restore(seat.person, seat.generation, seat.gateway, now_s)
                if seat.person in self._world.state:
                    self._end(seat.person)
                    self._pending.come(Detach(seat.person), Attach(seat.person, seat.generation))
            self._seats[seat.person] = seat
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
        try:
            record = decode_record(seat.state)
        except RecordError as error:
            log.warning("a seat cannot be read", person=seat.person, error=str(error))
            record = PersonRecord()
        self._records[seat.person] = record
        self._joins[seat.person] = Join(
            seat.generation, seat.name, record.place, record.anywhere, id=seat.person
        )

    def _people(self) -> set[int]:
        state = self._world.state
        return set(state.ids[state.of_kind(PERSON)].tolist())

    def _remove(self, person: int) -> None:
        self._pending.come(Leave(person))
        self._joins.pop(person, None)
        self._records.pop(person, None)
        self._seats.pop(person, None)
        self.leaving.discard(person)
        self.occupations.forget(person)

    def _end(self, person: int) -> None:
        self._routes.forget(person)
        self._pending.forget(person)

    # --- the tick -----------------------------------------------------------------------------

    def drain(self, lines: Sequence[Input], now_s: float) -> list[Input]:
        """Return everything for the next tick, with the lines of chat."""
        for person, generation in self.occupations.silent(now_s).items():
            log.info("person lost", person=person, generation=generation)
            self._end(person)
            self._pending.come(Detach(person))
            self._desk.vacate(person, generation)
        joins, self._joins = list(self._joins.values()), {}
        return self._pending.drain(lines, joins, still=False)

    def told(self, frame: Frame) -> None:
        """Note who has come in with a tick. Whoever has found no room is tried again when the
        seats are read next."""
        for _, person in frame.joined:
            log.info("person here", person=person)

    def route_found(
        self, person: int, wish: WalkTo, route: Route | None, moved: MovedEnd | None
    ) -> None:
        """Send a person along the route that was found, or tell them that there is none."""
        known = self.occupations.of(person)
        if known is None or known.gateway is None:
            return
        tell = partial(self._answering.tell, known.gateway, person, known.generation)
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

    def seat_of(self, person: int) -> ClusterSeat | None:
        """The seat of somebody who belongs here, as it was read last."""
        return self._seats.get(person)

    def record_of(self, person: int) -> PersonRecord:
        """The record of somebody who belongs here."""
        return self._records.get(person, PersonRecord())

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
            self._joins[person] = Join(seat.generation, name, at, anywhere=True, id=person)
        else:
            self._remove(person)
