"""Holds a replay against its recording: tick by tick, second by second, field by field."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final

from esplanade.server.recording.digests import differences, digests
from esplanade.server.recording.reader import RecordedSecond, RecordedTick
from esplanade.server.recording.seconds import check_of
from esplanade.server.world.frame import Frame
from esplanade.server.world.zone import Zone

LATER_S: Final = 10
"""Fields are named by the next state in the recording, which comes within so many seconds."""


@dataclass
class Difference:
    """The first difference of a replay from its recording."""

    tick: int
    """The first tick that told something else, or the end of the first second that differs."""
    parts: list[str] = field(default_factory=list)
    """Parts of the state whose digests differ at the end of that second."""
    fields: list[str] = field(default_factory=list)
    """Fields of the state, as far as the recording has one to compare with."""
    fields_tick: int = 0
    exact: bool = True
    """Whether that tick itself differs, and not some tick of the second that ends with it."""

    @property
    def text(self) -> str:
        """The difference in words."""
        where = "tick" if self.exact else "the second that ends with tick"
        text = f"{where} {self.tick} is the first that differs"
        if self.parts:
            text += f", in {', '.join(self.parts)}"
        if self.fields:
            text += f"; at tick {self.fields_tick} these fields differ: {', '.join(self.fields)}"
        return text


class Verifier:
    """Takes ticks and seconds of a replay; `difference` is the first one, if any."""

    def __init__(self, zone: Zone) -> None:
        self._zone = zone
        self.difference: Difference | None = None
        self.seconds = 0
        """Seconds whose digests are equal."""
        self._waits_s = 0

    @property
    def is_done(self) -> bool:
        """Whether nothing that follows tells more of the first difference."""
        found = self.difference
        return found is not None and (bool(found.fields) or self._waits_s > LATER_S)

    def tick(self, recorded: RecordedTick, frame: Frame) -> None:
        """Take in a tick that was run again."""
        if self.difference is None and check_of(frame) != recorded.check:
            self.difference = Difference(recorded.tick)

    def second(self, recorded: RecordedSecond) -> None:
        """Take in the end of a second, of which all ticks were run again."""
        state = self._zone.save_exactly()
        parts = _differing(digests(state), recorded.digests or {})
        found = self.difference
        if found is None and parts:
            found = self.difference = Difference(recorded.last_tick, exact=False)
        if found is None:
            self.seconds += 1
            return
        self._waits_s += 1
        found.parts = found.parts or parts
        if recorded.state is not None and not found.fields:
            found.fields = differences(recorded.state, state)
            found.fields_tick = recorded.last_tick


def _differing(one: Mapping[str, Any], other: Mapping[str, Any]) -> list[str]:
    return [name for name in dict.fromkeys([*one, *other]) if one.get(name) != other.get(name)]
