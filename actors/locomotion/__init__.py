"""Walking with real steps: gait, footprints and inverse kinematics, for many avatars at once."""

from esplanade.actors.locomotion.curves import leg_angles
from esplanade.actors.locomotion.planner import plan_steps
from esplanade.actors.locomotion.step_length import solve_relative_velocity

__all__ = ["leg_angles", "plan_steps", "solve_relative_velocity"]
