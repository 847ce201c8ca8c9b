"""The rules of an episode: bodies, speeds, limits, and the definitions of what is measured."""

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True)
class Rules:
    """The rules that all policies share. Lengths are in metres, times in seconds."""

    tick_s: float = 0.1
    robot_radius_m: float = 0.25
    person_radius_m: float = 0.25
    speed_mps: float = 1.3
    """The preferred speed; times are compared with that of the straight line at this speed."""
    max_speed_mps: float = 1.7
    max_acceleration_mps2: float | None = 2.0
    """The greatest acceleration; None means no limit."""
    goal_tolerance_m: float = 0.3
    time_limit_s: float = 60.0
    near_m: float = 0.2
    """A distance between the surfaces of two bodies below this is uncomfortably near."""
    sensor_range_m: float = 15.0
    """A policy is given only the people within this distance of the robot."""
    past_ticks: int = 32
    """A policy is given this many past positions of each person."""
    pop_in_m: float = 1.5
    """People whose recording begins nearer than this to the robot are left out of the episode,
    because nothing could foresee them."""
    wall_overlap_m: float = 0.1
    """Walls are drawn by hand, so only an overlap with the body beyond this counts as contact."""
    clearance_cap_m: float = 2.0
    """Larger clearances count as this."""
    people: Literal["recorded", "reacting"] = "recorded"
    """`recorded` people walk as they did whatever happens, `reacting` ones evade the robot."""
    reaction: float = 1.0
    """Factor of the evasion that was measured on people."""
    people_seed: int = 0
    """Draws how strongly each single person reacts."""

    @property
    def contact_m(self) -> float:
        """The distance between the centres of two bodies that touch."""
        return self.robot_radius_m + self.person_radius_m
