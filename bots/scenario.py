"""The base of scenarios: what a bot of a load test does, written by its user."""

import random
from collections.abc import Mapping
from types import MappingProxyType

from esplanade.bots.client import Client
from esplanade.bots.view import Avatar, View
from esplanade.protocol.messages import ChatLine, Move, WalkTo, Watch, Welcome


class Scenario:
    """One object for every bot; override `on_join` and `on_tick`.

    An error in them ends the visit of its bot, is told with file and line, and fails the run.
    A subclass needs no `__init__`: `on_join` is the place for what it wants to remember.
    """

    _client: Client
    _view: View
    _sequence = 0

    index: int
    """The number of this bot in the run, from 0."""
    random: random.Random
    """Chance that is the same for the same `--seed` and the same bot."""

    async def on_join(self) -> None:
        """The bot stands in the world, and its place is known."""

    async def on_tick(self, tick: int) -> None:
        """A snapshot has come. While this method runs, further ones are passed over."""

    # --- what it knows --------------------------------------------------------------------------

    @property
    def welcome(self) -> Welcome:
        """The server's welcome, with the scene in `welcome.scene`."""
        return self._client.welcome

    @property
    def id(self) -> int:
        return self.welcome.id

    @property
    def name(self) -> str:
        return self.welcome.name

    @property
    def position(self) -> tuple[float, float, float]:
        """Own place (x, y, z) of the newest snapshot, metres."""
        own = self._view.own
        return own.x, own.y, own.z

    @property
    def others(self) -> Mapping[int, Avatar]:
        """Everyone else in view, by id; changes as snapshots come in."""
        return MappingProxyType(self._view.others)

    # --- what it does ---------------------------------------------------------------------------

    async def move(self, direction: float, speed: float) -> None:
        """Walk in `direction` (radians from +x) at `speed` (m/s) until told otherwise."""
        self._sequence += 1
        await self._client.send(Move(seq=self._sequence, direction=direction, speed=speed))

    async def stop(self) -> None:
        """Stand still."""
        await self.move(self._view.own.heading, 0.0)

    async def walk_to(self, x: float, y: float, z: float = 0.0) -> None:
        """Walk to a point (metres) around what stands in the way."""
        self._sequence += 1
        await self._client.send(WalkTo(seq=self._sequence, x=x, y=y, z=z))

    async def chat(self, text: str) -> None:
        """Say a line to everyone who has this avatar in view."""
        await self._client.send(ChatLine(text=text))

    async def watch(self, actor_id: int | None) -> None:
        """Ask for the plans of an actor in view, or for none any more."""
        await self._client.send(Watch(id=actor_id))
