"""Listeners to changes: they are told on the zone's loop, as plain data."""

from collections.abc import Callable
from typing import Any

import structlog

from esplanade.server.console.changes import Change
from esplanade.server.console.groups import GROUP
from esplanade.server.console.state import each

Listener = Callable[[str, dict[str, Any]], None]

log = structlog.get_logger(__name__)


class Listeners:
    """Those who are told: `change` with the change, `mark`, or `about` and what to ask anew."""

    def __init__(self) -> None:
        self._listeners: list[Listener] = []

    def add(self, listener: Listener) -> None:
        """Tell one more from now on."""
        self._listeners.append(listener)

    def tell(self, kind: str, what: dict[str, Any]) -> None:
        """Tell all something; a fault of one is logged."""
        for listener in self._listeners:
            try:
                listener(kind, what)
            except Exception:
                log.exception("a listener of the console failed", kind=kind)

    def tell_change(self, change: Change, plain: dict[str, Any]) -> None:
        """Tell all what a change is now, and what is to be asked for anew since it was made."""
        if change.op == "mark":
            told = {"number": change.number, "at_us": change.at_us, "tick": change.tick}
            self.tell("mark", {**told, "account": change.account, "text": change.note})
        self.tell("change", plain)
        abouts = {_about(subject, field) for subject, field, _ in each(change.after)}
        for about in sorted(abouts - {""}):
            self.tell("about", {"about": about})


def _about(subject: str, field: str) -> str:
    """The things to be asked for anew when a fact is another."""
    if field.startswith(GROUP):
        return "groups"
    return {"preset": "presets", "schedule": "schedules"}.get(subject.partition(":")[0], "")
