"""Moderators' decisions of other processes, taken in as soon as one hears that there are any."""

import asyncio
from typing import Final

import structlog

from esplanade.server.moderation.state import ModerationState
from esplanade.server.store.store import StoreError

LOOK_S: Final = 2.0
"""The store is read so often where nothing was heard: a word of it may be lost."""
PAUSE_S: Final = 0.2
"""The least time between two looks."""

log = structlog.get_logger(__name__)


class SharedModeration:
    """Keeps the state of one process as the store has it, which other processes write too."""

    def __init__(self, state: ModerationState) -> None:
        self._state = state
        self._heard = asyncio.Event()

    def hear(self) -> None:
        """Look soon: somebody has decided something."""
        self._heard.set()

    async def run(self) -> None:
        """Look again and again until cancelled."""
        while True:
            try:
                async with asyncio.timeout(LOOK_S):
                    await self._heard.wait()
            except TimeoutError:
                pass
            self._heard.clear()
            try:
                await self._state.look()
            except StoreError as error:
                log.debug("nobody knows what moderators have decided", why=str(error))
            await asyncio.sleep(PAUSE_S)
