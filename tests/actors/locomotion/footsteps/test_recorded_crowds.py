"""People as they were recorded, walking live: only where they are and how fast is known."""

import numpy as np
import pytest
from numpy.typing import NDArray

from esplanade.actors.locomotion.body.skeleton import FOOT
from esplanade.actors.locomotion.footsteps.course import AHEAD, AHEAD_S, Course
from esplanade.actors.locomotion.motion.leg_poses import REACH
from esplanade.planning import Scene
from esplanade.planning.compiled.arrays import Floats
from esplanade.recordings import Crowd, read_crowd
from tests.actors.locomotion.parade import TICK_S, Parade
from tests.recordings.data import recorded

SECONDS = 60.0
PEOPLE = 60
SETTLED_S = 1.0
"""Recorded people come in at full speed, walkers standing: let them catch up."""


def ways(crowd: Crowd) -> tuple[Floats, NDArray[np.bool_]]:
    """Places (N, T, 2) of the recording's first people, tick by tick, and (N, T) whether they
    have been there for a while. Others stand at the beginning or the end of their tracks."""
    times = crowd.start_s + np.arange(0.0, SECONDS, TICK_S)
    tracks = [t for t in crowd.tracks if t.end_s - t.start_s > 5.0][:PEOPLE]
    there = np.array([(times >= t.start_s + SETTLED_S) & (times <= t.end_s) for t in tracks])
    places = np.array(
        [
            np.stack([np.interp(times, t.times, t.positions[:, axis]) for axis in (0, 1)], axis=1)
            for t in tracks
        ]
    )
    return places, there


@pytest.mark.parametrize("name", ["eth", "hotel", "zara1", "students3"])
def test_recorded_people_walk_on_planted_feet(name: str) -> None:
    places, there = ways(read_crowd(recorded(name)))
    low, high = places.min(axis=(0, 1)) - 3.0, places.max(axis=(0, 1)) + 3.0
    parade = Parade(len(places), Scene.open_space((*low.tolist(), *high.tolist())))
    parade.positions[:, :2] = places[:, 0]
    parade.stand()
    for tick in range(1, places.shape[1]):
        velocities = (places[:, tick] - places[:, tick - 1]) / TICK_S
        parade.positions[:, :2] = places[:, tick]
        moving = np.hypot(velocities[:, 0], velocities[:, 1]) > 0.0
        heading = np.arctan2(velocities[:, 1], velocities[:, 0])
        parade.headings = np.where(moving, heading, parade.headings)
        ahead = np.repeat(parade.positions[:, None], AHEAD, axis=1)
        ahead[..., :2] += velocities[:, None] * (np.arange(AHEAD) * AHEAD_S)[:, None]
        parade.update(Course(parade.headings, ahead))

    slide, off, short = [], [], []
    for frame in parade.frames():
        slide.append(frame.slide_m[~np.isnan(frame.slide_m)])
        walking = there[:, min(int(frame.tick), there.shape[1] - 1)]
        off.append(np.hypot(*(frame.pose.root - frame.bodies)[walking, :2].T))
        legs = np.linalg.norm(frame.pose.hips - frame.pose.ankles, axis=2)
        short.append(legs / parade.sizes.leg_m[:, None])
    assert np.concatenate(slide).max() < 3e-4
    assert np.percentile(np.concatenate(off), 99) < 0.15
    assert np.mean(np.array(short) > REACH + 1e-6) < 1e-3
    assert parade.walkers.lost == 0
    root, ankles, _ = parade.jumps()
    assert max(root.max(), ankles.max()) < 3e-4
    lengths = np.concatenate(
        [np.hypot(*(b.steps.landing - b.steps.standing)[:, :2].T) for b in parade.begun]
    )
    flown = np.concatenate([b.steps.flight for b in parade.begun]) > 0.0
    assert lengths[~flown].max() < 1.1 - FOOT * 0.5
    assert lengths.max() < 1.4
