"""People are told once that their zone is silent, and once that it goes on."""

from typing import Any, cast

from esplanade.protocol import decode_server
from esplanade.protocol.messages import Notice
from esplanade.server.gateway.silence_notices import SILENT_S, SilenceNotices


class Outbox:
    """Takes down the frames of a session."""

    def __init__(self) -> None:
        self.outbox = self
        self.notices: list[Notice] = []

    def post(self, frame: bytes) -> None:
        payload = frame[4:] if frame[1] == 126 else frame[2:]
        message = decode_server(payload)
        assert isinstance(message, Notice)
        self.notices.append(message)


def test_silence_is_told_once_and_its_end_too() -> None:
    ann = Outbox()
    notices = SilenceNotices(cast(Any, {7: ann}), lambda: 12.5)
    notices.check(None, 50.0)
    notices.check(50.0, 50.0 + SILENT_S)
    notices.heard()
    assert ann.notices == []
    for later_s in (0.1, 0.2):
        notices.check(50.0, 50.0 + SILENT_S + later_s)
    assert [each.notice for each in ann.notices] == ["paused"]
    told = {"factor": 1.0, "rate": 0.0, "server_time": 12.5, "silent": True}
    assert ann.notices[0].arguments == told
    notices.heard()
    notices.heard()
    assert [each.notice for each in ann.notices] == ["paused", "resumed"]
    assert ann.notices[1].arguments == {**told, "rate": 1.0}
