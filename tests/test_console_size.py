"""The operators' page stays small enough for a slow line."""

import gzip
import re
from typing import Final

import pytest

from esplanade.server.assets import CLIENT_ASSETS

MOST_BYTES: Final = 120 * 1024
"""All of the page as it is sent, each file compressed; it has no three.js."""


def test_the_whole_page_has_at_most_120_kilobytes() -> None:
    if not (CLIENT_ASSETS / "console.html").is_file():
        pytest.fail("the web client is not built; run: make client")
    found, waiting = {"console.html"}, ["console.html"]
    while waiting:
        text = (CLIENT_ASSETS / waiting.pop()).read_text("utf-8")
        names = {f"assets/{name}" for name in re.findall(r"[\w.-]+-[\w-]{8}\.(?:js|css|svg)", text)}
        waiting += names - found
        found |= names
    sizes = {name: len(gzip.compress((CLIENT_ASSETS / name).read_bytes())) for name in found}
    assert len(found) > 5
    assert not any(name.startswith("assets/index-") for name in found), "people's page is in it"
    assert sum(sizes.values()) <= MOST_BYTES, sizes
