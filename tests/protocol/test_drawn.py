"""A client that is written after the page alone draws bodies as the server computes them."""

import numpy as np
import pytest

from esplanade.actors.locomotion.motion import key_poses
from esplanade.actors.locomotion.planted.footprints import HEADING, PLACE
from esplanade.actors.locomotion.reference.posing import pose
from tests.actors.locomotion.step_vectors import sample_steps
from tests.protocol import drawn
from tests.protocol.test_docs import section

SHARES = [0.0, 0.03, 0.11, 0.2, 0.37, 0.5, 0.68, 0.8, 0.94, 1.0]


def step_of(steps: key_poses.Steps, row: int) -> drawn.Step:
    keys = [
        drawn.Key(
            key[key_poses.ROOT],
            key[key_poses.PELVIS],
            key[key_poses.ANKLE],
            float(key[key_poses.SWING_PITCH]),
            float(key[key_poses.STANDING_PITCH]),
            float(key[key_poses.SWING_HEADING]),
            key[key_poses.CHEST],
            key[key_poses.ARMS],
        )
        for key in steps.keys[row]
    ]
    standing, landing = steps.standing[row], steps.landing[row]
    return drawn.Step(
        bool(steps.on_right[row]),
        standing[PLACE],
        float(standing[HEADING]),
        landing[PLACE],
        float(landing[HEADING]),
        float(steps.lift[row]),
        float(steps.flight[row]),
        keys,
    )


@pytest.mark.parametrize("u", SHARES)
def test_every_joint_is_where_the_server_has_it(u: float) -> None:
    steps, sizes = sample_steps()
    joints = pose(steps, np.full(len(steps.lift), u), sizes)
    for row in range(len(steps.lift)):
        leg_m, stature_m = float(sizes.leg_m[row]), float(sizes.stature_m[row])
        found = drawn.drawn(step_of(steps, row), u, leg_m, stature_m)
        for name, theirs in (
            ("root", joints.root),
            ("hips", joints.hips),
            ("knees", joints.knees),
            ("ankles", joints.ankles),
            ("pitches", joints.pitches),
            ("neck", joints.neck),
            ("crown", joints.head),
            ("shoulders", joints.shoulders),
            ("elbows", joints.elbows),
            ("wrists", joints.hands),
        ):
            ours = np.array(getattr(found, name))
            np.testing.assert_allclose(ours, theirs[row], atol=1e-9, err_msg=f"{name}, row {row}")


def test_the_page_has_the_lengths() -> None:
    page = section("Drawing a body").splitlines()
    told = [line.split("|")[3].strip() for line in page if line.startswith(("| from", "| a foot"))]
    lengths = (
        drawn.THIGH, drawn.SHIN, drawn.FOOT, drawn.HIP, drawn.SPINE, drawn.NECK, drawn.CROWN,
        drawn.SHOULDER, drawn.UPPER_ARM, drawn.FOREARM,
    )  # fmt: skip
    assert told == [f"{length:g}" for length in lengths]
