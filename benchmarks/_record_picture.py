"""A picture of one step, as it was computed and as clients draw it from its record."""

from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.figure import Figure

from esplanade.actors.locomotion.body.sizes import BodySizes
from esplanade.actors.locomotion.motion.key_poses import ANKLE, Steps
from esplanade.actors.locomotion.reference.posing import Pose, pose
from esplanade.planning.compiled.arrays import Floats
from esplanade.server.world.step_records import from_records, to_records

MOMENTS: Final = (0.0, 0.2, 0.3, 0.5, 0.7, 0.9, 1.0)
APART_M: Final = 0.8
LEFT, RIGHT = 0, 1


def draw_step(file: Path, steps: Steps, sizes: BodySizes) -> None:
    """Draw a step up a tread from the one below: exact bodies wide and grey, its record's thin."""
    climbs = steps.landing[:, 2] - steps.standing[:, 2]
    from_below = (climbs > 0.1) & (climbs < 0.2) & (steps.keys[:, 0, ANKLE.stop - 1] < -climbs)
    ahead_m = np.hypot(*(steps.landing - steps.standing)[:, :2].T)
    row = np.array([int(np.where(from_below & ~steps.re_aimed, ahead_m, 0.0).argmax())])
    exact, size = steps.take(row), sizes.take(row)
    known = from_records(to_records(exact, row))
    figure = Figure(figsize=(10.0, 3.2), layout="constrained")
    axes = figure.subplots()
    for moment, share in enumerate(MOMENTS):
        shares = np.array([share])
        for drawn, colour, width in ((exact, "#c9cdd2", 5.0), (known, "#c0392b", 0.9)):
            for line in _lines(pose(drawn, shares, size)):
                along = _along(line, exact) + APART_M * moment
                axes.plot(along, line[:, 2], color=colour, lw=width, solid_capstyle="round")
    axes.set_aspect("equal")
    axes.set_axis_off()
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(file, metadata={"Date": None} if file.suffix == ".svg" else None)


def _lines(body: Pose) -> list[Floats]:
    """The lines of a body: legs, trunk and arms, (M, 3) each, metres."""
    legs = [
        np.stack([body.root[0], *(part[0, side] for part in (body.hips, body.knees))])
        for side in (LEFT, RIGHT)
    ]
    feet = [
        np.stack([part[0, side] for part in (body.knees, body.ankles, body.toes)])
        for side in (LEFT, RIGHT)
    ]
    arms = [
        np.stack([part[0, side] for part in (body.shoulders, body.elbows, body.hands)])
        for side in (LEFT, RIGHT)
    ]
    trunk = np.stack([body.root[0], body.lumbar[0], body.neck[0], body.head[0]])
    return [*legs, *feet, *arms, trunk]


def _along(line: Floats, step: Steps) -> Floats:
    """The distances of points (M, 3) along the way of a step, metres."""
    heading = step.landing[0, 3]
    ahead = np.array([np.cos(heading), np.sin(heading)])
    return np.asarray((line[:, :2] - step.standing[0, :2]) @ ahead)
