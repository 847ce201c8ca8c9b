"""Walking with real steps: gait, footprints and inverse kinematics, for many avatars at once."""

from actors.locomotion.curves import leg_angles
from actors.locomotion.planner import plan_steps
from actors.locomotion.step_length import solve_relative_velocity

__all__ = ["leg_angles", "plan_steps", "solve_relative_velocity"]
