"""The link within one process: lists that are handed over."""

from typing import Final

from esplanade.server.link.link import LinkFullError
from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import Input

MAX_WAITING: Final = 4
"""Batches and frames are made and taken in turns, so that more than one waits only by a fault."""


class LocalLink:
    """Both ends of a link, for one server and a zone in the same process."""

    def __init__(self) -> None:
        self._batches: list[list[Input]] = []
        self._frames: list[Frame] = []

    def send(self, inputs: list[Input]) -> None:
        """Send a batch of inputs for the next tick, in their order."""
        if len(self._batches) >= MAX_WAITING:
            raise LinkFullError(f"the zone took none of the last {MAX_WAITING} batches of inputs")
        self._batches.append(inputs)

    def inputs(self) -> list[Input]:
        """The inputs since the last call."""
        batches, self._batches = self._batches, []
        return [item for batch in batches for item in batch]

    def publish(self, frame: Frame) -> None:
        """Send a frame down."""
        if len(self._frames) >= MAX_WAITING:
            raise LinkFullError(f"nobody took the last {MAX_WAITING} frames")
        self._frames.append(frame)

    def frames(self) -> list[Frame]:
        """The frames since the last call."""
        frames, self._frames = self._frames, []
        return frames
