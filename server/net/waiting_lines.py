"""Lines of chat that wait for the next tick, after all that may keep one from being heard."""

import asyncio
from collections.abc import Callable
from typing import Final, Generic, TypeVar

from esplanade.protocol import ErrorCode, ProtocolError
from esplanade.server.metrics import Metrics
from esplanade.server.net.chat_gate import ChatGate
from esplanade.server.net.guests import Guest
from esplanade.server.net.moderation import PeopleModeration
from esplanade.server.world.inputs import Say

MAX_LINES: Final = 1024
"""Lines of chat that may wait for the next tick, of all people together."""


Speaker = TypeVar("Speaker", bound=Guest)


class WaitingLines(Generic[Speaker]):
    """Lines of those who are in the world, and of those at the door until they are in."""

    def __init__(
        self,
        moderation: PeopleModeration,
        chat_gate: ChatGate,
        is_at_the_door: Callable[[Speaker], bool],
        metrics: Metrics,
    ) -> None:
        self._moderation = moderation
        self._chat_gate = chat_gate
        self._is_at_the_door = is_at_the_door
        self._metrics = metrics
        self._lines: list[tuple[Speaker, str]] = []
        metrics.gauge(
            "lines_waiting",
            "Lines of chat that wait for the next tick",
            lambda: len(self._lines),
        )

    def put(self, session: Speaker, text: str) -> None:
        """Say a line in the next tick; that of somebody at the door waits until they are in."""
        if len(self._lines) >= MAX_LINES:
            session.refuse_line("all", "too many people talk at once; nobody heard your line")
            return
        if session.avatar_id is not None:
            muted_s = self._moderation.muted_s(session.avatar_id)
            if muted_s > 0.0:
                text = f"an operator has muted you for {muted_s:.0f} s more; nobody heard your line"
                fault = ErrorCode.MUTED, text, None, {"seconds": round(muted_s, 1)}
                session.tell(ProtocolError(*fault))
                return
        now = asyncio.get_running_loop().time()
        try:
            text = self._chat_gate.pass_words(session.avatar_id or -session.ticket, text, now)
        except ProtocolError as fault:
            session.tell(fault)
            return
        self._metrics.chat_lines.inc()
        self._lines.append((session, text))

    def drain(self) -> list[Say]:
        """The lines of those who are in the world; those at the door go on waiting."""
        lines, self._lines = self._lines, []
        self._lines = [line for line in lines if self._is_at_the_door(line[0])]
        spoken = []
        for session, text in lines:
            place = None if session.avatar_id is None else self._moderation.where(session.avatar_id)
            if session.avatar_id is None or place is None:
                continue
            try:
                self._chat_gate.check_place(place)
            except ProtocolError as fault:
                session.tell(fault)
            else:
                spoken.append(Say(session.avatar_id, text))
        return spoken
