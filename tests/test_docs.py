"""Everything that the documents name exists: make targets, files, options; examples hold."""

import ast
import asyncio
import json
import re
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any, cast

import pytest
from fastapi import FastAPI

from esplanade import bots
from esplanade.cli import COMMANDS
from esplanade.planning import Scene
from esplanade.protocol.commands import COMMAND
from esplanade.protocol.messages import Chat, Enter
from esplanade.server.accounts.rights import COMMANDS as RIGHTS
from esplanade.server.app import running
from esplanade.server.console.api import add_api
from esplanade.server.console.gate import Gate
from esplanade.server.roster import Roster
from esplanade.server.settings import ServerSettings
from tests.patience import PATIENCE_S

ROOT = Path(__file__).resolve().parents[1]
DOCUMENTS = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted(ROOT.glob("docs/**/*.md"))]
NOT_OURS = {"crowdbotp/OpenTraj", "crowds/", "server/client_assets/"}

FENCE = re.compile(r"^```(\w*)\n(.*?)^```", re.MULTILINE | re.DOTALL)
SPAN = re.compile(r"`([^`\n]+)`")
LINK = re.compile(r"\]\(([^)#]+)")
PATH = re.compile(r"\.?\w[\w.-]*/[\w./-]*|[\w-]+\.(md|toml|yml)")

documents = pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)


def blocks(text: str, language: str) -> list[str]:
    return [body for found, body in FENCE.findall(text) if found == language]


def commands(text: str) -> Iterator[str]:
    """Every line of a shell block, and every code span in the running text."""
    for block in blocks(text, "sh"):
        yield from (line.split("  #")[0].strip() for line in block.splitlines())
    yield from SPAN.findall(FENCE.sub("", text))


@cache
def help_of(command: str) -> str:
    arguments = [sys.executable, "-m", "esplanade", command, "--help"]
    return subprocess.run(arguments, check=True, capture_output=True, text=True).stdout


@documents
def test_make_targets_exist(document: Path) -> None:
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))
    named = set(re.findall(r"\bmake ([a-z-]+)", "\n".join(commands(document.read_text()))))
    assert named <= targets


@documents
def test_paths_exist(document: Path) -> None:
    text = document.read_text()
    links = {link for link in LINK.findall(text) if "://" not in link}
    missing = [link for link in links if not (document.parent / link).exists()]
    spans = {span for span in SPAN.findall(FENCE.sub("", text)) if PATH.fullmatch(span)}
    missing += [span for span in spans - NOT_OURS if not (ROOT / span).exists()]
    assert missing == []


@documents
def test_options_exist(document: Path) -> None:
    unknown = [
        line
        for line in commands(document.read_text())
        if (call := re.match(rf"esplanade ({'|'.join(COMMANDS)})\b(.*)", line))
        and not all(
            re.search(rf"(?<![\w-]){option}(?![\w-])", help_of(call[1]))
            for option in re.findall(r"--[a-z][a-z-]*", call[2])
        )
    ]
    assert unknown == []


@documents
def test_options_named_alone_are_options_of_a_command(document: Path) -> None:
    spans = SPAN.findall(FENCE.sub("", document.read_text()))
    options = {span.split()[0] for span in spans if span.startswith("--")}
    known = "".join(help_of(command) for command in COMMANDS)
    assert {option for option in options if option not in known} == set()


@documents
def test_client_scripts_exist(document: Path) -> None:
    scripts = json.loads((ROOT / "client_web" / "package.json").read_text())["scripts"]
    named = re.findall(r"tools/npm\.py run ([\w:]+)", "\n".join(commands(document.read_text())))
    assert set(named) <= set(scripts)


@documents
def test_json_blocks_of_scenes_are_scenes(document: Path) -> None:
    examples = [block for block in blocks(document.read_text(), "json") if '"bounds"' in block]
    for example in examples:
        assert Scene.model_validate_json(example).places


@documents
def test_python_blocks_import_what_exists(document: Path) -> None:
    for block in blocks(document.read_text(), "python"):
        for node in ast.walk(ast.parse(block)):
            if isinstance(node, ast.Import):
                assert all(import_module(name.name) for name in node.names)
            if isinstance(node, ast.ImportFrom) and node.module:
                module = import_module(node.module)
                assert [n.name for n in node.names if not hasattr(module, n.name)] == []


def test_readme_shows_how_to_make_a_scene() -> None:
    scene, roster = blocks((ROOT / "README.md").read_text(), "json")
    assert '"bounds"' in scene
    places = {place.name for place in Scene.model_validate_json(scene).places}
    for spec in Roster.model_validate_json(roster).actors:
        assert set(spec.behaviour.make().targets()) <= places


def test_the_planner_goes_into_a_program_of_its_own(capsys: pytest.CaptureFixture[str]) -> None:
    (example,) = blocks((ROOT / "docs/planning.md").read_text(), "python")
    names: dict[str, Any] = {}
    exec(example, names)
    assert names["state"].reason.name == "ARRIVED"
    assert " after 1" in capsys.readouterr().out


def test_every_command_of_operators_is_in_its_table_with_the_right_it_needs() -> None:
    page = (ROOT / "docs/operators.md").read_text()
    table = page.partition("\n### Commands\n")[2].partition("\n### ")[0]
    rights = {
        op: right.split(",")[0]
        for ops, right in re.findall(r"^\| (`.*?`) \| (\w[^|]*) \|", table, re.MULTILINE)
        for op in SPAN.findall(ops)
    }
    commands_there_are = COMMAND.json_schema()["discriminator"]["mapping"]
    assert rights == {op: RIGHTS[op].value for op in commands_there_are}


def test_every_request_of_operators_is_in_its_table() -> None:
    page = (ROOT / "docs/operators.md").read_text()
    table = page.partition("\n### Requests\n")[2].partition("\n### ")[0]
    app = FastAPI()
    add_api(app, cast(Gate, None))
    words = {path.split("/{")[0].rpartition("/")[2] for path in app.openapi()["paths"]}
    words |= {path.rpartition("/")[2] for path in app.openapi()["paths"] if path[-1] != "}"}
    assert {word for word in words if f"/{word}" not in table} == set()


async def test_bot_of_the_readme_answers() -> None:
    (example,) = blocks((ROOT / "README.md").read_text(), "python")
    program, _, last_line = example.strip().rpartition("\n")
    assert last_line == "asyncio.run(main())"
    async with running(ServerSettings(actors=0, port=0, private_port=0)) as server:
        url = f"ws://localhost:{server.port}"
        names: dict[str, Any] = {}
        exec(program.replace("ws://localhost:8080", url), names)
        async with asyncio.timeout(PATIENCE_S), bots.connect(url, name="Narcissus") as bot:
            echo = asyncio.create_task(names["main"]())
            try:
                assert await conversation(bot) == "I heard: Who is there?"
            finally:
                echo.cancel()
                await asyncio.wait([echo])


async def conversation(bot: bots.Bot) -> str:
    """Ask Echo as soon as it comes into view, and return what somebody else says then."""
    async for event in bot.events():
        if isinstance(event, Enter) and any(entity.name == "Echo" for entity in event.entities):
            await bot.chat("Who is there?")
        if isinstance(event, Chat) and event.id != bot.id:
            return event.text
    raise AssertionError("the connection ended without an answer")
