"""Keys of bodies that stand."""

from __future__ import annotations

import numpy as np

from esplanade.actors.locomotion.motion._transition_kernels import fill_keys
from esplanade.actors.locomotion.motion.key_poses import KEYS, WIDTH
from esplanade.actors.locomotion.planted.footprints import StepFootprints
from esplanade.actors.locomotion.planted.step import step_targets
from esplanade.planning.compiled.arrays import Floats


def standing_keys(footprints: StepFootprints) -> Floats:
    """Keys, float64 (N, KEYS, WIDTH), of bodies that just stand on two footprints."""
    still = np.empty((len(footprints.on_right), 1, WIDTH))
    fill_keys(step_targets(footprints, np.zeros(1)), footprints, still)
    return np.repeat(still, KEYS, axis=1)
