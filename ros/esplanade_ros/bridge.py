"""The bridge: a bot in a world, what it sees as topics, and topics as what it does."""

import asyncio
from collections.abc import Callable
from typing import Any, Protocol

from esplanade import bots
from esplanade.bots import Bot, SnapshotEvent
from esplanade.protocol import Kind
from esplanade_ros import mapping
from esplanade_ros.mapping import Plain, Topic

Heard = Callable[[Plain], None]


class Ros(Protocol):
    """The other end: topics of ROS, with messages as plain data."""

    def publish(self, topic: Topic, message: Plain) -> None: ...

    def subscribe(self, topic: Topic, heard: Heard) -> None:
        """Call `heard` with each message, in the thread of the event loop."""

    def warn(self, text: str) -> None: ...


class Bridge:
    """A robot of ROS in a world; `run` joins and stays until the server says goodbye."""

    def __init__(self, ros: Ros, url: str, name: str) -> None:
        self._ros = ros
        self._url = url
        self._name = name
        self._bot: Bot | None = None
        self._wanted: asyncio.Queue[tuple[Topic, Plain]] = asyncio.Queue(1)
        """The newest wish; one that comes before it is carried out takes its place."""

    async def run(self) -> None:
        """Be in the world.

        Raises
        ------
        BotError
            The server cannot be reached, refuses, or is gone.
        """
        for topic in (mapping.VELOCITY, mapping.GOAL):
            self._ros.subscribe(topic, lambda message, topic=topic: self._want(topic, message))  # type: ignore[misc]
        async with bots.connect(self._url, self._name) as bot:
            self._bot = bot
            obeying = asyncio.create_task(self._obey(bot))
            try:
                async for event in bot.events():
                    if isinstance(event, SnapshotEvent):
                        self._tell(bot)
            finally:
                self._bot = None
                obeying.cancel()

    def _tell(self, bot: Bot) -> None:
        time_s, others = bot.server_time, list(bot.others.values())
        publish = self._ros.publish
        publish(mapping.CLOCK, {"clock": mapping.stamp(time_s)})
        publish(mapping.PEOPLE, mapping.poses(others, Kind.PERSON, time_s))
        publish(mapping.ACTORS, mapping.poses(others, Kind.ACTOR, time_s))
        publish(mapping.MARKERS, mapping.markers(others, time_s))
        publish(mapping.ODOMETRY, mapping.odometry(bot.avatar, time_s))

    def _want(self, topic: Topic, message: Plain) -> None:
        if self._wanted.full():
            self._wanted.get_nowait()
        self._wanted.put_nowait((topic, message))

    async def _obey(self, bot: Bot) -> None:
        while True:
            topic, message = await self._wanted.get()
            try:
                await self._do(bot, topic, message)
            except (KeyError, TypeError, ValueError) as error:
                self._ros.warn(f"{topic.name}: {error}")

    async def _do(self, bot: Bot, topic: Topic, message: dict[str, Any]) -> None:
        if topic == mapping.GOAL:
            x, y, z = mapping.goal(message)
            await bot.walk_to(x, y, z)
            return
        direction, speed_mps = mapping.movement(message, bot.avatar.heading)
        await bot.move(direction, speed_mps)
