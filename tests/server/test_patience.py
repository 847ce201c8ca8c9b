import threading

import pytest
import structlog
from structlog.testing import capture_logs

from esplanade.server import patience


def test_long_work_is_told_of_while_it_lasts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(patience, "TOLD_EVERY_S", 0.01)
    # A logger that a server of another test has used keeps to what was set up then.
    monkeypatch.setattr(patience, "log", structlog.get_logger())
    with capture_logs() as lines, patience.told_of("reading the scene"):
        while len(lines) < 2:
            threading.Event().wait(0.01)
    assert {line["work"] for line in lines} == {"reading the scene"}
    told = len(lines)
    threading.Event().wait(0.05)
    assert len(lines) == told


def test_short_work_is_not_told_of() -> None:
    with capture_logs() as lines, patience.told_of("reading the scene"):
        pass
    assert lines == []
