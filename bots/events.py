"""Events of a bot: the server's messages, snapshots already unpacked."""

from dataclasses import dataclass

from esplanade.protocol.messages import (
    Away,
    Bye,
    Census,
    Chat,
    Doors,
    Enter,
    Error,
    GestureMade,
    Hide,
    Leave,
    Notice,
    Plan,
    Point,
    Pong,
    Reshape,
    Travel,
)
from esplanade.protocol.snapshot import (
    Floats,
    Records,
    headings_rad,
    heights_m,
    positions_m,
    speeds_mps,
)
from esplanade.protocol.steps import StepRecords, Steps, unpack_steps


@dataclass(frozen=True, eq=False)
class SnapshotEvent:
    """The avatars that moved by tick `tick`; `ack` is our newest sequence number that it counted.

    `records` is an array of `esplanade.protocol.snapshot.RECORD`, one row an avatar; avatars
    that are absent are as before.
    """

    tick: int
    ack: int
    records: Records
    origin: tuple[float, float]

    @property
    def positions(self) -> Floats:
        """World positions, float64 (N, 2), metres."""
        return positions_m(self.records, self.origin)

    @property
    def heights(self) -> Floats:
        """Heights of the feet, float64 (N,), metres above the scene's ground."""
        return heights_m(self.records)

    @property
    def headings(self) -> Floats:
        """Headings, float64 (N,), radians from +x."""
        return headings_rad(self.records)

    @property
    def speeds(self) -> Floats:
        """Speeds, float64 (N,), metres a second."""
        return speeds_mps(self.records)


@dataclass(frozen=True, eq=False)
class StepsEvent:
    """The steps of walkers near by: of those who begin one, or have come near in the middle of one.

    `records` is an array of `esplanade.protocol.steps.STEP`, one row a step.
    """

    tick: int
    records: StepRecords

    @property
    def steps(self) -> Steps:
        """The same in world coordinates, metres and radians."""
        return unpack_steps(self.records)


Event = (
    SnapshotEvent
    | StepsEvent
    | Enter
    | Leave
    | Chat
    | Notice
    | Error
    | Bye
    | Pong
    | Plan
    | Census
    | Doors
    | Point
    | Reshape
    | Travel
    | Away
    | GestureMade
    | Hide
)
