"""The view of a bot: itself and the others in view, kept up to date."""

from dataclasses import dataclass
from typing import Final

from esplanade.bots.events import SnapshotEvent
from esplanade.protocol import Kind, Reason
from esplanade.protocol.looks import NO_LOOK, Look
from esplanade.protocol.messages import (
    Away,
    Doors,
    Enter,
    Entity,
    Leave,
    Place,
    Point,
    Reshape,
    ServerMessage,
    Welcome,
)
from esplanade.protocol.snapshot import HEADING_RAD, POSITION_M, SPEED_MPS

_REASONS: Final[dict[int, Reason]] = {int(reason): reason for reason in Reason}


@dataclass(slots=True)
class Avatar:
    """An avatar in view as of the newest snapshot. Metres, radians from +x, metres a second."""

    id: int
    kind: Kind | str
    """One of `Kind`, or the name of one that came with a later version; so is `reason`."""
    name: str
    layer: int
    x: float
    y: float
    z: float
    heading: float
    speed: float
    reason: Reason | int
    radius: float
    leg_m: float = 0.0
    """Length of a leg; 0 until it is known."""
    stature_m: float = 0.0
    points_at: Place | None = None
    away: bool = False
    """Whether its person is away."""
    look: Look = NO_LOOK


class View:
    """Everyone in view, by id; fed with messages in the order in which they came."""

    def __init__(self, welcome: Welcome) -> None:
        self._own_id = welcome.id
        self.own = Avatar(
            id=welcome.id,
            kind=Kind.PERSON,
            name=welcome.name,
            layer=0,
            x=0.0,
            y=0.0,
            z=0.0,
            heading=0.0,
            speed=0.0,
            reason=Reason.NONE,
            radius=welcome.radius,
        )
        self.doors = dict(welcome.doors)
        self.others: dict[int, Avatar] = {}
        self.tick = 0
        self.ack = 0
        self.placed = False
        """Whether the own place is known yet."""

    def take(self, message: ServerMessage) -> None:
        """Take in what a message says of those in view and of doors, if it says anything."""
        match message:
            case Enter():
                self.enter(message)
            case Leave():
                self.leave(message)
            case Point():
                self.point(message)
            case Reshape():
                self.reshape(message)
            case Away():
                if message.id in self.others:
                    self.others[message.id].away = message.away
            case Doors():
                self.doors.update(message.doors)

    def enter(self, message: Enter) -> None:
        for entity in message.entities:
            if entity.id == self._own_id:
                self.own.leg_m, self.own.stature_m = entity.leg_m, entity.stature_m
                self.own.look = entity.look
            else:
                self.others[entity.id] = _avatar(entity)

    def leave(self, message: Leave) -> None:
        for entity_id in message.ids:
            self.others.pop(entity_id, None)

    def point(self, message: Point) -> None:
        if message.id in self.others:
            self.others[message.id].points_at = message.target

    def reshape(self, message: Reshape) -> None:
        known = self.own if message.id == self._own_id else self.others.get(message.id)
        if known is not None:
            known.radius = message.radius
            known.leg_m, known.stature_m = message.leg_m, message.stature_m
            known.look = message.look

    def snapshot(self, event: SnapshotEvent) -> None:
        self.tick = event.tick
        self.ack = event.ack
        x0, y0 = event.origin
        for entity_id, layer, reason, x, y, z, heading, speed in event.records.tolist():
            if entity_id == self._own_id:
                avatar = self.own
                self.placed = True
            elif (known := self.others.get(entity_id)) is not None:
                avatar = known
            else:
                continue
            avatar.layer = layer
            avatar.reason = _REASONS.get(reason, reason)
            avatar.x = x0 + x * POSITION_M
            avatar.y = y0 + y * POSITION_M
            avatar.z = z * POSITION_M
            avatar.heading = heading * HEADING_RAD
            avatar.speed = speed * SPEED_MPS


def _avatar(entity: Entity) -> Avatar:
    """An avatar that comes into view."""
    return Avatar(
        id=entity.id,
        kind=entity.kind,
        name=entity.name,
        layer=entity.layer,
        x=entity.x,
        y=entity.y,
        z=entity.z,
        heading=entity.heading,
        speed=0.0,
        reason=Reason.NONE,
        radius=entity.radius,
        leg_m=entity.leg_m,
        stature_m=entity.stature_m,
        points_at=entity.points_at,
        look=entity.look,
    )
