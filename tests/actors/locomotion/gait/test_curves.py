import numpy as np
import pytest

from esplanade.actors.locomotion.gait import curves
from esplanade.actors.locomotion.gait.curves import leg_angles
from esplanade.actors.locomotion.reference import body_curves

GOLDEN = [
    (0.25, 0.0, (11.018519, 3.0, -3.0)),
    (0.25, 0.25, (0.023148, 3.0, -5.834683)),
    (0.25, 0.5, (-7.5, 9.344023, 2.5)),
    (0.25, 0.75, (6.171875, 35.0, -9.240076)),
    (1.0, 0.0, (22.037037, 3.0, -3.0)),
    (1.0, 0.5, (-15.0, 16.282799, 8.0)),
    (1.0, 0.75, (12.343750, 70.0, -11.235306)),
    (2.0, 0.0, (26.915515, 4.365193, -0.941176)),
    (2.0, 0.5, (-15.0, 17.320517, 0.717879)),
]


def everything(rv, phase):
    """All curves side by side, (N, 16)."""
    rv, phase = np.broadcast_arrays(np.asarray(rv, dtype=float), np.asarray(phase, dtype=float))
    return np.column_stack(
        [
            leg_angles(rv, phase),
            *body_curves.pelvis_motion(rv, phase),
            *body_curves.upper_angles(rv, phase),
        ]
    )


@pytest.mark.parametrize(("rv", "phase", "degrees"), GOLDEN)
def test_published_values(rv, phase, degrees):
    assert np.degrees(leg_angles([rv], [phase]))[0] == pytest.approx(degrees, abs=1e-6)


@pytest.mark.parametrize("rv", [0.0, 0.03, 0.4, 0.9, 1.7, 3.0])
def test_a_cycle_closes(rv):
    phase = np.linspace(0.0, 1.0, 401)
    there = everything(rv, phase)
    assert everything(rv, phase + 1.0) == pytest.approx(there, abs=1e-12)
    assert there[0] == pytest.approx(there[-1], abs=1e-12)


@pytest.mark.parametrize("border", [0.05, 0.5, 1.3])
def test_stretches_of_velocity_meet(border):
    phase = np.linspace(0.0, 1.0, 200)
    below, above = everything(border - 1e-10, phase), everything(border + 1e-10, phase)
    assert below == pytest.approx(above, abs=1e-8)
    assert leg_angles(np.full(200, border - 1e-10), phase) == pytest.approx(
        leg_angles(np.full(200, border + 1e-10), phase), abs=1e-9
    )


@pytest.mark.parametrize("rv", [0.02, 0.3, 0.8, 2.0])
def test_no_curve_jumps_within_a_cycle(rv):
    phase = np.linspace(0.0, 1.0, 4001)
    assert np.abs(np.diff(everything(rv, phase), axis=0)).max() < 0.02


def test_without_speed_legs_are_straight():
    assert leg_angles(np.zeros(50), np.linspace(0.0, 1.0, 50)) == pytest.approx(np.zeros((50, 3)))


def test_published_curves_keep_their_constants_at_rest():
    at_rest = curves.joint_angles(np.zeros(1), np.zeros(1), faded=False)
    assert np.degrees(at_rest)[0] == pytest.approx((0.0, 3.0, -3.0))


def test_a_curve_is_its_stretches_one_by_one():
    """The sum over all stretches against a search for the one that holds the phase."""
    rng = np.random.default_rng(5)
    for rv in (0.2, 0.7, 2.5):
        for keys in curves.leg_keys(np.array(rv)):
            times = [float(time) for time, _ in keys] + [float(keys[0][0]) + 1.0]
            values = [float(value) for _, value in keys] + [float(keys[0][1])]
            for phase in rng.uniform(times[0], times[0] + 1.0, 40):
                part = max(i for i, time in enumerate(times[:-1]) if time <= phase)
                s = (phase - times[part]) / (times[part + 1] - times[part])
                expected = values[part] + (values[part + 1] - values[part]) * s * s * (3 - 2 * s)
                assert curves.eval_curve(keys, np.array(phase)) == pytest.approx(expected)


@pytest.mark.parametrize("rv", [-0.1, 3.1, np.nan])
def test_velocities_that_do_not_exist(rv):
    with pytest.raises(ValueError, match="relative velocities"):
        leg_angles([0.2, rv], [0.0, 0.0])


def test_a_phase_that_is_no_number():
    with pytest.raises(ValueError, match="phase"):
        leg_angles([0.2], [np.inf])
