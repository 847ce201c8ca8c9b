"""Fewer resamples, where many studies are simulated."""

import pytest

from esplanade.stats import resampling


@pytest.fixture
def fewer_resamples(monkeypatch: pytest.MonkeyPatch) -> None:
    """A quarter of the resamples, which is enough for figures of hundreds of studies."""
    monkeypatch.setattr(resampling, "RESAMPLES", resampling.RESAMPLES // 4)
