"""The log names the address of everyone that was refused or cut off, in few lines."""

import os
import struct
from collections.abc import Callable

import pytest
import structlog

from esplanade.protocol import VERSION, CloseCode, encode
from esplanade.protocol.messages import ChatLine, Error, Hello
from esplanade.server.metrics import Metrics
from esplanade.server.net.refusals import LINES_BURST, Refusals
from tests.server.client import Client, connected, joined
from tests.server.conftest import Serving

ATTACKER = "127.0.0.2"

Noting = Callable[[Refusals, str], None]


@pytest.mark.parametrize(
    ("note", "event", "metric"),
    [
        (lambda r, a: r.flood("frames", a), "client closed, it floods", 'floods_total{what="f'),
        (lambda r, a: r.line("rate", a), "line of chat refused", 'lines_refused_total{why="r'),
        (lambda r, a: r.slow("bytes", a), "client dropped, too slow", 'slow_total{limit="b'),
        (lambda r, a: r.fault("malformed", a), "client closed", None),
    ],
    ids=["flood", "line", "slow", "fault"],
)
async def test_many_of_one_address_make_one_line_and_are_counted(
    note: Noting, event: str, metric: str | None
) -> None:
    metrics = Metrics()
    refusals = Refusals(metrics)
    with structlog.testing.capture_logs() as lines:
        for _ in range(1000):
            note(refusals, ATTACKER)
        note(refusals, "127.0.0.3")
    assert [line["address"] for line in lines] == [ATTACKER, "127.0.0.3"]
    assert {line["event"] for line in lines} == {event}
    counts = [row for row in metrics.exposition().decode().splitlines() if metric and metric in row]
    assert [row.rpartition(" ")[2] for row in counts] == (["1001.0"] if metric else [])


async def test_lines_of_all_addresses_together_are_bounded() -> None:
    refusals = Refusals(Metrics())
    with structlog.testing.capture_logs() as lines:
        for k in range(1000):
            refusals.fault("malformed", f"10.0.{k // 256}.{k % 256}")
    assert len(lines) <= LINES_BURST + 10


async def test_a_flood_of_chat_is_named_with_its_address(serving: Serving) -> None:
    with structlog.testing.capture_logs() as lines:
        async with (
            serving(chat_rate=0.01) as server,
            joined(server.port, source=ATTACKER) as client,
        ):
            for _ in range(25):
                await client.send(ChatLine(text="hello"))
            for _ in range(20):
                await client.until(Error)
            assert b'lines_refused_total{why="rate"} 20.0' in server.metrics.exposition()
    assert _told(lines, "line of chat refused") == [("rate", ATTACKER)]


async def test_a_full_list_of_lines_is_named_too(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("esplanade.server.net.waiting_lines.MAX_LINES", 0)
    with structlog.testing.capture_logs() as lines:
        async with serving() as server, joined(server.port, source=ATTACKER) as client:
            await client.send(ChatLine(text="hello"))
            await client.until(Error)
            assert b'lines_refused_total{why="all"} 1.0' in server.metrics.exposition()
    assert _told(lines, "line of chat refused") == [("all", ATTACKER)]


async def _garbage(client: Client) -> None:
    await client.connection.send(b"\xc1")


async def _second_hello(client: Client) -> None:
    await client.connection.send(encode(Hello(name="Ann", version=VERSION)))


async def _broken_frame(client: Client) -> None:
    client.connection.transport.write(struct.pack(">BB", 0xFF, 0xFF) + os.urandom(500))


async def _huge_frame(client: Client) -> None:
    client.connection.transport.write(struct.pack(">BBQ", 0x82, 0x80 | 127, 10**6) + bytes(4))


@pytest.mark.parametrize(
    ("attack", "why", "code"),
    [
        (_garbage, "malformed", CloseCode.MALFORMED),
        (_second_hello, "invalid", CloseCode.INVALID),
        (_broken_frame, "protocol_error", 1002),
        (_huge_frame, "message_too_big", CloseCode.TOO_LARGE),
    ],
)
async def test_a_connection_closed_for_what_came_is_named_with_its_address(
    serving: Serving, attack: Callable[[Client], object], why: str, code: int
) -> None:
    with structlog.testing.capture_logs() as lines:
        async with serving() as server, joined(server.port, source=ATTACKER) as client:
            await attack(client)  # type: ignore[misc]
            _, closed = await client.last_words()
            assert closed == code
    assert _told(lines, "client closed") == [(why, ATTACKER)]


async def test_those_who_go_themselves_are_not_named(serving: Serving) -> None:
    with structlog.testing.capture_logs() as lines:
        async with serving() as server:
            async with joined(server.port):
                pass
            async with joined(server.port, "Ben") as lost:
                lost.connection.transport.abort()
            async with connected(server.port):
                pass
    assert not [line for line in lines if "address" in line]


def _told(lines: list[dict[str, object]], event: str) -> list[tuple[object, object]]:
    return [(line["why"], line["address"]) for line in lines if line["event"] == event]
