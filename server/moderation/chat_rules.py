"""Rules of chat that hold for everybody: the pace of lines, words, and zones where it is quiet."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any, Final

from esplanade.server.moderation.areas import Area, Place
from esplanade.server.moderation.words import WordFilter

MOST_ZONES: Final = 64
SLOW: Final = "slow_mode"
WORDS: Final = "word_filter"
ZONE: Final = "quiet_zone:"
"""The names under which the store keeps the rules; that of a zone follows."""


@dataclass(frozen=True)
class ChatRules:
    """The rules at one moment."""

    every_s: float = 0.0
    """The seconds between two lines of one person; 0 for no such rule."""
    words: WordFilter = field(default_factory=WordFilter)
    quiet: Mapping[str, Area] = field(default_factory=dict)
    """Zones by name; whoever stands inside is not heard."""

    def quiet_at(self, place: Place, storeys: Sequence[float]) -> str | None:
        """The name of the zone at a place where nobody is heard."""
        return next((name for name, area in self.quiet.items() if area.holds(place, storeys)), None)

    def with_rule(self, name: str, value: Any) -> "ChatRules":
        """The rules with another one, as plain data; None takes it away."""
        every_s, words, quiet = self.every_s, self.words, dict(self.quiet)
        if name == SLOW:
            every_s = 0.0 if value is None else float(value)
        elif name == WORDS:
            words = WordFilter() if value is None else WordFilter(value["words"], value["action"])
        elif name.startswith(ZONE):
            quiet.pop(name.removeprefix(ZONE), None)
            if value is not None:
                polygon = tuple((float(x), float(y)) for x, y in value["polygon"])
                quiet[name.removeprefix(ZONE)] = Area(polygon, value["storey_m"])
        return ChatRules(every_s, words, quiet)

    def rule(self, name: str) -> Any:
        """A rule as plain data; None where it is not there."""
        if name == SLOW:
            return self.every_s or None
        if name == WORDS:
            if not self.words.words:
                return None
            return {"words": list(self.words.words), "action": self.words.action}
        area = self.quiet.get(name.removeprefix(ZONE))
        return None if area is None else as_data(area)


def as_data(area: Area) -> dict[str, Any]:
    """An area as plain data."""
    found = asdict(area)
    return {"polygon": [list(point) for point in found["polygon"]], "storey_m": found["storey_m"]}
