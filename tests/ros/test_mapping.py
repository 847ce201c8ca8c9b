"""Views of a bot become messages that ROS would take, and wishes of ROS become movements."""

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.bots import Avatar
from esplanade.protocol import Kind, Reason
from esplanade_ros import mapping
from esplanade_ros.building import MessageError, built
from esplanade_ros.mapping import Topic
from tests.ros.classes import class_of


def avatar(number: int, kind: Kind = Kind.PERSON, **more: Any) -> Avatar:
    given = {"x": 1.0 + number, "y": 2.0, "z": 3.0, "heading": 0.5, "speed": 1.25, **more}
    return Avatar(number, kind, f"A{number}", layer=0, reason=Reason.NONE, radius=0.25, **given)


SEEN = [avatar(7, Kind.ACTOR), avatar(3), avatar(2**32 - 1, stature_m=1.6), avatar(5, away=True)]


@pytest.mark.parametrize(
    ("topic", "plain"),
    [
        (mapping.CLOCK, {"clock": mapping.stamp(12.05)}),
        (mapping.PEOPLE, mapping.poses(SEEN, Kind.PERSON, 12.05)),
        (mapping.ACTORS, mapping.poses(SEEN, Kind.ACTOR, 12.05)),
        (mapping.MARKERS, mapping.markers(SEEN, 12.05)),
        (mapping.ODOMETRY, mapping.odometry(SEEN[0], 12.05)),
    ],
)
def test_ros_would_take_every_message(topic: Topic, plain: dict[str, Any]) -> None:
    made = built(topic.kind, plain, class_of)
    assert type(made) is class_of(topic.kind)


def test_people_and_actors_are_apart_and_in_the_order_of_their_ids() -> None:
    made = built("geometry_msgs/PoseArray", mapping.poses(SEEN, Kind.PERSON, 0.0), class_of)
    assert [pose.position.x for pose in made.poses] == [4.0, 6.0, 2.0**32]
    assert made.header.frame_id == "map"
    made = built("geometry_msgs/PoseArray", mapping.poses(SEEN, Kind.ACTOR, 0.0), class_of)
    assert [pose.position.x for pose in made.poses] == [8.0]
    assert made.poses[0].position.z == 3.0


def test_markers_begin_with_none_and_name_everybody() -> None:
    made = built("visualization_msgs/MarkerArray", mapping.markers(SEEN, 0.0), class_of)
    first, *rest = made.markers
    assert first.action == 3
    assert [m.text for m in rest if m.ns == "names"] == ["A3", "A5", "A7", f"A{2**32 - 1}"]
    bodies = [m for m in rest if m.ns == "bodies"]
    assert bodies[-1].scale.z == 1.6
    assert bodies[1].color.a < bodies[0].color.a  # whose person is away
    assert len({(m.ns, m.id) for m in rest}) == 2 * len(SEEN)


@given(st.floats(-10.0, 10.0))
def test_a_heading_survives_its_quaternion(heading: float) -> None:
    found = mapping.heading_of(mapping.turned(heading))
    assert math.remainder(found - heading, math.tau) == pytest.approx(0.0, abs=1e-9)


@given(st.floats(0.0, 1e6))
def test_a_stamp_is_the_moment(time_s: float) -> None:
    found = mapping.stamp(time_s)
    assert 0 <= found["nanosec"] < 10**9
    assert found["sec"] + 1e-9 * found["nanosec"] == pytest.approx(time_s, abs=1e-6)


def twist(x: float, y: float) -> dict[str, Any]:
    return {"linear": {"x": x, "y": y, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": 0.0}}


def test_velocities_are_in_the_frame_of_the_robot() -> None:
    direction, speed = mapping.movement(twist(0.0, 1.2), math.pi / 2)
    assert abs(direction) == pytest.approx(math.pi)
    assert speed == pytest.approx(1.2)
    with pytest.raises(ValueError, match="must be finite"):
        mapping.movement(twist(math.nan, 0.0), 0.0)


def test_goals_are_those_of_the_map() -> None:
    position = {"x": 1.0, "y": 2.0, "z": 3.5}
    stamped = {"header": {"frame_id": "map"}, "pose": {"position": position}}
    assert mapping.goal(stamped) == (1.0, 2.0, 3.5)
    with pytest.raises(ValueError, match="must be in the frame map, got odom"):
        mapping.goal({**stamped, "header": {"frame_id": "odom"}})


def test_a_field_that_is_not_there_is_named() -> None:
    with pytest.raises(MessageError, match="geometry_msgs/Point has no field w; it has x, y, z"):
        built("geometry_msgs/Point", {"w": 1.0}, class_of)
