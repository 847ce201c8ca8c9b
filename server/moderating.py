"""Opens what moderators have decided, for a server that runs."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress

from esplanade.server.metrics import Metrics
from esplanade.server.moderation.state import ModerationState
from esplanade.server.settings import ServerSettings
from esplanade.server.store.store import Store


@asynccontextmanager
async def moderating(
    settings: ServerSettings, store: Store, metrics: Metrics
) -> AsyncIterator[ModerationState]:
    """Begin with what was kept, and keep what people send from then on.

    Raises
    ------
    StoreError
        The store cannot be used.
    """
    state = ModerationState(store, keeps_chat=settings.keep_chat, chat_days=settings.keep_chat_days)
    await state.load()
    metrics.gauge("reports_open", "Reports that wait for moderators", lambda: state.inbox.open)
    metrics.gauge("bans", "Bans that are not lifted", lambda: state.bans.holding)
    metrics.gauge(
        "moderation_waiting",
        "Reports and lines of chat that wait for the store",
        lambda: state.later.waiting,
    )
    metrics.total(
        "moderation_refused",
        "Reports and lines of chat that are not kept because too many waited",
        lambda: state.later.refused,
    )
    metrics.total(
        "moderation_not_kept",
        "Reports and lines of chat that the store did not take, for a reason in the log",
        lambda: state.later.failed,
    )
    running = asyncio.create_task(state.run())
    try:
        yield state
    finally:
        running.cancel()
        with suppress(asyncio.CancelledError):
            await running
