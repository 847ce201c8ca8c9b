"""Conditions on figures that have to hold for some time on end."""

from dataclasses import dataclass, field
from typing import Any

from esplanade.protocol.commands.conditions import FigureCondition


@dataclass
class Held:
    """A condition, and since when it holds. A figure without a value breaks it off."""

    condition: FigureCondition
    since_s: float | None = field(default=None)

    def update(self, value: float | None, now_s: float) -> bool:
        """Whether the condition has held for its time, with this value of its figure now."""
        if value is None or not self._beyond(value):
            self.since_s = None
            return False
        if self.since_s is None:
            self.since_s = now_s
        return now_s - self.since_s >= self.condition.for_s

    def _beyond(self, value: float) -> bool:
        condition = self.condition
        if condition.above is not None:
            return value > condition.above
        return condition.below is not None and value < condition.below

    def plain(self) -> dict[str, Any]:
        """The condition as plain data."""
        return self.condition.model_dump(mode="json", exclude_none=True)
