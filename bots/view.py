"""What a bot sees: itself and the others in view, kept up to date."""

from dataclasses import dataclass

from bots.events import SnapshotEvent
from protocol import Kind, Reason
from protocol.messages import Enter, Leave, Welcome
from protocol.snapshot import HEADING_RAD, POSITION_M, SPEED_MPS


@dataclass(slots=True)
class Avatar:
    """An avatar in view as of the newest snapshot. Metres, radians from +x, metres a second."""

    id: int
    kind: Kind
    name: str
    layer: int
    x: float
    y: float
    z: float
    heading: float
    speed: float
    reason: Reason
    radius: float


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

    def enter(self, message: Enter) -> None:
        for entity in message.entities:
            if entity.id != self._own_id:
                self.others[entity.id] = Avatar(
                    entity.id,
                    entity.kind,
                    entity.name,
                    entity.layer,
                    entity.x,
                    entity.y,
                    entity.z,
                    entity.heading,
                    0.0,
                    Reason.NONE,
                    entity.radius,
                )

    def leave(self, message: Leave) -> None:
        for entity_id in message.ids:
            self.others.pop(entity_id, None)

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
            avatar.reason = Reason(reason)
            avatar.x = x0 + x * POSITION_M
            avatar.y = y0 + y * POSITION_M
            avatar.z = z * POSITION_M
            avatar.heading = heading * HEADING_RAD
            avatar.speed = speed * SPEED_MPS
