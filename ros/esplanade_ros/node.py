"""The node of ROS that the bridge runs in: the only module that calls rclpy."""

import argparse
import asyncio
import sys
import threading
from functools import cache
from importlib import import_module
from typing import Any

from esplanade.bots import BotError
from esplanade_ros.bridge import Bridge, Heard
from esplanade_ros.building import built
from esplanade_ros.definitions import DEFINITIONS
from esplanade_ros.mapping import Plain, Topic

QUEUE = 10
"""Messages that ROS keeps of each topic."""


@cache
def class_of(kind: str) -> type[Any]:
    """The class of a kind of message, such as `geometry_msgs/Pose`."""
    package, _, name = kind.partition("/")
    found: type[Any] = getattr(import_module(f"{package}.msg"), name)
    return found


def plain_of(message: Any, kind: str) -> Plain:
    """A message as plain data, those fields of it that the bridge knows."""
    return {
        name: plain_of(getattr(message, name), each)
        if each in DEFINITIONS
        else getattr(message, name)
        for name, each in DEFINITIONS[kind].items()
    }


class RclNode:
    """A node whose callbacks run in a thread of rclpy, and are handed to an event loop."""

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._rclpy = import_module("rclpy")
        self._rclpy.init()
        self._node = self._rclpy.create_node("esplanade")
        self._loop = loop
        self._publishers: dict[Topic, Any] = {}
        self._thread = threading.Thread(target=self._rclpy.spin, args=(self._node,), daemon=True)
        self._thread.start()

    def publish(self, topic: Topic, message: Plain) -> None:
        if topic not in self._publishers:
            made = self._node.create_publisher(class_of(topic.kind), topic.name, QUEUE)
            self._publishers[topic] = made
        self._publishers[topic].publish(built(topic.kind, message, class_of))

    def subscribe(self, topic: Topic, heard: Heard) -> None:
        def received(message: Any) -> None:
            self._loop.call_soon_threadsafe(heard, plain_of(message, topic.kind))

        self._node.create_subscription(class_of(topic.kind), topic.name, received, QUEUE)

    def warn(self, text: str) -> None:
        self._node.get_logger().warning(text)

    def close(self) -> None:
        """End the node."""
        self._rclpy.shutdown()
        self._thread.join()


async def bridged(url: str, name: str) -> None:
    """Run the bridge in a node."""
    node = RclNode(asyncio.get_running_loop())
    try:
        await Bridge(node, url, name).run()
    finally:
        node.close()


def main() -> int:
    """Run the bridge as the command line says."""
    made = argparse.ArgumentParser(prog="ros2 run esplanade_ros bridge", description=__doc__)
    made.add_argument("--url", default="ws://localhost:8080", help="address of the world")
    made.add_argument("--name", default="Robot", help="what others see the robot called")
    options, _ = made.parse_known_args()  # ROS adds arguments of its own
    try:
        asyncio.run(bridged(options.url, options.name))
    except BotError as error:
        print(f"esplanade_ros: {error}", file=sys.stderr)
        return 1
    except ModuleNotFoundError as error:
        print(f"esplanade_ros: {error}; source the setup file of ROS 2 first", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
