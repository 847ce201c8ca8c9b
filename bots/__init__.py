"""People made of code: a client library for scripts, load tests, replay of recorded crowds."""

from bots.bot import Bot, connect
from bots.errors import BotError, Disconnected, Refused, Unreachable
from bots.events import Event, SnapshotEvent, StepsEvent
from bots.view import Avatar

__all__ = [
    "Avatar",
    "Bot",
    "BotError",
    "Disconnected",
    "Event",
    "Refused",
    "SnapshotEvent",
    "StepsEvent",
    "Unreachable",
    "connect",
]
