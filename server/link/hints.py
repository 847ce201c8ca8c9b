"""Hints to all processes of a world that something has changed in the database.

A hint may be lost: whoever waits for one looks now and then without it.
"""

import asyncio
from collections.abc import Callable
from contextlib import suppress
from typing import Final

from nats.aio.client import Client
from nats.errors import Error as NatsError

from esplanade.server.link.subjects import Subjects

OWNERSHIPS: Final = b"ownerships"
MODERATION: Final = b"moderation"


async def hint(broker: Client, subjects: Subjects, what: bytes) -> None:
    """Let all processes look at what has changed."""
    if broker.is_connected:
        with suppress(NatsError):
            await broker.publish(subjects.control, what)


def hinting(broker: Client, subjects: Subjects, what: bytes) -> Callable[[], None]:
    """A function that gives that hint, on the event loop where it is called."""
    under_way: set[asyncio.Task[None]] = set()

    def give() -> None:
        task = asyncio.create_task(hint(broker, subjects, what))
        under_way.add(task)
        task.add_done_callback(under_way.discard)

    return give
