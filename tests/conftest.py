"""Rules of every run: nothing is measured against a clock, and no browser test skips in silence."""

import os
import signal
from collections.abc import Generator
from typing import Any

import pytest
from _pytest.terminal import TerminalReporter
from hypothesis import HealthCheck, settings

REQUIRE_VARIABLE = "ESPLANADE_REQUIRE_BROWSER"

# The first example of a process compiles kernels, some of them while it is drawn.
settings.register_profile(
    "any machine", deadline=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("any machine")

# A shell has what it runs in the background ignore Ctrl-C, and every process inherits that.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item,
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Turn the skip of a browser test into a failure where the variable asks for it."""
    report = yield
    if report.skipped and "browser" in report.keywords and os.environ.get(REQUIRE_VARIABLE) == "1":
        report.outcome = "failed"
        report.longrepr = f"{item.nodeid} skipped, but {REQUIRE_VARIABLE}=1: {report.longrepr}"
    return report


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> object:
    """Have some tests run in one process of several (`tests/distribution.py`)."""
    from tests.distribution import Together

    return Together(config, log)


def pytest_terminal_summary(terminalreporter: TerminalReporter) -> None:
    """Say loudly how many browser tests did not run."""
    skipped = [
        report
        for report in terminalreporter.getreports("skipped")
        if "browser" in getattr(report, "keywords", ())
    ]
    if skipped:
        terminalreporter.section("THE BROWSER TESTS DID NOT RUN", sep="!", red=True, bold=True)
        terminalreporter.line(
            f"{len(skipped)} skipped: no chromium. Install one, or name one in ESPLANADE_CHROMIUM."
        )
