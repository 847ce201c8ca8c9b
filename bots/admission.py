"""The token of a bot, as it is shown to a server."""

from esplanade.protocol.messages import Admission


def admission(token: str | None) -> Admission | None:
    """The admission of a bot that has a token; None for others."""
    return Admission(way="bot", secret=token) if token else None
