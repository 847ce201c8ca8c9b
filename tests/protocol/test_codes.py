"""One table of codes, here and in the browser's client."""

import re
from enum import IntEnum
from pathlib import Path

import pytest

from esplanade.protocol import codes
from esplanade.protocol.codes import (
    ByeCode,
    ClientCode,
    CloseCode,
    ErrorCode,
    Gesture,
    Kind,
    Outcome,
    Reason,
    ServerCode,
)

TYPESCRIPT = Path(__file__).resolve().parents[2] / "client_web" / "src" / "net" / "codes.ts"


def typescript_table(name: str) -> dict[str, int]:
    """Entries of `export const <name> = { KEY: 1, ... }`."""
    found = re.search(rf"export const {name} = {{(.*?)}}", TYPESCRIPT.read_text(), re.DOTALL)
    assert found is not None, f"{name} is missing in {TYPESCRIPT.name}"
    return {key: int(value) for key, value in re.findall(r"(\w+):\s*(\d+)", found[1])}


@pytest.mark.parametrize("table", [ClientCode, ServerCode, Reason, Outcome, Gesture, CloseCode])
def test_the_browser_has_the_same_numbers(table: type[IntEnum]) -> None:
    assert typescript_table(table.__name__) == {entry.name: entry.value for entry in table}


@pytest.mark.parametrize("name", ["VERSION", "MAX_NAME_CHARS", "MAX_CHAT_CHARS"])
def test_the_browser_has_the_same_limits(name: str) -> None:
    found = re.search(rf"export const {name} = (\d+);", TYPESCRIPT.read_text())
    assert found is not None, f"{name} is missing in {TYPESCRIPT.name}"
    assert int(found[1]) == getattr(codes, name)


def test_codes_of_both_directions_never_meet_and_are_one_byte() -> None:
    numbers = [*map(int, ClientCode), *map(int, ServerCode)]
    assert len(set(numbers)) == len(numbers)
    assert all(0 < number < 128 for number in numbers)
    assert max(ClientCode) < min(ServerCode)


def test_close_codes_of_ours_lie_in_the_private_range() -> None:
    standard = {CloseCode.NORMAL, CloseCode.GOING_AWAY, CloseCode.TOO_LARGE, CloseCode.BUSY}
    assert all(4000 <= code < 5000 for code in set(CloseCode) - standard)


def test_names_on_the_wire_are_those_of_the_table() -> None:
    for table in (ErrorCode, ByeCode, Kind):
        assert {entry.value for entry in table} == {entry.name.lower() for entry in table}
