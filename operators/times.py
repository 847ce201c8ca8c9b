"""Moments as people read them."""

from datetime import UTC, datetime


def at_time(at_us: int | None) -> str:
    """A moment for people, in UTC."""
    if at_us is None:
        return ""
    return datetime.fromtimestamp(at_us / 1e6, UTC).strftime("%Y-%m-%d %H:%M:%SZ")
