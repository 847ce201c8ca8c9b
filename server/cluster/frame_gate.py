"""A gateway's decision about each frame of a zone: whether it may be applied."""

from enum import Enum, auto


class Verdict(Enum):
    """A gateway's decision about a frame."""

    APPLY = auto()
    DROP = auto()
    """The frame is of an older ownership, or has been seen."""
    RESYNC = auto()
    """Something is missing before it: the whole state of the zone is asked for."""


class FrameGate:
    """Judges the frames of one zone by the epoch of its owner and the tick.

    What a gateway has kept of a zone is worth nothing after a gap, so nothing is applied until the
    whole state has come. Epochs, and within an epoch ticks, never fall.
    """

    def __init__(self) -> None:
        self.epoch = 0
        """The newest ownership from which anything has come; 0 before the first."""
        self.tick: int | None = None
        """The newest tick that was applied; None while the whole state is waited for."""
        self._reached = -1

    def judge(self, epoch: int, tick: int) -> Verdict:
        """Judge a frame that tells what has changed since the tick before it."""
        if epoch < self.epoch:
            return Verdict.DROP
        if epoch > self.epoch:
            self._begin(epoch)
            return Verdict.RESYNC
        if self.tick is None:
            return Verdict.RESYNC
        if tick <= self.tick:
            return Verdict.DROP
        if tick > self.tick + 1:
            self.tick = None
            return Verdict.RESYNC
        self.tick = self._reached = tick
        return Verdict.APPLY

    def whole(self, epoch: int, tick: int) -> Verdict:
        """Judge a whole state of the zone; it is dropped where something newer was applied."""
        if epoch < self.epoch:
            return Verdict.DROP
        if epoch > self.epoch:
            self._begin(epoch)
        if tick < self._reached or self.tick is not None:
            return Verdict.DROP
        self.tick = self._reached = tick
        return Verdict.APPLY

    def lost(self) -> None:
        """Note that frames may be missing: the link to the zone was cut."""
        self.tick = None

    def _begin(self, epoch: int) -> None:
        self.epoch, self.tick, self._reached = epoch, None, -1
