"""Samples whose values come in clusters, and their resamples: the bootstrap of whole clusters."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]

RESAMPLES: Final = 4000


@dataclass(frozen=True)
class Sample:
    """The values of one place, each in a cluster of those that hang together."""

    values: Floats
    """(E, M): M figures of each of E episodes; nan where an episode has none."""
    clusters: NDArray[np.int64]
    """(E,): the cluster of each episode, from 0 on without gaps."""

    @classmethod
    def of(cls, values: ArrayLike, labels: Sequence[Any]) -> "Sample":
        """The sample of values (E, M) whose clusters have any hashable labels (E,).

        Raises
        ------
        ValueError
            There are not as many labels as rows of values, or none.
        """
        array = np.asarray(values, dtype=np.float64)
        if array.ndim != 2 or len(array) != len(labels) or len(array) == 0:
            raise ValueError(f"{array.shape} values and {len(labels)} labels are no sample")
        numbers = {label: number for number, label in enumerate(dict.fromkeys(labels))}
        return cls(array, np.array([numbers[label] for label in labels], dtype=np.int64))

    @property
    def count(self) -> int:
        """The number of clusters."""
        return int(self.clusters.max()) + 1


def means_of(samples: Sequence[Sample], *, even: bool) -> Floats:
    """The means (M,) over all episodes, or, if `even`, the mean of the means of the samples."""
    once = [np.ones((1, sample.count)) for sample in samples]
    return np.asarray(_means(samples, once, even=even)[0])


def resampled_means(samples: Sequence[Sample], seed: int, *, even: bool) -> Floats:
    """`means_of` R resamples, float64 (R, M): a clustered bootstrap, stratified by sample.

    As many clusters as a sample has are drawn from it with replacement. The same seed and numbers
    of clusters give the same resamples, so that differences between two are paired.

    Source: Davison & Hinkley, Bootstrap Methods and their Application, 1997, sections 3.2, 3.8.
    """
    return _means(samples, _draws(samples, seed), even=even)


def resampled_medians(samples: Sequence[Sample], seed: int) -> Floats:
    """The medians (R, M) over all episodes of R resamples, as `resampled_means` draws them."""
    counts = np.concatenate(
        [d[:, s.clusters] for d, s in zip(_draws(samples, seed), samples, strict=True)], axis=1
    )
    values = np.concatenate([sample.values for sample in samples])
    found = np.empty((len(counts), values.shape[1]))
    for column, of in enumerate(values.T):
        order = np.argsort(of)
        below = np.cumsum(counts[:, order] * np.isfinite(of[order]), axis=1)
        half = 0.5 * below[:, -1:]
        low = of[order][np.argmax(below >= half, axis=1)]
        high = of[order][np.argmax(below > half, axis=1)]
        found[:, column] = np.where(half[:, 0] > 0, 0.5 * (low + high), np.nan)
    return found


def _draws(samples: Sequence[Sample], seed: int) -> list[NDArray[Any]]:
    """The times (R, C) that each of a sample's C clusters is drawn, for each sample."""
    rng = np.random.default_rng(seed)
    return [
        rng.multinomial(sample.count, np.full(sample.count, 1.0 / sample.count), RESAMPLES)
        for sample in samples
    ]


def _means(samples: Sequence[Sample], draws: Sequence[NDArray[Any]], *, even: bool) -> Floats:
    """Means (R, M) where clusters were drawn so often."""
    sums, counts = [], []
    for sample, drawn in zip(samples, draws, strict=True):
        known = np.isfinite(sample.values)
        by_cluster = np.zeros((2, sample.count, sample.values.shape[1]))
        np.add.at(by_cluster[0], sample.clusters, np.where(known, sample.values, 0.0))
        np.add.at(by_cluster[1], sample.clusters, known)
        sums.append(drawn @ by_cluster[0])
        counts.append(drawn @ by_cluster[1])
    with np.errstate(invalid="ignore"):
        if even:
            return np.asarray(np.mean(np.array(sums) / np.array(counts), axis=0))
        return np.asarray(np.sum(sums, axis=0) / np.sum(counts, axis=0))
