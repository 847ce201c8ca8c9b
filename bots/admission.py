"""The token of a bot, as it is shown to a server."""

from esplanade.protocol.messages import Admission


def admission(token: str | None) -> Admission | None:
    """What a bot shows that has a token, or nothing."""
    return Admission(way="bot", secret=token) if token else None
