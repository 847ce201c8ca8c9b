"""Predictions of recorded people, compared with what these people did."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.planning import LayeredGrid, PredictionModel, Scene, TrackHistory
from esplanade.recordings import Crowd, Obstacles, Track

Floats = NDArray[np.float64]

STEP_S: Final = 0.4
STEPS: Final = 12
"""Predictions are compared every 0.4 s, up to 4.8 s ahead."""
MARGIN_M: Final = 10.0
"""The ground extends this far beyond the bounds of the recording."""
_SLACK: Final = 1e-6


@dataclass(frozen=True)
class Forecasts:
    """F predictions, each of one person at one time, STEPS steps ahead.

    A person counts only once observed for as long as the model looks back, and only while the
    whole horizon is recorded.
    """

    errors: Floats
    """(F, STEPS, 2): the recorded minus the predicted position, metres."""
    sigmas: Floats
    """(F, STEPS): the predicted deviation along each axis, metres."""


def ahead_s() -> Floats:
    """The times of the steps ahead, (STEPS,), seconds."""
    return STEP_S * np.arange(1, STEPS + 1, dtype=np.float64)


def forecast(
    crowd: Crowd, obstacles: Obstacles, model: PredictionModel, sample_s: float
) -> Forecasts:
    """Predict everyone every `sample_s` seconds, as actors do, walls included.

    Predictions of different people do not depend on each other. Therefore all tracks start at the
    same time here, and people are observed exactly at the samples of the recording: a position
    between two samples would be interpolated, with less noise than the recording has.
    """
    x0, y0, x1, y1 = crowd.bounds
    bounds = (x0 - MARGIN_M, y0 - MARGIN_M, x1 + MARGIN_M, y1 + MARGIN_M)
    grid = LayeredGrid.from_scene(Scene.open_space(bounds, obstacles.as_walls()))
    history = TrackHistory(model, sample_s)
    past = history.stride * model.samples
    ahead = np.round(ahead_s() / sample_s).astype(int)
    paths = [_sampled(track, sample_s) for track in crowd.tracks]
    errors, sigmas = [np.zeros((0, STEPS, 2))], [np.zeros((0, STEPS))]
    for k in range(max(map(len, paths))):
        history.observe(
            {person: tuple(path[k]) for person, path in enumerate(paths) if k < len(path)}
        )
        judged = [person for person, path in enumerate(paths) if k + ahead[-1] < len(path)]
        if k < past or not judged:
            continue
        prediction = history.predict(grid, STEPS, STEP_S)
        rows_by_id = {person: row for row, person in enumerate(history.ids)}
        rows = [rows_by_id[person] for person in judged]
        truth = np.stack([paths[person][k + ahead] for person in judged])
        errors.append(truth - prediction.means[rows, 1:])
        sigmas.append(prediction.sigmas[rows, 1:])
    return Forecasts(np.concatenate(errors), np.concatenate(sigmas))


def _sampled(track: Track, sample_s: float) -> Floats:
    count = int((track.end_s - track.start_s) / sample_s + _SLACK) + 1
    times = track.start_s + sample_s * np.arange(count)
    return np.column_stack([np.interp(times, track.times, column) for column in track.positions.T])
