"""Tells people that their zone is silent, and that it goes on."""

from collections.abc import Callable, Mapping
from typing import Final

from esplanade.protocol import NoticeCode
from esplanade.protocol.messages import Notice
from esplanade.server.net import frames
from esplanade.server.net.session import Session

SILENT_S: Final = 1.0
"""A zone of which no frame has come for so long is silent."""

_PAUSED: Final = (
    "This place does not answer just now. Nobody moves, and you keep your place; it goes on by "
    "itself in a moment."
)
_RESUMED: Final = "The place goes on."


class SilenceNotices:
    """Each has the time of the world, by which clients let their clocks stand and run on."""

    def __init__(self, sessions: Mapping[int, Session], server_time: Callable[[], float]) -> None:
        self._sessions = sessions
        self._server_time = server_time
        self.silent = False
        """Whether the zone is silent, and people have been told so."""

    def check(self, heard_s: float | None, now_s: float) -> None:
        """Tell everyone where the newest frame, which came at `heard_s`, is too old."""
        if not self.silent and heard_s is not None and now_s - heard_s > SILENT_S:
            self.silent = True
            self._tell(NoticeCode.PAUSED, _PAUSED, 0.0)

    def heard(self) -> None:
        """Tell everyone that frames come again, if they have not."""
        if self.silent:
            self.silent = False
            self._tell(NoticeCode.RESUMED, _RESUMED, 1.0)

    def _tell(self, code: NoticeCode, text: str, rate: float) -> None:
        arguments = {
            "factor": 1.0,
            "rate": rate,
            "server_time": self._server_time(),
            "silent": True,
        }
        frame = frames.message(Notice(text=text, notice=code, arguments=arguments))
        for session in self._sessions.values():
            session.outbox.post(frame)
