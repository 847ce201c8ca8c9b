"""People of a hosted zone as the parts that look after people know them: told by their gateways."""

import time
from collections.abc import Callable, Iterator, Mapping
from typing import Final

from esplanade.protocol import CloseCode, ErrorCode, ProtocolError
from esplanade.server.accounts.identity import Identity
from esplanade.server.accounts.rights import Right
from esplanade.server.cluster.occupations import Occupations
from esplanade.server.cluster.person_record import PersonRecord
from esplanade.server.cluster.seats import ClusterSeat
from esplanade.server.host.answering import Answering
from esplanade.server.net.operator_keys import operator_of
from esplanade.server.world.zone import Zone

MOST: Final = 8192
"""People who are remembered; of more, those who are not here are forgotten."""


class HostedGuest:
    """Somebody whose avatar is here and whose client is at a gateway."""

    ticket = 0

    def __init__(
        self,
        seat: ClusterSeat,
        record: PersonRecord,
        telling: "Telling",
        last_seqs: Mapping[int, int],
    ) -> None:
        self._seat = seat
        self._record = record
        self._telling = telling
        self._last_seqs = last_seqs
        self.since_us = time.time_ns() // 1000
        self.operator: Identity | None = operator_of(
            record.account, record.address, moves_doors=record.operator
        )

    @property
    def avatar_id(self) -> int | None:
        """The number of the seat."""
        return self._seat.person

    @property
    def name(self) -> str:
        return self._seat.name

    @property
    def wished(self) -> str:
        """The name that the person asked for."""
        return self._record.wished or self._seat.name

    @property
    def address(self) -> str:
        """The key by which limits of the client's address go."""
        return self._record.address

    @property
    def last_seq(self) -> int:
        """The number of the latest movement that came."""
        return self._last_seqs.get(self._seat.person, 0)

    @property
    def is_operator(self) -> bool:
        """Whether the person may move doors."""
        return self.operator is not None and Right.DOORS in self.operator.rights

    @property
    def outbox(self) -> "HostedGuest":
        """The way to the person, which is the gateway's."""
        return self

    def post(self, frame: bytes) -> None:
        """Send a frame that must not be lost."""
        self._telling.post(self._seat.person, frame)

    def unsent(self) -> int:
        """Nothing is known here of what waits at the gateway."""
        return 0

    def tell(self, fault: ProtocolError) -> None:
        """Tell the person of a fault in something that they sent."""
        self._telling.fault(self._seat.person, fault)

    def refuse_line(self, why: str, text: str) -> None:  # noqa: ARG002 - as of a session
        """Tell the person that nobody hears their line of chat."""
        self.tell(ProtocolError(ErrorCode.FLOODING, text, None))

    def dismiss(self, farewell: bytes, code: CloseCode, reason: str) -> None:
        """Have the gateway end the connection, with a last frame."""
        self._telling.dismiss(self._seat.person, farewell, code, reason)


class Telling:
    """Tells people something by the gateways that have their connections."""

    def __init__(self, occupations: Occupations, answering: Answering) -> None:
        self._occupations = occupations
        self._answering = answering

    def post(self, person: int, frame: bytes) -> None:
        """Send a frame to somebody."""
        known = self._occupations.of(person)
        if known is not None and known.gateway is not None:
            self._answering.pass_on(known.gateway, person, known.generation, frame)

    def fault(self, person: int, fault: ProtocolError) -> None:
        """Tell somebody of a fault in something that they sent."""
        known = self._occupations.of(person)
        if known is not None and known.gateway is not None:
            self._answering.tell(known.gateway, person, known.generation, fault)

    def dismiss(self, person: int, farewell: bytes, code: CloseCode, reason: str) -> None:
        """End the connection of somebody."""
        known = self._occupations.of(person)
        if known is not None and known.gateway is not None:
            self._answering.dismiss(known.gateway, person, known.generation, farewell, code, reason)


class Guests(Mapping[int, HostedGuest]):
    """Everyone whose avatar is in the zone and whose client is at a gateway, by their numbers."""

    def __init__(
        self,
        world: Zone,
        occupations: Occupations,
        seat_of: Callable[[int], ClusterSeat | None],
        record_of: Callable[[int], PersonRecord],
        telling: Telling,
    ) -> None:
        self._world = world
        self._occupations = occupations
        self._seat_of = seat_of
        self._record_of = record_of
        self._telling = telling
        self._made: dict[int, HostedGuest] = {}
        self.last_seqs: dict[int, int] = {}
        """The number of each person's latest movement."""

    def __getitem__(self, person: int) -> HostedGuest:
        guest = self.known(person) if self._is_here(person) else None
        if guest is None:
            raise KeyError(person)
        return guest

    def __iter__(self) -> Iterator[int]:
        return iter([person for person in self._occupations if self._is_here(person)])

    def __len__(self) -> int:
        return sum(self._is_here(person) for person in self._occupations)

    def known(self, person: int) -> HostedGuest | None:
        """Somebody whose seat is here, also while nobody steers."""
        seat = self._seat_of(person)
        if seat is None:
            return None
        made = self._made.get(person)
        if made is None:
            if len(self._made) >= MOST:
                self._made = {one: made for one, made in self._made.items() if self._is_here(one)}
            record = self._record_of(person)
            made = HostedGuest(seat, record, self._telling, self.last_seqs)
            self._made[person] = made
        return made

    def forget(self, person: int) -> None:
        """Somebody is gone from the zone."""
        self._made.pop(person, None)
        self.last_seqs.pop(person, None)

    def _is_here(self, person: int) -> bool:
        known = self._occupations.of(person)
        return known is not None and known.gateway is not None and person in self._world.state


class SeatsOfZone:
    """The seats of a zone, for whoever asks by the avatar."""

    def __init__(self, seat_of: Callable[[int], ClusterSeat | None]) -> None:
        self.of = seat_of
