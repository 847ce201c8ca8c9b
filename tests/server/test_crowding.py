import pytest
import structlog
from structlog.testing import capture_logs

from esplanade.server import crowding
from esplanade.server.crowding import warn_of_crowding
from esplanade.server.settings import ServerSettings


@pytest.fixture(autouse=True)
def _fresh_logger(monkeypatch: pytest.MonkeyPatch) -> None:
    """Loggers are kept from their first use on, with the settings of that time."""
    monkeypatch.setattr(crowding, "log", structlog.get_logger())


@pytest.mark.parametrize(("people", "rate"), [(1000, 20), (1700, 20), (800, 40)])
def test_a_crowd_that_a_tick_has_time_for_is_no_cause_for_words(people: int, rate: int) -> None:
    with capture_logs() as logs:
        warn_of_crowding(ServerSettings(max_clients=people, tick_rate=rate))
    assert logs == []


def test_of_more_people_than_a_tick_has_time_for_one_is_warned_with_the_figure() -> None:
    with capture_logs() as logs:
        warn_of_crowding(ServerSettings(max_clients=4000))
    (line,) = logs
    assert (line["log_level"], line["max_clients"]) == ("warning", 4000)
    assert (line["tick_ms"], line["of_ms"], line["enough_for"]) == (116, 50, 1724)
