"""The base of scenarios: the behaviour of a bot of a load test, written by its user."""

import random

from esplanade.bots.client import Client
from esplanade.bots.person import Person
from esplanade.protocol.messages import FromClient


class Scenario(Person):
    """One object for every bot; override `on_join` and `on_tick`.

    An error in them ends the visit of its bot, is told with file and line, and fails the run.
    A subclass needs no `__init__`: `on_join` is the place for what it wants to remember.
    """

    _client: Client

    index: int
    """The number of this bot in the run, from 0."""
    random: random.Random
    """Chance that is the same for the same `--seed` and the same bot."""

    async def on_join(self) -> None:
        """The bot stands in the world, and its place is known."""

    async def on_tick(self, tick: int) -> None:
        """A snapshot has come. While this method runs, further ones are passed over."""

    async def _send(self, message: FromClient) -> None:
        await self._client.send(message)
