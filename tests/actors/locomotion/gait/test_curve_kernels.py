"""The curves written out for one step against those for all phases and velocities."""

import numpy as np
import pytest

from esplanade.actors.locomotion.gait import _curve_kernels as kernels
from esplanade.actors.locomotion.gait import curves
from esplanade.actors.locomotion.reference import body_curves

VELOCITIES = (0.0, 0.02, 0.2, 0.35, 0.5)
SHARES = np.linspace(0.0, 1.0, 41)


@pytest.mark.parametrize("rv", VELOCITIES)
def test_the_swinging_leg(rv):
    found = [kernels.swing_leg(rv, u) for u in SHARES]
    expected = curves.leg_angles(np.full(41, rv), 0.5 + 0.5 * SHARES)
    assert np.array(found) == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("rv", VELOCITIES)
def test_the_pelvis(rv):
    found = np.array([kernels.pelvis(rv, u) for u in SHARES])
    motion = body_curves.pelvis_motion(np.full(41, rv), 0.5 * SHARES)
    expected = np.column_stack([motion.left, motion.yaw, motion.lean, motion.roll])
    assert found == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("rv", VELOCITIES)
def test_chest_and_arms(rv):
    at = np.full(41, rv)
    near, far = (
        body_curves.upper_angles(at, 0.5 * SHARES),
        body_curves.upper_angles(at, 0.5 + 0.5 * SHARES),
    )
    torsion = [kernels.chest_torsion(rv, u) for u in SHARES]
    assert np.array(torsion) == pytest.approx(near.torsion, abs=1e-12)
    for upper, phases in ((near, 0.5 * SHARES), (far, 0.5 + 0.5 * SHARES)):
        found = np.array([kernels.arm(rv, phase) for phase in phases])
        assert found == pytest.approx(np.column_stack([upper.shoulder, upper.elbow]), abs=1e-12)


def test_support():
    for rv in VELOCITIES:
        assert kernels.support_share(rv) == pytest.approx(curves.support_share(np.array(rv)))
