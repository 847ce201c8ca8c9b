"""Bots are people made of code: a client library, load tests, replay of recorded crowds.

Names are imported when they are first asked for: the command explains its options without them.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from esplanade.bots.bot import Bot, connect
    from esplanade.bots.errors import BotError, Disconnected, Refused, TimedOut, Unreachable
    from esplanade.bots.events import Event, SnapshotEvent, StepsEvent
    from esplanade.bots.scenario import Scenario
    from esplanade.bots.view import Avatar

__all__ = [
    "Avatar",
    "Bot",
    "BotError",
    "Disconnected",
    "Event",
    "Refused",
    "Scenario",
    "SnapshotEvent",
    "StepsEvent",
    "TimedOut",
    "Unreachable",
    "connect",
]

_MODULES = {
    "bot": ("Bot", "connect"),
    "errors": ("BotError", "Disconnected", "Refused", "TimedOut", "Unreachable"),
    "events": ("Event", "SnapshotEvent", "StepsEvent"),
    "scenario": ("Scenario",),
    "view": ("Avatar",),
}


def __getattr__(name: str) -> Any:
    for module, names in _MODULES.items():
        if name in names:
            found = getattr(import_module(f"{__name__}.{module}"), name)
            globals()[name] = found
            return found
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
