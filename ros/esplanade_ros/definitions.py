"""The messages of ROS 2 that the bridge uses, as their packages define them."""

from typing import Final

Fields = dict[str, str]

DEFINITIONS: Final[dict[str, Fields]] = {
    "builtin_interfaces/Time": {"sec": "int32", "nanosec": "uint32"},
    "builtin_interfaces/Duration": {"sec": "int32", "nanosec": "uint32"},
    "rosgraph_msgs/Clock": {"clock": "builtin_interfaces/Time"},
    "std_msgs/Header": {"stamp": "builtin_interfaces/Time", "frame_id": "string"},
    "std_msgs/ColorRGBA": {"r": "float", "g": "float", "b": "float", "a": "float"},
    "geometry_msgs/Point": {"x": "double", "y": "double", "z": "double"},
    "geometry_msgs/Vector3": {"x": "double", "y": "double", "z": "double"},
    "geometry_msgs/Quaternion": {"x": "double", "y": "double", "z": "double", "w": "double"},
    "geometry_msgs/Pose": {
        "position": "geometry_msgs/Point",
        "orientation": "geometry_msgs/Quaternion",
    },
    "geometry_msgs/PoseStamped": {"header": "std_msgs/Header", "pose": "geometry_msgs/Pose"},
    "geometry_msgs/PoseArray": {
        "header": "std_msgs/Header",
        "poses": "sequence<geometry_msgs/Pose>",
    },
    "geometry_msgs/Twist": {
        "linear": "geometry_msgs/Vector3",
        "angular": "geometry_msgs/Vector3",
    },
    "geometry_msgs/PoseWithCovariance": {
        "pose": "geometry_msgs/Pose",
        "covariance": "double[36]",
    },
    "geometry_msgs/TwistWithCovariance": {
        "twist": "geometry_msgs/Twist",
        "covariance": "double[36]",
    },
    "nav_msgs/Odometry": {
        "header": "std_msgs/Header",
        "child_frame_id": "string",
        "pose": "geometry_msgs/PoseWithCovariance",
        "twist": "geometry_msgs/TwistWithCovariance",
    },
    "visualization_msgs/Marker": {
        "header": "std_msgs/Header",
        "ns": "string",
        "id": "int32",
        "type": "int32",
        "action": "int32",
        "pose": "geometry_msgs/Pose",
        "scale": "geometry_msgs/Vector3",
        "color": "std_msgs/ColorRGBA",
        "lifetime": "builtin_interfaces/Duration",
        "text": "string",
    },
    "visualization_msgs/MarkerArray": {"markers": "sequence<visualization_msgs/Marker>"},
}
"""Fields by message, types as `get_fields_and_field_types()` of the classes names them. A marker
has further fields, which stay as they are."""
