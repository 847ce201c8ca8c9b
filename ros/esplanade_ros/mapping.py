"""Avatars as messages of ROS, and messages of ROS as what a bot does; all as plain data."""

import math
from collections.abc import Iterable, Mapping
from typing import Any, Final, NamedTuple

from esplanade.bots import Avatar
from esplanade.protocol import Kind

Plain = dict[str, Any]

FRAME: Final = "map"
STATURE_M: Final = 1.75
"""The height of a marker whose avatar's is not known."""
COLOURS: Final = {Kind.PERSON: (0.95, 0.7, 0.2), Kind.ACTOR: (0.1, 0.55, 0.5)}
_CYLINDER, _TEXT = 3, 9
_ADD, _DELETE_ALL = 0, 3


class Topic(NamedTuple):
    """A topic and the kind of its messages."""

    name: str
    kind: str


CLOCK: Final = Topic("/clock", "rosgraph_msgs/Clock")
PEOPLE: Final = Topic("/esplanade/people", "geometry_msgs/PoseArray")
ACTORS: Final = Topic("/esplanade/actors", "geometry_msgs/PoseArray")
MARKERS: Final = Topic("/esplanade/markers", "visualization_msgs/MarkerArray")
ODOMETRY: Final = Topic("/esplanade/odom", "nav_msgs/Odometry")
VELOCITY: Final = Topic("/cmd_vel", "geometry_msgs/Twist")
GOAL: Final = Topic("/goal_pose", "geometry_msgs/PoseStamped")


def stamp(time_s: float) -> Plain:
    """A moment of the world, seconds since it began."""
    nanoseconds = round(time_s * 1e9)
    return {"sec": nanoseconds // 10**9, "nanosec": nanoseconds % 10**9}


def header(time_s: float) -> Plain:
    """The header of what is true at a moment."""
    return {"stamp": stamp(time_s), "frame_id": FRAME}


def pose(avatar: Avatar, above_m: float = 0.0) -> Plain:
    """The place of an avatar's feet, or one above them, and the way it faces."""
    return {
        "position": {"x": avatar.x, "y": avatar.y, "z": avatar.z + above_m},
        "orientation": turned(avatar.heading),
    }


def turned(heading: float) -> Plain:
    """The rotation from +x to a heading, radians, about the vertical."""
    return {"x": 0.0, "y": 0.0, "z": math.sin(0.5 * heading), "w": math.cos(0.5 * heading)}


def heading_of(orientation: Mapping[str, float]) -> float:
    """The heading of a rotation, radians from +x; its tilt does not count."""
    x, y, z, w = (float(orientation[name]) for name in "xyzw")
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def poses(avatars: Iterable[Avatar], kind: Kind, time_s: float) -> Plain:
    """A `geometry_msgs/PoseArray` of the avatars of a kind, in the order of their ids."""
    chosen = sorted((a for a in avatars if a.kind == kind), key=lambda a: a.id)
    return {"header": header(time_s), "poses": [pose(avatar) for avatar in chosen]}


def odometry(avatar: Avatar, time_s: float) -> Plain:
    """A `nav_msgs/Odometry` of the robot's own avatar, which walks the way it faces."""
    return {
        "header": header(time_s),
        "child_frame_id": "base_link",
        "pose": {"pose": pose(avatar)},
        "twist": {"twist": {"linear": {"x": avatar.speed, "y": 0.0, "z": 0.0}}},
    }


def markers(avatars: Iterable[Avatar], time_s: float) -> Plain:
    """A `visualization_msgs/MarkerArray`: a cylinder and the name of each avatar, and no others."""
    made: list[Plain] = [{"header": header(time_s), "action": _DELETE_ALL}]
    for avatar in sorted(avatars, key=lambda a: a.id):
        high_m = avatar.stature_m or STATURE_M
        red, green, blue = COLOURS[Kind.ACTOR if avatar.kind == Kind.ACTOR else Kind.PERSON]
        colour = {"r": red, "g": green, "b": blue, "a": 0.4 if avatar.away else 0.9}
        wide_m = 2.0 * avatar.radius
        # Ids on the wire have 32 bits, those of markers are signed.
        shared = {"header": header(time_s), "id": avatar.id & 0x7FFFFFFF, "action": _ADD}
        made.append(
            {
                **shared,
                "ns": "bodies",
                "type": _CYLINDER,
                "pose": pose(avatar, 0.5 * high_m),
                "scale": {"x": wide_m, "y": wide_m, "z": high_m},
                "color": colour,
            }
        )
        made.append(
            {
                **shared,
                "ns": "names",
                "type": _TEXT,
                "pose": pose(avatar, high_m + 0.25),
                "scale": {"x": 0.0, "y": 0.0, "z": 0.25},
                "color": {"r": 1.0, "g": 1.0, "b": 1.0, "a": 1.0},
                "text": avatar.name,
            }
        )
    return {"markers": made}


def movement(twist: Mapping[str, Mapping[str, float]], heading: float) -> tuple[float, float]:
    """Direction, radians from +x, and speed, m/s, of a velocity in the frame of a robot.

    Raises
    ------
    ValueError
        A number is not finite.
    """
    x, y = float(twist["linear"]["x"]), float(twist["linear"]["y"])
    if not (math.isfinite(x) and math.isfinite(y)):
        raise ValueError(f"a velocity must be finite, got ({x}, {y})")
    return math.remainder(heading + math.atan2(y, x), math.tau), math.hypot(x, y)


def goal(stamped: Mapping[str, Any]) -> tuple[float, float, float]:
    """The place that a `geometry_msgs/PoseStamped` means: x, y and the height of the floor, metres.

    Raises
    ------
    ValueError
        It is in another frame, or a number is not finite.
    """
    frame = stamped["header"]["frame_id"]
    if frame not in ("", FRAME):
        raise ValueError(f"a goal must be in the frame {FRAME}, got {frame}")
    position = stamped["pose"]["position"]
    x, y, z = (float(position[name]) for name in "xyz")
    if not all(map(math.isfinite, (x, y, z))):
        raise ValueError(f"a goal must be finite, got ({x}, {y}, {z})")
    return x, y, z
