"""Walking with real steps: gait, footprints and inverse kinematics, for many avatars at once."""

from esplanade.actors.locomotion.footsteps.planner import plan_steps
from esplanade.actors.locomotion.gait.curves import leg_angles
from esplanade.actors.locomotion.gait.step_length import solve_relative_velocity

__all__ = ["leg_angles", "plan_steps", "solve_relative_velocity"]
