"""The spread of people around where they are expected: Lei & Li, eq. (4), with heavier tails."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray


@dataclass(frozen=True)
class Spread:
    """Shape of the errors of a prediction: even Gaussians around the same mean.

    The deviation of a prediction is the scale, person by person and slice by slice; the spread
    tells the share of people within a number of deviations. By default it is the one Gaussian of
    eq. (4).
    """

    scales: tuple[float, ...] = (1.0,)
    """Deviation of each Gaussian, in deviations of the prediction."""
    weights: tuple[float, ...] = (1.0,)
    """Share of people that each Gaussian stands for; they sum to one."""

    def __post_init__(self) -> None:
        if not self.scales or len(self.scales) != len(self.weights):
            raise ValueError(f"each scale needs a weight, got {self.scales} and {self.weights}")
        if not all(0.0 < value < math.inf for value in (*self.scales, *self.weights)):
            raise ValueError(
                f"scales and weights must be positive, got {self.scales} and {self.weights}"
            )
        if not math.isclose(math.fsum(self.weights), 1.0, abs_tol=1e-9):
            raise ValueError(f"weights must sum to one, got {self.weights}")

    @property
    def parts(self) -> list[tuple[float, float]]:
        """Scale and weight of each Gaussian."""
        return list(zip(self.scales, self.weights, strict=True))

    def log_density(self, offset_m: ArrayLike, sigma_m: ArrayLike) -> NDArray[np.float64]:
        """Logarithm of the density of a predicted place at an offset from its mean, eq. (4).

        Parameters
        ----------
        offset_m : float (..., 2), metres
        sigma_m : float > 0, metres per axis; broadcasts to (...)

        Returns
        -------
        float64 (...), of a density in 1/m².

        Raises
        ------
        ValueError
            A deviation is not positive.

        Notes
        -----
        The paper prints the normaliser of one dimension, 1/(sigma sqrt(2 pi)). The field has two,
        so that the density integrates to one with 1/(2 pi sigma²), which is used here.
        """
        sigma2 = np.asarray(sigma_m, dtype=np.float64) ** 2
        if not (np.asarray(sigma_m) > 0.0).all():
            raise ValueError(f"sigma_m must be positive, got {sigma_m!r}")
        squared = (np.asarray(offset_m, dtype=np.float64) ** 2).sum(axis=-1)
        parts = [
            math.log(weight / (2.0 * math.pi * scale**2))
            - np.log(sigma2)
            - squared / (2.0 * scale**2 * sigma2)
            for scale, weight in self.parts
        ]
        return np.asarray(np.logaddexp.reduce(parts, axis=0))

    def density(self, offset_m: ArrayLike, sigma_m: ArrayLike) -> NDArray[np.float64]:
        """Density as for `log_density`, 1/m²."""
        return np.asarray(np.exp(self.log_density(offset_m, sigma_m)))

    def share_within(self, radius: float) -> float:
        """Share of people within some deviations of the mean."""
        return math.fsum(
            -weight * math.expm1(-(radius**2) / (2.0 * scale**2)) for scale, weight in self.parts
        )

    def radius_of(self, share: float) -> float:
        """Radius of the circle that holds a share in (0, 1) of people, in deviations."""
        if not 0.0 < share < 1.0:
            raise ValueError(f"a circle holds a share in (0, 1) of people, got {share}")
        of_one = math.sqrt(-2.0 * math.log1p(-share))
        low, high = of_one * min(self.scales), of_one * max(self.scales)
        if low == high:
            return low
        from scipy.optimize import brentq  # noqa: PLC0415 (it takes long, and few need it)

        return float(brentq(lambda radius: self.share_within(radius) - share, low, high))


GAUSSIAN: Final = Spread()
"""The paper's eq. (4)."""
PEOPLE: Final = Spread(scales=(0.5, 1.4), weights=(0.63, 0.37))
"""Recorded pedestrians spread like this: most go on as expected, some do something else."""
