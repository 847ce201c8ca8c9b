"""Tells people that the world is paused, runs on, or runs slower or faster than usual."""

from collections.abc import Callable, Mapping

from esplanade.protocol import NoticeCode
from esplanade.protocol.messages import Notice
from esplanade.server.net import frames
from esplanade.server.net.guests import Guest
from esplanade.server.world.pace import PaceState


class PaceNotices:
    """Each has the time of the world, by which clients set their clocks."""

    def __init__(self, sessions: Mapping[int, Guest], server_time: Callable[[], float]) -> None:
        self._sessions = sessions
        self._server_time = server_time
        self._was_paused = False
        self._told = PaceState(1.0, paused=False, rate=1.0)

    def tell_all(self, state: PaceState, _: float) -> None:
        """Tell everyone who is connected.

        People are not told that a world of usual pace falls behind: nobody has chosen that.
        """
        before, self._told = self._told, state
        same = (before.factor, before.paused) == (state.factor, state.paused)
        if same and state.factor == 1.0 and not state.paused:
            return
        frame = frames.message(self._notice(state))
        self._was_paused = state.paused
        for session in self._sessions.values():
            session.outbox.post(frame)

    def tell_newcomer(self, session: Guest, state: PaceState) -> None:
        """Tell somebody who has just been welcomed, unless all is as usual."""
        if state.paused or state.factor != 1.0:
            session.outbox.post(frames.message(self._notice(state)))

    def _notice(self, state: PaceState) -> Notice:
        code, text = _said(state, was_paused=self._was_paused)
        arguments = {
            "factor": state.factor,
            "rate": round(state.rate, 3),
            "server_time": self._server_time(),
        }
        return Notice(text=text, notice=code, arguments=arguments)


def _said(state: PaceState, *, was_paused: bool) -> tuple[NoticeCode, str]:
    if state.paused:
        return NoticeCode.PAUSED, (
            "The world is paused: an operator has stopped time for a moment. Nobody moves, "
            "and you keep your place. You can go on talking."
        )
    if state.factor == 1.0:
        return (
            NoticeCode.RESUMED if was_paused else NoticeCode.PACE,
            "The world goes on as usual." if was_paused else "Time runs as usual again.",
        )
    code = NoticeCode.RESUMED if was_paused else NoticeCode.PACE
    if state.reached:
        speed = "slowly" if state.factor < 1.0 else "fast"
        return code, f"Time runs {speed} here just now: {state.factor:g} times as fast as usual."
    return code, (
        f"Time is to run {state.factor:g} times as fast as usual, but the server manages only "
        f"{state.rate:.2g} times."
    )
