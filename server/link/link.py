"""The link between a zone and one server of its viewers, whatever carries it."""

from typing import Protocol

from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import Input


class LinkFullError(RuntimeError):
    """The other end does not take what was sent."""


class ZoneLink(Protocol):
    """The server's end: it sends what happened to its people, and takes the zone's frames."""

    def send(self, inputs: list[Input]) -> None:
        """Send a batch of inputs for the next tick, in their order.

        Raises
        ------
        LinkFullError
            Too many batches wait; this one was not taken.
        """

    def frames(self) -> list[Frame]:
        """The frames that have come since the last call, in the order of their ticks."""


class ZoneEnd(Protocol):
    """The zone's end."""

    def inputs(self) -> list[Input]:
        """The inputs that have come since the last call, in the order in which they were sent."""

    def publish(self, frame: Frame) -> None:
        """Send the frame of a tick.

        Raises
        ------
        LinkFullError
            Nobody takes the frames.
        """
