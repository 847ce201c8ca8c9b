"""The same inputs make the same walk, and without a reason nobody leaves the recording."""

import hashlib
import subprocess
import sys

import numpy as np
import pytest

from esplanade.pedestrians import ReactingCrowd, SocialForce
from tests.pedestrians.worlds import STANDING_ACTOR, TICK_S, crowded


def test_without_actors_the_crowd_is_the_recording_bit_for_bit() -> None:
    crowd = crowded()
    walk = crowd.begin(0)
    for _ in range(150):
        walk.step()
        np.testing.assert_array_equal(walk.positions, walk.recorded)
    assert walk.displacement_m.max() == 0.0


def test_at_scale_0_nobody_reacts_bit_for_bit() -> None:
    crowd = crowded()
    still = ReactingCrowd(
        [
            crowd.paths.places[a:b]
            for a, b in zip(crowd.paths.begins, crowd.paths.begins[1:], strict=False)
        ],
        crowd.paths.first.tolist(),
        TICK_S,
        reaction=0.0,
    ).begin(0)
    for _ in range(150):
        still.step([STANDING_ACTOR])
        np.testing.assert_array_equal(still.positions, still.recorded)


def digest_of_a_walk() -> str:
    """All positions of a walk among two actors."""
    walk = crowded(seed=4).begin(0)
    digest = hashlib.sha256()
    for tick in range(120):
        walk.step([[0.02 * tick, 0.1, 0.2, 0, 0.4], [1.0, 2.0 - 0.05 * tick, 0, -0.5, 0.25]])
        digest.update(walk.positions.tobytes())
    assert walk.displacement_m.sum() > 1.0
    return digest.hexdigest()


def test_two_processes_walk_the_same_walk() -> None:
    code = f"from {__name__} import digest_of_a_walk\nprint(digest_of_a_walk())"
    other = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert other.stdout.split()[-1] == digest_of_a_walk()


def test_the_order_of_people_means_nothing() -> None:
    """Each has the same strength, so that only numbers differ."""
    even = SocialForce(strength_spread=0.0)
    crowd = crowded(seed=6)
    ends = zip(crowd.paths.begins, crowd.paths.begins[1:], strict=False)
    paths, first = [crowd.paths.places[a:b] for a, b in ends], crowd.paths.first.tolist()
    one = ReactingCrowd(paths, first, TICK_S, model=even).begin(0)
    other = ReactingCrowd(paths[::-1], first[::-1], TICK_S, model=even).begin(0)
    for _ in range(100):
        one.step([STANDING_ACTOR])
        other.step([STANDING_ACTOR])
        np.testing.assert_allclose(one.positions, other.positions[::-1], atol=1e-9)


def test_the_seed_draws_strengths() -> None:
    strengths = [crowded(seed).strengths_mps2 for seed in (1, 1, 2)]
    np.testing.assert_array_equal(strengths[0], strengths[1])
    assert (strengths[0] != strengths[2]).all()
    assert strengths[0].mean() == pytest.approx(4.5, abs=0.3)
