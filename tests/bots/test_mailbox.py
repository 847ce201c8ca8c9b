"""The queue of events: order, bound, what goes when it is full, how it ends."""

import asyncio

from esplanade.bots.events import SnapshotEvent, StepsEvent
from esplanade.bots.mailbox import Mailbox
from esplanade.protocol.messages import Notice
from esplanade.protocol.snapshot import unpack_block
from esplanade.protocol.steps import step_records


def snapshot(tick: int) -> SnapshotEvent:
    return SnapshotEvent(tick, 0, unpack_block(b""), (0.0, 0.0))


async def drain(mailbox: Mailbox) -> list[int | str]:
    mailbox.close()
    names: list[int | str] = []
    while (event := await mailbox.get()) is not None:
        names.append(event.tick if isinstance(event, SnapshotEvent) else event.text)  # type: ignore[union-attr]
    return names


async def test_events_come_in_order() -> None:
    mailbox = Mailbox()
    mailbox.put(snapshot(1))
    mailbox.put(Notice(text="a"))
    mailbox.put(snapshot(2))
    assert await drain(mailbox) == [1, "a", 2]


async def test_steps_give_way_as_snapshots_do() -> None:
    mailbox = Mailbox(capacity=2)
    mailbox.put(Notice(text="a"))
    mailbox.put(StepsEvent(1, step_records(b"")))
    mailbox.put(snapshot(2))
    assert await drain(mailbox) == ["a", 2]


async def test_when_full_the_oldest_snapshot_goes() -> None:
    mailbox = Mailbox(capacity=3)
    mailbox.put(Notice(text="a"))
    for tick in range(1, 5):
        mailbox.put(snapshot(tick))
    mailbox.put(Notice(text="b"))
    assert mailbox.dropped == 3
    assert await drain(mailbox) == ["a", 4, "b"]


async def test_without_snapshots_the_oldest_event_goes() -> None:
    mailbox = Mailbox(capacity=2)
    for text in "abc":
        mailbox.put(Notice(text=text))
    assert mailbox.dropped == 1
    assert await drain(mailbox) == ["b", "c"]


async def test_a_reader_waits_and_is_woken() -> None:
    mailbox = Mailbox()
    reader = asyncio.create_task(mailbox.get())
    await asyncio.sleep(0)
    mailbox.put(Notice(text="a"))
    assert await reader == Notice(text="a")
    reader = asyncio.create_task(mailbox.get())
    await asyncio.sleep(0)
    mailbox.close()
    assert await reader is None
