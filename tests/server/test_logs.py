import json
import logging
from collections.abc import Iterator
from typing import Literal

import pytest
import structlog

from esplanade.server import logs
from esplanade.server.settings import ServerSettings


@pytest.fixture(autouse=True)
def _as_before() -> Iterator[None]:
    yield
    structlog.reset_defaults()


def test_lines_are_json_where_that_is_wanted(capfd: pytest.CaptureFixture[str]) -> None:
    with logs.written(ServerSettings(log_format="json")):
        structlog.get_logger("esplanade.server.test").info("person here", id=3)
        logging.getLogger("some.library").warning("told %s", "you")
    ours, theirs = (json.loads(line) for line in capfd.readouterr().err.splitlines())
    assert (ours["event"], ours["id"], ours["level"]) == ("person here", 3, "info")
    assert (theirs["event"], theirs["logger"]) == ("told you", "some.library")


@pytest.mark.parametrize("log_format", ["console", "json"])
def test_faults_are_logged_without_the_values_of_variables(
    capfd: pytest.CaptureFixture[str], log_format: Literal["console", "json"]
) -> None:
    token = str(40 + 2)
    with logs.written(ServerSettings(log_format=log_format)):
        try:
            int(f"no number {len(token)}")
        except ValueError:
            structlog.get_logger("esplanade.server.test").exception("a fault")
    text = capfd.readouterr().err
    assert "ValueError: invalid literal" in text
    assert f"'{token}'" not in text


def test_what_is_below_the_level_is_left_out(capfd: pytest.CaptureFixture[str]) -> None:
    with logs.written(ServerSettings(log_level="warning")):
        structlog.get_logger("esplanade.server.test").info("unheard")
        structlog.get_logger("esplanade.server.test").warning("heard")
    text = capfd.readouterr().err
    assert "unheard" not in text
    assert "heard" in text
