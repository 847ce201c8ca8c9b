"""`esplanade op watch`: what happens in a real server, as lines; and its end."""

import asyncio
import json
import os
import signal
import subprocess
import sys
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import AsyncExitStack, asynccontextmanager, contextmanager

import pytest

from esplanade.commandline import exit_codes
from esplanade.operators.watch_commands import lines
from esplanade.operators.watch_options import CHANNELS, EVENT_KINDS
from esplanade.server.app import Running
from esplanade.server.console.live_socket import STREAMED
from esplanade.server.live import subscriptions
from tests.commandline.test_interrupts import hear_interrupts
from tests.patience import PATIENCE_S
from tests.server.client import joined
from tests.server.conftest import Serving, room_file, serving, serving_assets
from tests.server.console.operators import operator

__all__ = ["room_file", "serving", "serving_assets"]


class Watching:
    """A process that watches a server."""

    def __init__(self, port: int, token: str, *words: str) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-m", "esplanade", "op", "watch", *words],
            env={
                **os.environ,
                "ESPLANADE_URL": f"http://127.0.0.1:{port}",
                "ESPLANADE_TOKEN": token,
            },
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            preexec_fn=hear_interrupts,  # noqa: PLW1509 (it only hears them)
        )

    async def line(self, wanted: Callable[[str], bool]) -> str:
        """The first line of that kind."""
        assert self.process.stdout is not None
        async with asyncio.timeout(PATIENCE_S):
            while True:
                line = await asyncio.to_thread(self.process.stdout.readline)
                assert line, await asyncio.to_thread(self.process.communicate)
                if wanted(line):
                    return line.rstrip("\n")

    async def end(self) -> tuple[int, str]:
        """Its exit code, and what it has said of faults."""
        _, said = await asyncio.to_thread(self.process.communicate, timeout=PATIENCE_S)
        return self.process.returncode, said


async def test_events_and_changes_are_lines_until_ctrl_c(serving: Serving) -> None:
    async with serving(actors=1) as server:
        olga = await operator(server, "olga", "tuner")
        async with _watching(server, olga.token) as watching:
            change = {"op": "set_parameters", "scope": "world", "values": {"risk_weight": 4}}
            status, answer = await olga.send({**change, "note": "queue"})
            assert status == 200
            line = await watching.line(lambda line: "change " in line)
            assert f"change {answer['command']} by olga: set_parameters, queue" in line
            line = await watching.line(lambda line: "risk_weight" in line)
            assert line == "  world risk_weight: not set -> 4.0"
            async with joined(server.port, "Eve"):
                line = await watching.line(lambda line: " join " in line)
                assert "Eve came in  at " in line
            watching.process.send_signal(signal.SIGINT)
            assert await watching.end() == (exit_codes.INTERRUPTED, "")


async def test_kinds_are_chosen_and_messages_are_json(serving: Serving) -> None:
    words = ("events", "--kind", "mark", "--json")
    async with AsyncExitStack() as stack:
        async with serving(actors=1) as server:
            olga = await operator(server, "olga", "tuner")
            watching = await stack.enter_async_context(_watching(server, olga.token, *words))
            await olga.send({"op": "hold_actor", "actor": "actor-1"})
            await olga.send({"op": "mark", "text": "doors \x1b[31mopened"})
            found = json.loads(await watching.line(bool))
            assert [each["kind"] for each in found["events"]] == ["mark"]
            assert found["events"][0]["text"] == "doors \x1b[31mopened"
        # The server has ended, and that is told.
        code, said = await watching.end()
        assert code == exit_codes.FAILED
        assert said.startswith("esplanade op watch: ")


async def test_who_may_not_watch_is_told(serving: Serving) -> None:
    async with serving() as server:
        with running(server, "esplanade_wrong", "series") as watching:
            code, said = await watching.end()
        assert code == exit_codes.FAILED
        assert "token" in said


async def test_whoever_reads_the_lines_may_stop(serving: Serving) -> None:
    async with serving(actors=1) as server:
        olga = await operator(server, "olga", "tuner")
        async with _watching(server, olga.token, "series") as watching:
            assert "people 0" in await watching.line(bool)
            assert watching.process.stdout is not None
            watching.process.stdout.close()
            assert watching.process.stderr is not None
            said = await asyncio.to_thread(watching.process.stderr.read)
            code = await asyncio.to_thread(watching.process.wait, PATIENCE_S)
            assert (code, said) == (0, "")


def test_text_of_others_does_not_steer_the_terminal() -> None:
    event = {"at_us": 0, "kind": "chat", "text": "Eve: \x1b]0;x\x07\nhello", "place": None}
    (line,) = lines({"channel": "events", "events": [event]})
    assert line.isprintable()
    contact = [1.0, 2.0, 0.0, "main/actor-1", 17, "person"]
    (line,) = lines({"channel": "contacts", "tick": 9, "pairs": [contact]})
    assert line == "tick 9  main/actor-1 and person 17 touched at 1.0, 2.0, 0.0"


@pytest.mark.parametrize(
    ("offered", "known"),
    [(EVENT_KINDS, subscriptions.EVENT_KINDS), (CHANNELS, STREAMED)],
    ids=["kinds", "channels"],
)
def test_what_is_offered_is_what_the_server_knows(
    offered: tuple[str, ...], known: tuple[str, ...]
) -> None:
    assert set(offered) == set(known)


@contextmanager
def running(server: Running, token: str, *words: str) -> Iterator[Watching]:
    """A process that watches, and has ended afterwards."""
    watching = Watching(server.private_port, token, *words)
    with watching.process:
        try:
            yield watching
        finally:
            watching.process.kill()


@asynccontextmanager
async def _watching(server: Running, token: str, *words: str) -> AsyncIterator[Watching]:
    """The same, once the server tells it what happens."""
    with running(server, token, *words) as watching:
        async with asyncio.timeout(PATIENCE_S):
            while not server.live.subscribers:
                assert watching.process.poll() is None, await watching.end()
                await asyncio.sleep(0.02)
        yield watching
