"""Hops of people from zone to zone, in one process.

The destination keeps a place; its zone makes the avatar; then the seat changes zones in one step,
and the origin takes its avatar out. Whatever ends the hop before that step leaves the person
where they are: a connection that was lost, a seat that was taken over or given up, a destination
that is full or does not answer.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import Final

import structlog

from esplanade.planning import Portal
from esplanade.protocol import NoticeCode, ProtocolError
from esplanade.protocol.messages import Notice
from esplanade.server.copies import Copies
from esplanade.server.metrics import Metrics
from esplanade.server.net import frames
from esplanade.server.net.arrivals import Arrival
from esplanade.server.net.hub import Hub
from esplanade.server.net.person import Person
from esplanade.server.net.session import Session
from esplanade.server.world.routes import Point

LONGEST_S: Final = 5.0
"""A place is kept for so long for somebody whom the zone has not let in yet."""

log = structlog.get_logger(__name__)


@dataclass(frozen=True)
class Doorway:
    """The hub of a zone, or those of its copies."""

    copies: Copies
    hubs: Mapping[str, Hub]
    """The hub of each copy, by its name."""

    def entered(self, wished: str | None = None) -> tuple[str, Hub]:
        """The copy that somebody enters, who may wish for one; the first where all are full."""
        people = {name: hub.people for name, hub in self.hubs.items()}
        name = self.copies.entered(people, wished) or self.copies.names[0]
        return name, self.hubs[name]


@dataclass(frozen=True)
class Destination:
    """A portal of a zone, with the hubs by which one enters the zone."""

    doorway: Doorway
    portal: Portal


class Hops:
    """Lets people go from the zones of one process to others of them."""

    def __init__(self, metrics: Metrics) -> None:
        self._exits: dict[str, Mapping[str, Destination]] = {}
        self._hubs: dict[str, Hub] = {}
        self._ended = metrics.hops

    def join(self, zone: str, hub: Hub, exits: Mapping[str, Destination]) -> None:
        """Let people leave a zone by these exits, by the names of its portals."""
        self._hubs[zone], self._exits[zone] = hub, exits

    def move(
        self, zone: str, origin: Hub, to: Hub, bounds: tuple[float, float, float, float]
    ) -> None:
        """Let everyone of a hub go over to another one of the same zone, whose scene has changed.

        Each stands at the nearest place to where they are now. It is to be called until nobody is
        left.
        """
        for avatar_id, session in origin.send_out():
            arrival = Arrival(
                session,
                avatar_id,
                origin.name_of(avatar_id),
                within(bounds, origin.where(avatar_id)),
                origin.look_of(avatar_id),
                zone,
                "",
                until_s=origin.now_s + LONGEST_S,
                release=partial(origin.release, avatar_id, session),
                fail=partial(_stays, origin, avatar_id),
            )
            try:
                to.expect(arrival)
            except ProtocolError:
                origin.stays(avatar_id)

    def begin(self, zone: str, session: Session, portal: str) -> bool:
        """Ask for a place where a portal of a zone leads to; whether one is kept.

        Somebody who finds none is told so.
        """
        origin, to = self._hubs[zone], self._exits[zone][portal]
        copy, hub = to.doorway.entered()
        avatar_id = session.avatar_id
        if avatar_id is None:
            return False

        def fail(why: str) -> None:
            self._ended.labels("refused").inc()
            origin.stays(avatar_id)
            arguments = {"zone": copy, "why": why}
            text = f"you cannot go to {copy} now: {why}"
            notice = Notice(text=text, notice=NoticeCode.NOT_LET_IN, arguments=arguments)
            session.outbox.post(frames.message(notice))

        def release() -> Person | None:
            person = origin.release(avatar_id, session)
            self._ended.labels("given_up" if person is None else "made").inc()
            return person

        arrival = Arrival(
            session,
            avatar_id,
            session.name,
            to.portal.arrival_place,
            origin.look_of(avatar_id),
            copy,
            to.portal.name,
            until_s=origin.now_s + LONGEST_S,
            release=release,
            fail=fail,
        )
        try:
            hub.expect(arrival)
        except ProtocolError as full:
            fail(full.text)
            return False
        log.info("person goes", id=avatar_id, name=session.name, zone=zone, to=copy)
        return True


def within(bounds: tuple[float, float, float, float], place: Point) -> Point:
    """The place itself, or the nearest to it on the ground plane within bounds, metres."""
    x0, y0, x1, y1 = bounds
    x, y, z_m = place
    return min(max(x, x0), x1), min(max(y, y0), y1), z_m


def _stays(origin: Hub, avatar_id: int, _: str) -> None:
    """Nobody is told of a try that is made again."""
    origin.stays(avatar_id)
