"""Two other definitions of a step's length, with the curves as published.

`gait/step_length.py` has the one that the world walks with. Lengths are in leg lengths; relative
velocities must lie in [0, .5], else a ValueError is raised.
"""

from numpy.typing import ArrayLike

from esplanade.actors.locomotion.body.skeleton import FOOT
from esplanade.actors.locomotion.gait.step_length import (
    checked_step_velocities,
    straight_double_support,
)
from esplanade.planning.compiled.arrays import Floats


def sl_paper(rv: ArrayLike) -> Floats:
    """Length from heel to heel: Jing et al. 2015, eq. (10)."""
    pose = straight_double_support(checked_step_velocities(rv), faded=False)
    return pose.front_forward - pose.rear_forward


def sl_noslide(rv: ArrayLike) -> Floats:
    """Length of a step whose foot rolls from heel to toe without sliding: eqs. (6) and (9)."""
    pose = straight_double_support(checked_step_velocities(rv), faded=False)
    return pose.front_forward - pose.rear_toe_forward + FOOT
