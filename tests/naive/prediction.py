"""Lei & Li, eqs. (1)-(4), term by term as they are written."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray


def past_velocities(track: NDArray[np.float64], sample_s: float) -> list[NDArray[np.float64]]:
    """Velocities between positions (n + 1, 2) that are listed newest first."""
    return [(newer - older) / sample_s for newer, older in pairwise(track)]


def printed_velocity(track: NDArray[np.float64], sample_s: float) -> NDArray[np.float64]:
    """Eq. (1): v_p = v + sum of dv_i / 2**i, dv_i the newer minus the older velocity."""
    v = past_velocities(track, sample_s)
    total = v[0].copy()
    for i in range(len(v) - 1):
        total += (v[i] - v[i + 1]) / 2**i
    return total


def default_velocity(track: NDArray[np.float64], sample_s: float) -> NDArray[np.float64]:
    """Eq. (1) with the changes older minus newer and half weight, as holds on real people."""
    v = past_velocities(track, sample_s)
    total = v[0].copy()
    for i in range(len(v) - 1):
        total -= 0.5 * (v[i] - v[i + 1]) / 2**i
    return total


def exponential_mean(track: NDArray[np.float64], sample_s: float) -> NDArray[np.float64]:
    """Past velocities weighted 1/2, 1/4, 1/8, ..., the oldest taking the rest."""
    v = past_velocities(track, sample_s)
    weights = [0.5 ** (i + 1) for i in range(len(v))]
    weights[-1] += 1.0 - sum(weights)
    return sum(w * velocity for w, velocity in zip(weights, v, strict=True))


def density(
    parts: list[tuple[float, float]], offset_m: NDArray[np.float64], sigma_m: float
) -> float:
    """Eq. (4) for the plane, summed over Gaussians (scale, weight) of the deviation."""
    squared = offset_m[0] ** 2 + offset_m[1] ** 2
    total = 0.0
    for scale, weight in parts:
        variance = (scale * sigma_m) ** 2
        total += weight * math.exp(-squared / (2.0 * variance)) / (2.0 * math.pi * variance)
    return total


def integral_of_density(density, sigma_m: float, within: float = 8.0) -> float:
    """Sum of a density over an even grid of the circle of so many deviations."""
    axis = np.linspace(-8.0 * sigma_m, 8.0 * sigma_m, 161)
    step = axis[1] - axis[0]
    inside = [(x, y) for x in axis for y in axis if math.hypot(x, y) <= within * sigma_m]
    return step * step * math.fsum(density(np.array(place), sigma_m) for place in inside)
