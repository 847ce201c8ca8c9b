"""Processes whose clock is wrong, by libfaketime."""

import os
from pathlib import Path
from typing import Final

import pytest

REQUIRE_VARIABLE: Final = "ESPLANADE_REQUIRE_FAKETIME"
"""With 1, a test that finds no libfaketime fails instead of skipping."""


def clock_ahead(seconds: float) -> dict[str, str]:
    """The environment in which a process takes it to be so many seconds later than it is.

    The clock that only ever goes on, by which it waits, is right: on a real machine it is as well.
    """
    found = sorted(Path("/usr/lib").glob("*/faketime/libfaketime.so.1"))
    if not found:
        why = "libfaketime is not installed here: apt-get install faketime"
        if os.environ.get(REQUIRE_VARIABLE) == "1":
            pytest.fail(f"{REQUIRE_VARIABLE}=1, but {why}")
        pytest.skip(why)
    return {
        "LD_PRELOAD": str(found[-1]),
        "FAKETIME": f"{seconds:+g}",
        "FAKETIME_DONT_FAKE_MONOTONIC": "1",
        "DONT_FAKE_MONOTONIC": "1",
        # Kernels are kept by the times of their files.
        "NO_FAKE_STAT": "1",
    }
