"""The memory of a process before and after, and the bar that its growth is held to."""

from typing import Final, NamedTuple

MEMORY_SHARE: Final = 0.05
"""Memory may grow by this share."""


class Memory(NamedTuple):
    """Resident memory at two moments, MB."""

    before_mb: float = 0.0
    after_mb: float = 0.0

    @property
    def growth(self) -> float:
        """Growth as a share of what it was; 0 where nothing was read."""
        return self.after_mb / self.before_mb - 1.0 if self.before_mb else 0.0

    def __str__(self) -> str:
        percent = 100.0 * self.growth
        return f"memory {self.before_mb:.1f} -> {self.after_mb:.1f} MB ({percent:+.1f} %)"
