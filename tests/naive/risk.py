"""Lei & Li, eq. (5), summed person by person and sample by sample, for one configuration."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from esplanade.planning import Prediction, RiskModel, Spread

BODIES_OVERLAP_M = 1.8


def sigma_grid() -> list[tuple[float, float, float]]:
    """Offsets in deviations and weights: an even grid within 2.5 deviations, by density."""
    axis = [-2.5 + 0.625 * k for k in range(9)]
    points = [(a, b) for a in axis for b in axis if a * a + b * b <= 6.25 + 1e-9]
    weights = [math.exp(-(a * a + b * b) / 2.0) for a, b in points]
    total = math.fsum(weights)
    return [(a, b, w / total) for (a, b), w in zip(points, weights, strict=True)]


def risk(
    model: RiskModel,
    spread: Spread,
    prediction: Prediction,
    k: int,
    feet_m: float,
    position: NDArray[np.float64],
    velocity: NDArray[np.float64],
    closing_weight: float,
) -> float:
    """Mean over each person's likely places of w1 · proximity + w2 · closing speed.

    Every Gaussian of the spread has likely places of its own. People on another floor are no risk.
    """
    near = 0.0
    closing = 0.0
    contact_m = 0.25 + 0.25 + 0.1
    for p in range(len(prediction.means)):
        if abs(prediction.heights[p, k] - feet_m) >= BODIES_OVERLAP_M:
            continue
        likely = [
            (scale * a, scale * b, share * weight)
            for scale, share in zip(spread.scales, spread.weights, strict=True)
            for a, b, weight in sigma_grid()
        ]
        for a, b, weight in likely:
            sigma = math.hypot(prediction.sigmas[p, k], model.sway_m)
            place = prediction.means[p, k] + sigma * np.array([a, b])
            away = position - place
            distance = math.hypot(*away)
            near += weight * float(model.near(distance, contact_m))
            if distance > 1e-9:
                speed = -(velocity - prediction.velocities[p, k]) @ (away / distance)
                closing += weight * float(model.toward(distance, contact_m)) * speed
    return near + closing_weight * max(0.0, closing)
