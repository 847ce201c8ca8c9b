"""The rules of an episode: bodies, speeds, limits, and what counts as what."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Rules:
    """What every policy is held to. Lengths in metres, times in seconds."""

    tick_s: float = 0.1
    robot_radius_m: float = 0.25
    person_radius_m: float = 0.25
    speed_mps: float = 1.3
    """Preferred speed: the time of the straight way is measured against it."""
    max_speed_mps: float = 1.7
    max_acceleration_mps2: float | None = 2.0
    """Greatest change of velocity; None: no limit."""
    goal_tolerance_m: float = 0.3
    time_limit_s: float = 60.0
    near_m: float = 0.2
    """Nearer than this, skin to skin, is too near to be pleasant."""
    sight_m: float = 15.0
    """Others farther away are not shown."""
    past_ticks: int = 32
    """So much of everyone's past is shown."""
    pop_in_m: float = 1.5
    """Whose recording begins nearer than this to the robot is left out: nobody could foresee it."""
    wall_overlap_m: float = 0.1
    """Walls are drawn by hand; deeper than this into the body counts as contact."""
    clearance_cap_m: float = 2.0
    """Clearances are measured up to here."""

    @property
    def contact_m(self) -> float:
        """Distance of centres at contact."""
        return self.robot_radius_m + self.person_radius_m
