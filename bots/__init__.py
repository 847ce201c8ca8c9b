"""People made of code: a client library for scripts, load tests, replay of recorded crowds."""

from esplanade.bots.bot import Bot, connect
from esplanade.bots.errors import BotError, Disconnected, Refused, Unreachable
from esplanade.bots.events import Event, SnapshotEvent, StepsEvent
from esplanade.bots.view import Avatar

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
