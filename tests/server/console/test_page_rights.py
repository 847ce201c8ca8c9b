"""The rights that buttons of the operators' page ask for are those that the server asks for."""

import re
from pathlib import Path
from typing import Final

from esplanade.server.accounts.rights import COMMANDS

FILE: Final = Path(__file__).parents[3] / "client_web" / "src" / "console" / "models" / "rights.ts"


def test_the_page_asks_for_the_right_of_each_command() -> None:
    text = FILE.read_text("utf-8")
    table = re.search(r"COMMAND_RIGHTS\b[^=]*= \{(.*?)\n\}", text, re.DOTALL)
    assert table
    found = dict(re.findall(r'(\w+): "(\w+)"', table[1]))
    assert len(found) > 20
    known = {command: right.value for command, right in COMMANDS.items() if command in found}
    assert {command: found[command] for command in known} == known
