"""A robot of ROS walks in a real world; only rclpy is replaced."""

import asyncio
import math
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from esplanade import bots
from esplanade.server.app import running
from esplanade.server.settings import ServerSettings
from esplanade_ros import mapping
from esplanade_ros.bridge import Bridge, Heard
from esplanade_ros.building import built
from esplanade_ros.mapping import Plain, Topic
from tests.patience import COMPILING_PATIENCE_S
from tests.ros.classes import class_of
from tests.server.populated import HALL


class Recorder:
    """Keeps what is published, as messages that ROS would take, and says what ROS wants."""

    def __init__(self) -> None:
        self.latest: dict[str, Any] = {}
        self.heard: dict[str, Heard] = {}
        self.warned: list[str] = []
        self.counts: defaultdict[str, int] = defaultdict(int)

    def publish(self, topic: Topic, message: Plain) -> None:
        self.latest[topic.name] = built(topic.kind, message, class_of)
        self.counts[topic.name] += 1

    def subscribe(self, topic: Topic, heard: Heard) -> None:
        self.heard[topic.name] = heard

    def warn(self, text: str) -> None:
        self.warned.append(text)

    def place(self) -> tuple[float, float]:
        if "/esplanade/odom" not in self.latest:
            return math.nan, math.nan
        position = self.latest["/esplanade/odom"].pose.pose.position
        return position.x, position.y


async def until(holds: Callable[[], bool]) -> None:
    while not holds():  # noqa: ASYNC110 - topics have no event
        await asyncio.sleep(0.02)


async def test_a_robot_sees_and_walks(tmp_path: Path) -> None:
    scene = tmp_path / "hall.json"
    scene.write_text(HALL.model_dump_json(exclude_defaults=True))
    settings = ServerSettings(scene=scene, actors=2, seed=4, port=0, private_port=0)
    ros = Recorder()
    async with asyncio.timeout(COMPILING_PATIENCE_S), running(settings) as server:
        url = f"ws://127.0.0.1:{server.port}"
        bridge = asyncio.create_task(Bridge(ros, url, "Robbie").run())
        async with bots.connect(url, "Ann") as ann:
            await until(lambda: len(getattr(ros.latest.get("/esplanade/people"), "poses", ())) == 1)
            assert len(ros.latest["/esplanade/actors"].poses) == 2
            pose = ros.latest["/esplanade/people"].poses[0].position
            assert (pose.x, pose.y) == pytest.approx(ann.position[:2], abs=0.05)
            names = [m.text for m in ros.latest["/esplanade/markers"].markers if m.text]
            assert "Ann" in names
        x, y = ros.place()
        orientation = ros.latest["/esplanade/odom"].pose.pose.orientation
        heading = mapping.heading_of({name: getattr(orientation, name) for name in "xyzw"})
        ahead = {"x": 0.4, "y": 0.0, "z": 0.0}
        ros.heard["/cmd_vel"]({"linear": ahead, "angular": ahead})
        await until(lambda: math.dist(ros.place(), (x, y)) > 0.3)
        now = ros.place()
        way = math.atan2(now[1] - y, now[0] - x)
        assert math.remainder(way - heading, math.tau) == pytest.approx(0.0, abs=0.3)
        goal = {"x": 3.0, "y": 5.0, "z": 0.0}
        stamped = {"header": {"frame_id": "map"}, "pose": {"position": goal}}
        ros.heard["/goal_pose"](stamped)
        await until(lambda: math.dist(ros.place(), (3.0, 5.0)) < 0.5)
        ros.heard["/goal_pose"]({**stamped, "header": {"frame_id": "odom"}})
        await until(lambda: bool(ros.warned))
        clock = ros.latest["/clock"].clock
        assert clock.sec + 1e-9 * clock.nanosec > 0.0
        bridge.cancel()
    assert ros.warned == ["/goal_pose: a goal must be in the frame map, got odom"]
    assert ros.counts["/clock"] == ros.counts["/esplanade/odom"] > 10
