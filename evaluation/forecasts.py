"""What was predicted of people, beside what they did."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.planning import LayeredGrid, PredictionModel, Scene, TrackHistory
from esplanade.recordings import Crowd, Obstacles, Track

Floats = NDArray[np.float64]

STEP_S: Final = 0.4
STEPS: Final = 12
"""Predictions are looked at every 0.4 s, up to 4.8 s ahead."""
MARGIN_M: Final = 10.0
_SLACK: Final = 1e-6


@dataclass(frozen=True)
class Forecasts:
    """F predictions, each of one person at one tick, STEPS steps ahead.

    Only those count who have been seen for as long as the model looks back, and whose whole
    future is recorded.
    """

    errors: Floats
    """(F, STEPS, 2): recorded minus predicted place, metres."""
    sigmas: Floats
    """(F, STEPS): predicted deviation per axis, metres."""


def ahead_s() -> Floats:
    """Times ahead of the steps, (STEPS,)."""
    return STEP_S * np.arange(1, STEPS + 1, dtype=np.float64)


def forecast(
    crowd: Crowd, obstacles: Obstacles, model: PredictionModel, sample_s: float
) -> Forecasts:
    """Predict everyone every `sample_s`, as actors do, walls included.

    Predictions of different people do not depend on each other. So all tracks begin at once here,
    and everyone is seen just when the recording has a sample: a place between two samples would
    be an interpolated one, with less noise than there is.
    """
    x0, y0, x1, y1 = crowd.bounds
    bounds = (x0 - MARGIN_M, y0 - MARGIN_M, x1 + MARGIN_M, y1 + MARGIN_M)
    grid = LayeredGrid.from_scene(Scene.open_space(bounds, obstacles.as_walls()))
    history = TrackHistory(model, sample_s)
    past = history.stride * model.samples
    ahead = np.round(ahead_s() / sample_s).astype(int)
    ways = [_sampled(track, sample_s) for track in crowd.tracks]
    errors, sigmas = [np.zeros((0, STEPS, 2))], [np.zeros((0, STEPS))]
    for k in range(max(map(len, ways))):
        history.observe({who: tuple(way[k]) for who, way in enumerate(ways) if k < len(way)})
        judged = [who for who, way in enumerate(ways) if k + ahead[-1] < len(way)]
        if k < past or not judged:
            continue
        prediction = history.predict(grid, STEPS, STEP_S)
        rows_by_id = {who: row for row, who in enumerate(history.ids)}
        rows = [rows_by_id[who] for who in judged]
        truth = np.stack([ways[who][k + ahead] for who in judged])
        errors.append(truth - prediction.means[rows, 1:])
        sigmas.append(prediction.sigmas[rows, 1:])
    return Forecasts(np.concatenate(errors), np.concatenate(sigmas))


def _sampled(track: Track, sample_s: float) -> Floats:
    count = int((track.end_s - track.start_s) / sample_s + _SLACK) + 1
    times = track.start_s + sample_s * np.arange(count)
    return np.column_stack([np.interp(times, track.times, column) for column in track.positions.T])
