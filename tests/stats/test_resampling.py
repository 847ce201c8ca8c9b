"""Means and medians over clusters, and the resamples of whole clusters."""

import numpy as np
import pytest

from esplanade.stats import Sample, means_of, resampled_means, resampled_medians
from esplanade.stats.resampling import RESAMPLES


def sample(*values: float, clusters: list[int] | None = None) -> Sample:
    """A sample of one figure; each value is in a cluster of its own unless clusters are given."""
    return Sample.of(np.array([values]).T, clusters or range(len(values)))


def test_samples_weigh_the_same_or_by_their_episodes() -> None:
    both = [sample(0.0, 0.0, 3.0), sample(5.0)]
    assert means_of(both, even=True).tolist() == [3.0]
    assert means_of(both, even=False).tolist() == [2.0]


def test_episodes_without_a_figure_are_left_out() -> None:
    assert means_of([sample(2.0, np.nan), sample(4.0, 4.0)], even=True).tolist() == [3.0]
    assert np.isnan(means_of([sample(np.nan)], even=True)[0])


def test_labels_of_clusters_become_numbers_in_the_order_of_their_first_episode() -> None:
    made = Sample.of(np.zeros((4, 2)), ["b", "a", "b", "c"])
    assert made.clusters.tolist() == [0, 1, 0, 2]
    assert made.count == 3


@pytest.mark.parametrize("values", [np.zeros((0, 2)), np.zeros((3, 2)), np.zeros(2)])
def test_what_has_no_label_for_each_episode_is_no_sample(values: np.ndarray) -> None:
    with pytest.raises(ValueError, match="are no sample"):
        Sample.of(values, range(len(values) - 1) if len(values) else [])


def test_resamples_scatter_as_the_mean_of_so_many_clusters_does() -> None:
    rng = np.random.default_rng(3)
    alone = rng.normal(5.0, 2.0, 400)
    resamples = resampled_means([sample(*alone)], 0, even=True)
    assert resamples.shape == (RESAMPLES, 1)
    assert resamples.std() == pytest.approx(2.0 / np.sqrt(400), rel=0.15)
    fours = np.repeat(rng.normal(5.0, 2.0, 100), 4)
    clusters = np.repeat(np.arange(100), 4).tolist()
    together = resampled_means([sample(*fours, clusters=clusters)], 0, even=True)
    assert together.std() == pytest.approx(2.0 / np.sqrt(100), rel=0.15)


def test_the_same_seed_draws_the_same_clusters_of_every_sample() -> None:
    rng = np.random.default_rng(4)
    first, second = rng.normal(size=(2, 50))
    here = resampled_means([sample(*first), sample(*second)], 7, even=True)
    shifted = resampled_means([sample(*first + 1.0), sample(*second + 1.0)], 7, even=True)
    np.testing.assert_allclose(shifted - here, 1.0)
    other = resampled_means([sample(*first), sample(*second)], 8, even=True)
    assert not np.array_equal(here, other)


def test_medians_are_those_of_the_episodes_that_were_drawn() -> None:
    rng = np.random.default_rng(5)
    samples = [
        Sample.of(rng.normal(size=(n, 2)).round(1), rng.integers(0, 4, n).tolist()) for n in (9, 6)
    ]
    samples[0].values[2, 1] = np.nan
    found = resampled_medians(samples, 11)
    draws = np.random.default_rng(11)
    counts = [draws.multinomial(s.count, np.full(s.count, 1 / s.count), RESAMPLES) for s in samples]
    for k in range(50):
        drawn = np.concatenate(
            [
                np.repeat(s.values, c[k][s.clusters], axis=0)
                for s, c in zip(samples, counts, strict=True)
            ]
        )
        np.testing.assert_allclose(found[k], np.nanmedian(drawn, axis=0))


def test_medians_of_nothing_are_unknown() -> None:
    assert np.isnan(resampled_medians([sample(np.nan, np.nan)], 0)).all()
