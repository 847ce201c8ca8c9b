"""Moderates people for operators: announcements, mutes, and the way out."""

import math
from collections.abc import Callable, Mapping
from typing import Any, Final

import structlog

from esplanade.protocol import ByeCode, CloseCode
from esplanade.protocol.messages import Bye, Notice
from esplanade.server.net import frames
from esplanade.server.net.session import Session

MOST_MUTED: Final = 4096
"""Of more people who are muted, the mute that ends first is forgotten."""

log = structlog.get_logger(__name__)


class PeopleModeration:
    """Moderates the people of a hub, by their avatars' ids. A mute outlives a lost connection."""

    def __init__(
        self,
        sessions: Mapping[int, Session],
        kick: Callable[[Session], None],
        now_s: Callable[[], float],
    ) -> None:
        """`kick` gives up the seat of a session, so that its token opens nothing any more."""
        self._sessions = sessions
        self._kick = kick
        self._now_s = now_s
        self._muted_until_s: dict[int, float] = {}

    def save(self) -> dict[int, float]:
        """For how many seconds each person is muted yet, by the avatar."""
        now_s = self._now_s()
        return {who: end - now_s for who, end in self._muted_until_s.items() if end > now_s}

    def load(self, saved: Mapping[Any, Any]) -> None:
        """Go on from what was saved: time counts only while the world runs.

        Raises
        ------
        ValueError, TypeError
            It is not what `save` gives.
        """
        now_s = self._now_s()
        if len(saved) > MOST_MUTED or not all(map(math.isfinite, saved.values())):
            raise ValueError("these are no mutes")
        self._muted_until_s = {int(who): now_s + left_s for who, left_s in saved.items()}

    def name_of(self, person: int) -> str | None:
        """Return the name of a connected person."""
        session = self._sessions.get(person)
        return None if session is None else session.name

    def muted_s(self, person: int) -> float:
        """For how many seconds nobody hears a person yet."""
        return max(0.0, self._muted_until_s.get(person, 0.0) - self._now_s())

    def announce(self, text: str) -> int:
        """Say something to everyone who is connected; returns to how many."""
        notice = frames.message(Notice(text=text))
        for session in self._sessions.values():
            session.outbox.post(notice)
        return len(self._sessions)

    def kick(self, person: int, text: str) -> None:
        """End a person's connection, and say why; the avatar is gone, and its token void."""
        session = self._sessions.get(person)
        if session is None:
            return
        farewell = frames.message(Bye(reason=ByeCode.KICKED, text=text))
        self._kick(session)
        session.dismiss(farewell, CloseCode.KICKED, ByeCode.KICKED.value)
        log.info("person kicked", id=person)

    def mute(self, person: int, seconds: float, text: str) -> None:
        """Let nobody hear a person for a time, and say so; 0 ends it."""
        now_s = self._now_s()
        self._muted_until_s.pop(person, None)
        if seconds > 0.0:
            lasting = {who: end for who, end in self._muted_until_s.items() if end > now_s}
            if len(lasting) >= MOST_MUTED:
                del lasting[min(lasting, key=lasting.__getitem__)]
            self._muted_until_s = {**lasting, person: now_s + seconds}
        session = self._sessions.get(person)
        if session is not None:
            session.outbox.post(frames.message(Notice(text=text)))
