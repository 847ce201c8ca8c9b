"""The faults of recordings."""


class ZoneRecordingError(Exception):
    """A recording that cannot be used; the message says what is wrong with it, and where."""


class NotRecordedError(Exception):
    """The world cannot be recorded; the message says why."""
