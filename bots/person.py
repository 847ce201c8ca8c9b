"""A person who is moved by a script: the base of bots and of scenarios."""

from collections.abc import Mapping
from types import MappingProxyType

from esplanade.bots.view import Avatar, View
from esplanade.protocol.codes import Gesture
from esplanade.protocol.looks import Look
from esplanade.protocol.messages import (
    ChatLine,
    ChooseLook,
    FromClient,
    MakeGesture,
    Move,
    Presence,
    WalkTo,
    Watch,
    Welcome,
)


class Person:
    """A person in the world who is moved by a script; subclasses say how messages are sent."""

    welcome: Welcome
    """The server's welcome, with the scene in `welcome.scene`."""
    _view: View
    _sequence = 0

    async def _send(self, message: FromClient) -> None:
        raise NotImplementedError

    # --- what it knows --------------------------------------------------------------------------

    @property
    def id(self) -> int:
        return self.welcome.id

    @property
    def name(self) -> str:
        return self.welcome.name

    @property
    def position(self) -> tuple[float, float, float]:
        """Own place (x, y, z) of the newest snapshot, metres; z is the height of the feet."""
        own = self._view.own
        return own.x, own.y, own.z

    @property
    def others(self) -> Mapping[int, Avatar]:
        """Everyone else in view, by id; changes as snapshots come in."""
        return MappingProxyType(self._view.others)

    # --- what it does ---------------------------------------------------------------------------

    async def move(self, direction: float, speed: float) -> int:
        """Walk in `direction` (radians from +x) at `speed` (m/s) until told otherwise.

        Returns the sequence number, which a snapshot acknowledges once the server has heeded it.
        """
        self._sequence += 1
        await self._send(Move(seq=self._sequence, direction=direction, speed=speed))
        return self._sequence

    async def stop(self) -> int:
        """Stand still."""
        return await self.move(self._view.own.heading, 0.0)

    async def walk_to(self, x: float, y: float, z: float = 0.0) -> int:
        """Walk to a point (metres) around what stands in the way; returns as `move` does.

        Of several floors at (x, y) the one nearest in height to z is meant.
        """
        self._sequence += 1
        await self._send(WalkTo(seq=self._sequence, x=x, y=y, z=z))
        return self._sequence

    async def chat(self, text: str) -> None:
        """Say a line to everyone who has this avatar in view."""
        await self._send(ChatLine(text=text))

    async def gesture(self, gesture: Gesture) -> None:
        """Make a gesture that everyone sees who has this avatar in view."""
        await self._send(MakeGesture(gesture=gesture))

    async def be_away(self, away: bool = True) -> None:
        """Say that nobody looks through this avatar's eyes for now, or that somebody does again."""
        await self._send(Presence(away=away))

    async def wear(self, look: Look) -> None:
        """Look otherwise from now on."""
        await self._send(ChooseLook(look=look))

    async def watch(self, actor_id: int | None) -> None:
        """Ask for the plans of an actor in view, or for none any more."""
        await self._send(Watch(id=actor_id))
