"""The published gait: steps as long as asked for, a supporting foot that stays, and its flaws."""

import numpy as np
import pytest

from esplanade.actors.locomotion.gait.curves import support_share
from esplanade.actors.locomotion.reference.paper_gait import FRAMES_A_STEP, PaperWalk, halve, walk
from esplanade.actors.locomotion.reference.published_lengths import sl_noslide, sl_paper


def heel_prints(made: PaperWalk) -> np.ndarray:
    """The places at which each foot begins to support: (N, S, 2)."""
    heels, _ = made.feet()
    return heels[:, made.ends, np.arange(len(made.ends)) % 2]


def reversals(made: PaperWalk) -> int:
    """The number of times that the first walker's hips change between forward and back."""
    moved = np.diff(made.root[0, :, 0])
    return int(np.sum(np.diff(np.sign(moved[np.abs(moved) > 1e-12])) != 0))


# In steps as short as 0.1 the toe is lower from the beginning, and the foot is never flat.
@pytest.mark.parametrize(("length", "most"), [(0.1, 1e-3), (0.2, 1e-4), (0.5, 1e-4), (0.7, 1e-4)])
def test_steady_steps_are_as_long_as_asked_for(length: float, most: float):
    walked = np.diff(heel_prints(walk(np.full((1, 8), length)))[..., 0], axis=1)
    assert np.max(np.abs(walked - length)) < most


def test_changing_steps_are_as_long_as_asked_for():
    lengths = np.random.default_rng(3).uniform(0.05, 0.7, (50, 12))
    walked = np.diff(heel_prints(walk(lengths))[..., 0], axis=1)
    assert np.max(np.abs(walked - lengths[:, 1:])) < 1e-3


def test_what_supports_does_not_slide():
    made = walk(np.random.default_rng(3).uniform(0.05, 0.7, (20, 8)))
    heels, toes = made.feet()
    right = made.on_right.astype(int)[None, :, None, None]
    heel, toe = (np.take_along_axis(points, right, axis=2)[:, :, 0] for points in (heels, toes))
    supporting = np.where(made.on_toe[..., None], toe, heel)
    same_foot = (made.on_right[1:] == made.on_right[:-1]) & (
        made.on_toe[:, 1:] == made.on_toe[:, :-1]
    )
    slides = np.linalg.norm(np.diff(supporting, axis=1), axis=-1)[same_foot]
    assert slides.max() < 1e-14


def test_support_goes_from_heel_to_toe_once_a_step():
    made = walk(np.full((1, 5), 0.5))
    changes = np.diff(made.on_toe[0].astype(int))
    assert np.sum(changes == 1) == 4
    assert np.all(made.ends[1:-1] - 1 == np.flatnonzero(changes == -1)[:3])


def test_flaw_new_heels_do_not_meet_the_ground():
    for length in (0.2, 0.5, 0.7):
        heights = heel_prints(walk(np.full((1, 6), length)))[0, :, 1]
        assert np.all((np.abs(np.diff(heights)) > 0.018) & (np.abs(np.diff(heights)) < 0.044))


def test_flaw_the_foot_behind_slides_in_double_support():
    made = walk(np.full((1, 4), 0.5))
    _, toes = made.feet()
    rv, _ = halve(sl_noslide, [0.5], 1e-6)
    frames = round(FRAMES_A_STEP * 2.0 * (float(support_share(rv)[0]) - 0.5))
    behind = toes[0, made.ends[1] :, 0, 0][:frames]
    assert 0.06 < np.ptp(behind) < 0.10


def test_flaw_steps_of_no_length_jitter():
    assert reversals(walk(np.full((1, 12), 0.4))) == 0
    assert reversals(walk(np.tile([0.5, 0.0], (1, 6)))) >= 7
    assert reversals(walk(np.zeros((1, 12)))) >= 13


def test_algorithm_1_meets_its_tolerance():
    lengths = np.linspace(0.05, 0.74, 15)
    for length_of in (sl_paper, sl_noslide):
        rv, halvings = halve(length_of, lengths, 1e-6)
        assert np.max(np.abs(length_of(rv) - lengths)) <= 1e-6
        assert halvings.max() <= 20


@pytest.mark.parametrize("lengths", [[[0.3]], [0.3, 0.3], [[0.3, -0.1]], [[0.3, 0.9]]])
def test_what_cannot_be_walked_is_refused(lengths: list):
    with pytest.raises(ValueError, match="lengths"):
        walk(lengths)
