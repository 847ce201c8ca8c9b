"""The types that the operators' page has of the interface agree with what a server answers."""

import re
from pathlib import Path
from typing import Any, Final

import pytest

from esplanade.actors.state import Reason
from esplanade.server.accounts.rights import Right
from tests.server.conftest import Serving
from tests.server.console.browsers import logged_in

CONSOLE: Final = Path(__file__).parents[3] / "client_web" / "src" / "console"


def _interface(name: str) -> tuple[set[str], set[str]]:
    """The fields of an interface that must be there, and those that may be."""
    text = (CONSOLE / "net" / "types.ts").read_text("utf-8")
    pattern = rf"^export interface {name}\b[^{{]*\{{\n(.*?)^\}}"
    found = re.search(pattern, text, re.MULTILINE | re.DOTALL)
    assert found, name
    fields = re.findall(r"^  (?:readonly )?(\w+)(\??):", found[1], re.MULTILINE)
    return {each for each, may in fields if not may}, {each for each, may in fields if may}


def _listed(file: str, name: str) -> list[str]:
    """The words of an array of the page."""
    text = (CONSOLE / file).read_text("utf-8")
    found = re.search(rf"export const {name}\b[^=]*= \[(.*?)\]", text, re.DOTALL)
    assert found, name
    return re.findall(r'"(\w+)"', found[1])


def test_the_page_knows_all_rights_and_reasons() -> None:
    assert _listed("net/types.ts", "RIGHTS") == [str(right) for right in Right]
    assert _listed("state/reasons.ts", "REASONS") == [reason.name.lower() for reason in Reason]


@pytest.mark.parametrize(
    ("path", "keys", "interface"),
    [
        ("/me", (), "Me"),
        ("/world", (), "World"),
        ("/actors", (), "Actors"),
        ("/actors", ("actors", 0), "Actor"),
        ("/actors/actor-1", (), "ActorDetails"),
        ("/actors/actor-1", ("parameters", "risk_weight"), "Source"),
        ("/map", (), "MapData"),
        ("/heat", ("storeys", 0), "Raster"),
        ("/actors/actor-1/why", (), "Why"),
        ("/actors/actor-1/why", ("spans", 0), "WhySpan"),
        ("/actors/actor-1/trace", (), "Trace"),
        ("/actors/actor-1/trace", ("cost",), "Cost"),
        ("/actors/actor-1/trace", ("risk", 0), "Raster"),
    ],
)
async def test_an_answer_has_the_fields_that_the_page_reads(
    serving: Serving, path: str, keys: tuple[Any, ...], interface: str
) -> None:
    async with serving(actors=1) as server:
        browser = await logged_in(server, "olga", "tuner")
        status, found = await browser.send("GET", path)
        assert status == 200, found
        for key in keys:
            found = found[key]
        needed, _ = _interface(interface)
        assert needed <= found.keys(), needed - found.keys()
