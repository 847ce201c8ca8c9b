"""The examples of the document run as they stand, but for the address."""

import asyncio
import dataclasses
import re
import sys
from pathlib import Path

from esplanade import bots
from esplanade.bots.load import LoadJob
from esplanade.bots.measures import AMOUNTS, SPREADS
from esplanade.bots.tally import Tally
from esplanade.protocol.messages import Chat, ChatLine, WalkTo
from tests.bots.scripted import scripted_server, until
from tests.patience import PATIENCE_S

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / "docs" / "bots.md").read_text()
EXAMPLES = re.findall(r"^```python\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL)


def rows_below(heading: str) -> str:
    """The table whose first line begins so."""
    return TEXT.split(f"| {heading} |", 1)[1].split("\n\n", 1)[0]


def test_every_member_stands_in_the_tables() -> None:
    hidden = {"join", "close"}  # `connect` calls them
    members = {name for name in dir(bots.Bot) if not name.startswith("_")} - hidden
    told = set(re.findall(r"[`.]([a-z_]+)[`(]", rows_below("member of `Bot`")))
    assert members <= told
    assert {name for name in dir(bots.Scenario) if not name.startswith("_")} <= {
        *re.findall(r"[`.]([a-z_]+)[`(]", rows_below("member of `Scenario`"))
    }
    fields = {field.name for field in dataclasses.fields(bots.Avatar)}
    assert fields == set(re.findall(r"`([a-z_]+)`", rows_below("field of `Avatar`")))


async def start(example: str, url: str) -> asyncio.subprocess.Process:
    assert "ws://localhost:8080" in example
    return await asyncio.create_subprocess_exec(
        sys.executable,
        "-u",
        "-c",
        example.replace("ws://localhost:8080", url),
        cwd=ROOT,
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.PIPE,
    )


async def finish(process: asyncio.subprocess.Process) -> str:
    out, err = await asyncio.wait_for(process.communicate(), PATIENCE_S)
    assert process.returncode == 0, err.decode()
    return out.decode()


async def test_the_greeter_greets_and_leaves_on_bye() -> None:
    async with scripted_server() as server:
        process = await start(EXAMPLES[0], server.url)
        await until(lambda: bool(server.people))
        async with bots.connect(server.url, name="Ann") as ann:
            greetings = []
            async for event in ann.events():
                if isinstance(event, Chat) and event.id != ann.id:
                    greetings.append(event.text)
                    await ann.chat("bye")
                    break
            assert greetings == ["Welcome, Ann!"]
            out = await finish(process)
    assert "I am 1 at (2.0" in out


async def test_the_steady_one_comes_back_with_its_token() -> None:
    async with scripted_server() as server:
        process = await start(EXAMPLES[1], server.url)
        assert process.stdout is not None
        assert await asyncio.wait_for(process.stdout.readline(), PATIENCE_S) == b"here as 1\n"
        server.people[1].socket.transport.abort()
        await until(lambda: 2 in server.people)
        assert server.people[2].hello.resume == "token-1"
        process.terminate()
        await process.communicate()


async def test_the_tour_is_a_scenario(tmp_path: Path) -> None:
    path = tmp_path / "tour.py"
    path.write_text(EXAMPLES[2])
    tally, stop = Tally(), asyncio.Event()
    async with scripted_server() as server:
        job = LoadJob(server.url, 1, 0, 1, 0, 100.0, duration_s=0.0, scenario=f"{path}:Tour")
        running = asyncio.create_task(job.run(tally, stop))
        await until(lambda: bool(server.all_people) and len(server.all_people[0].heard) > 4)
        stop.set()
        await running
    heard = server.all_people[0].heard
    assert sum(isinstance(message, WalkTo) for message in heard) == 1
    assert any(isinstance(each, ChatLine) and "I go to (" in each.text for each in heard)
    assert tally.well


def test_every_measure_is_explained() -> None:
    for name in (*SPREADS, *AMOUNTS):
        assert f"`{name}`" in TEXT


def test_there_are_no_other_examples() -> None:
    assert len(EXAMPLES) == 3
