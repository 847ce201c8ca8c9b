"""Lines of chat on their way out: each gets a number, and is not sent to those who muted it."""

import itertools
from collections.abc import Callable
from typing import Final

from esplanade.protocol.messages import Chat
from esplanade.server.net import frames
from esplanade.server.world.audience import Heard

MOST_MUTED: Final = 200
"""A person mutes no more others at once."""

Said = Callable[[int, Heard, list[int]], None]
"""Is told of each line: its number, the line, and the viewers who are sent it."""


class Lines:
    """Numbers lines, and knows whom each viewer does not want to hear; all by avatars' ids.

    A number is given once, also by a server that was started again, since the first is the time of
    the start in milliseconds and nobody says a thousand lines a second for long.
    """

    def __init__(self, first: int = 1, said: Said | None = None) -> None:
        self.first = first
        self.latest = first - 1
        self._numbers = itertools.count(first)
        self._said = said
        self._muted: dict[int, set[int]] = {}

    def mute(self, viewer: int, speaker: int, *, muted: bool) -> bool:
        """Let a viewer hear a speaker no more, or again; False if they mute too many already."""
        chosen = self._muted.setdefault(viewer, set())
        if muted and len(chosen) >= MOST_MUTED and speaker not in chosen:
            return False
        (chosen.add if muted else chosen.discard)(speaker)
        if not chosen:
            del self._muted[viewer]
        return True

    def muted_by(self, viewer: int) -> frozenset[int]:
        """Those whom a viewer does not want to hear."""
        return frozenset(self._muted.get(viewer, ()))

    def forget(self, viewer: int) -> None:
        """A viewer's connection has ended: what they muted holds no more."""
        self._muted.pop(viewer, None)

    def take(self, heard: Heard) -> tuple[bytes, list[int]]:
        """Number a line that has no number; its frame, and the viewers who are to be sent it."""
        line = self.latest = heard.line.number or next(self._numbers)
        viewers = heard.viewers
        if self._muted:
            speaker = heard.line.id
            viewers = [v for v in viewers if speaker not in self._muted.get(v, ())]
        if self._said is not None:
            self._said(line, heard, viewers)
        text = heard.line.text
        return frames.message(
            Chat(id=heard.line.id, name=heard.name, text=text, line=line)
        ), viewers
