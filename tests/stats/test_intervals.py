"""Intervals: they hold as often as they say, in clusters too, and shares have Wilson's."""

import math

import numpy as np
import pytest
from scipy import stats

from esplanade.stats import Sample, interval_of, resampled_means, share_interval
from esplanade.stats.resampling import means_of

TRIALS = 300


def clustered(rng: np.random.Generator, clusters: int, size: int) -> Sample:
    """Normal values around 0 that have half of their variance in common within a cluster."""
    common = np.repeat(rng.normal(size=clusters), size)
    values = common + rng.normal(size=clusters * size)
    return Sample.of(values[:, np.newaxis], np.repeat(np.arange(clusters), size).tolist())


@pytest.mark.parametrize(("clusters", "least"), [(6, 260), (25, 274)])
@pytest.mark.usefixtures("fewer_resamples")
def test_the_interval_of_a_mean_holds_as_often_as_it_says(clusters: int, least: int) -> None:
    rng = np.random.default_rng(clusters)
    held, alone = 0, 0
    for _ in range(TRIALS):
        made = clustered(rng, clusters, 8)
        ((low, high),) = interval_of(resampled_means([made], 0, even=True), [made])
        held += low < 0.0 < high
        apart = Sample(made.values, np.arange(len(made.values)))
        ((low, high),) = interval_of(resampled_means([apart], 0, even=True), [apart])
        alone += low < 0.0 < high
    # Of 300 at 95 %, 274 to 294 hold in 99 % of cases; of few clusters somewhat fewer do.
    assert held >= least
    assert alone < 220  # what hangs together is no evidence of its own


def test_several_comparisons_have_wider_intervals_and_one_cluster_has_none() -> None:
    made = clustered(np.random.default_rng(1), 20, 4)
    resamples = resampled_means([made], 0, even=True)
    (once,) = interval_of(resamples, [made])
    (often,) = interval_of(resamples, [made], comparisons=10)
    assert often.low < once.low < means_of([made], even=True)[0] < once.high < often.high
    one = clustered(np.random.default_rng(1), 1, 20)
    (unknown,) = interval_of(resampled_means([one], 0, even=True), [one])
    assert math.isnan(unknown.low)
    assert math.isnan(unknown.high)
    assert math.isnan(share_interval([Sample.of(np.ones((20, 1)), [0] * 20)], 0).low)


def test_a_figure_that_no_episode_has_has_no_interval() -> None:
    made = Sample.of([[math.nan, 1.0], [math.nan, 2.0]], [0, 1])
    unknown, known = interval_of(resampled_means([made], 0, even=True), [made])
    assert math.isnan(unknown.low)
    assert known.low <= 1.5 <= known.high


@pytest.mark.parametrize(("successes", "episodes"), [(0, 40), (3, 40), (17, 60), (25, 25)])
def test_the_interval_of_a_share_of_episodes_by_themselves_is_wilsons(
    successes: int, episodes: int
) -> None:
    rng = np.random.default_rng(0)
    # Pairs of opposites hang together less than chance has it: there is no effect below 1.
    values = np.zeros((episodes, 1))
    values[rng.permutation(episodes)[:successes]] = 1.0
    order = np.argsort(values[:, 0])
    clusters = np.empty(episodes, dtype=int)
    clusters[order] = np.arange(episodes) % max(2, episodes // 5)
    found = share_interval([Sample.of(values, clusters.tolist())], 0)
    known = stats.binomtest(successes, episodes).proportion_ci(method="wilson")
    assert found == pytest.approx((known.low, known.high))


def test_the_interval_of_a_share_in_clusters_is_that_of_as_many_clusters() -> None:
    rng = np.random.default_rng(2)
    clusters = np.repeat((rng.uniform(size=400) < 0.2).astype(float), 5)
    labels = np.repeat(np.arange(400), 5).tolist()
    found = share_interval([Sample.of(clusters[:, np.newaxis], labels)], 0)
    known = stats.binomtest(int(clusters.sum() / 5), 400).proportion_ci(method="wilson")
    assert found == pytest.approx((known.low, known.high), rel=0.01)
