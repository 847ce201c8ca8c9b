"""Commands of a script on actors, doors and people."""

from collections.abc import Mapping, Sequence
from typing import Any

from esplanade.operators.conversation import Conversation
from esplanade.protocol.commands import Answer


class Directing(Conversation):
    """Commands on actors, doors and people."""

    async def send_actor(self, actor: str, target: str | Sequence[float]) -> Answer:
        """Send an actor to a place of the scene, or to x, y and height."""
        to: Any = target if isinstance(target, str) else list(target)
        return await self.send({"op": "send_actor", "actor": actor, "target": to})

    async def hold(self, actor: str, *, held: bool = True) -> Answer:
        """Let an actor stand where it is, or go on."""
        return await self.send({"op": "hold_actor", "actor": actor, "held": held})

    async def behave(self, behaviour: str | Mapping[str, Any], *actors: str) -> Answer:
        """Let actors do something else: a kind of behaviour, or all that can be said of one."""
        given = {"kind": behaviour} if isinstance(behaviour, str) else dict(behaviour)
        return await self.send({"op": "set_behaviour", "actors": actors, "behaviour": given})

    async def add(self, *actors: Mapping[str, Any]) -> Answer:
        """Let actors come in; of each, `id`, `name`, `behaviour`, `tags`, `overrides`, `place`."""
        return await self.send({"op": "add_actors", "actors": [dict(each) for each in actors]})

    async def remove(self, *actors: str) -> Answer:
        """Take actors out of the world."""
        return await self.send({"op": "remove_actors", "actors": actors})

    async def door(self, name: str, *, is_open: bool) -> Answer:
        """Open or close a door."""
        return await self.send({"op": "move_door", "door": name, "open": is_open})

    async def pace(self, factor: float) -> Answer:
        """Let the time of the world run slower or faster; 1 is usual."""
        return await self.send({"op": "pace", "factor": factor})

    async def pause(self, *, paused: bool = True) -> Answer:
        """Let time stand, or run again."""
        return await self.send({"op": "pace", "pause": paused})

    async def step(self, ticks: int = 1) -> Answer:
        """Let a world that is paused go on by some ticks."""
        return await self.send({"op": "pace", "step": ticks})

    async def record(self, *, on: bool = True) -> Answer:
        """Begin to record the world, or end the recording."""
        return await self.send({"op": "record", "on": on})

    async def announce(self, text: str, **whom: Any) -> Answer:
        """Say something to all people, or to those whom `storey_m`, `polygon`, or `near_actor`
        with `radius_m` mean."""
        return await self.send({"op": "announce", "text": text, **whom})

    async def mark(self, text: str) -> Answer:
        """Mark this moment."""
        return await self.send({"op": "mark", "text": text})

    async def mute(self, person: int, seconds: float = 600.0) -> Answer:
        """Let nobody hear a person for a time; 0 ends it."""
        return await self.send({"op": "mute", "person": person, "seconds": seconds})

    async def kick(self, person: int, text: str | None = None) -> Answer:
        """Send a person out."""
        more = {} if text is None else {"text": text}
        return await self.send({"op": "kick", "person": person, **more})

    async def warn(self, person: int, text: str) -> Answer:
        """Say something to one person, as a warning."""
        return await self.send({"op": "warn", "person": person, "text": text})

    async def walk_out(self, person: int, text: str | None = None) -> Answer:
        """Let a person's avatar walk to a place of arrival, where the person leaves."""
        more = {} if text is None else {"text": text}
        return await self.send({"op": "walk_out", "person": person, **more})

    async def ban(self, person: int | None = None, **more: Any) -> Answer:
        """Let somebody in no more: a person, or whoever has a `name_pattern` or an `address`.

        `by`, `until_s` and `text` are those of the command.
        """
        whom = {} if person is None else {"person": person}
        return await self.send({"op": "ban", **whom, **more})

    async def unban(self, ban: int) -> Answer:
        """Let a ban hold no more."""
        return await self.send({"op": "unban", "ban": ban})
