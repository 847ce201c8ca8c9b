"""The faults of recordings."""


class ZoneRecordingError(Exception):
    """A recording that cannot be used; the message says what is wrong with it, and where."""
