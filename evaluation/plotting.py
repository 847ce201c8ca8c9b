"""Pictures of episodes: a strip of moments with people, predictions, the plan and the path."""

from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from esplanade.commandline.pictures import save
from esplanade.evaluation.episodes import Episode
from esplanade.evaluation.policies.policy import DebugInfo, Observation, Policy
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.scores import Score
from esplanade.evaluation.simulation import Environment, run_episode
from esplanade.policies.errors import PolicyError

Floats = NDArray[np.float64]

MOMENTS: Final = 8
COLUMNS: Final = 4
DRAWN_RANGE_M: Final = 5.0
"""Each picture extends this far from the robot to all four sides."""


@dataclass(frozen=True)
class Moment:
    """The data of one tick that is drawn."""

    observation: Observation
    debug_info: DebugInfo


def require_matplotlib() -> Any:
    """The class `Figure` of matplotlib.

    Raises
    ------
    PolicyError
        matplotlib is not installed.
    """
    try:
        return import_module("matplotlib.figure").Figure
    except ImportError:
        raise PolicyError(
            "plots need matplotlib: install it, or everything of `esplanade[evaluate]`"
        ) from None


def draw_episode(
    path: Path, title: str, environment: Environment, episode: Episode, policy: Policy, rules: Rules
) -> Score:
    """Run an episode again, draw it to `path`, and return its score.

    Half of the moments are spread over the whole trip; the others are around the moment at which
    somebody is nearest to the robot.
    """
    moments: list[Moment] = []

    def keep(observation: Observation, policy: Policy) -> None:
        moments.append(Moment(observation, policy.debug_info()))

    result = run_episode(environment, episode, policy, rules, keep)
    figure = require_matplotlib()(figsize=(4.0 * COLUMNS, 4.2 * MOMENTS / COLUMNS), dpi=70)
    for place, tick in enumerate(_chosen(moments, rules), start=1):
        axes = figure.add_subplot(MOMENTS // COLUMNS, COLUMNS, place)
        _draw(axes, environment, episode, moments[tick], result.trajectory[: tick + 1], rules)
    figure.suptitle(f"{title}: {_outcome(result.score)}")
    figure.tight_layout()
    save(figure, path)
    return result.score


def _chosen(moments: list[Moment], rules: Rules) -> list[int]:
    """The ticks that are drawn, in ascending order."""
    nearest = [
        min(
            (float(np.hypot(*(p.position - m.observation.position))) for p in m.observation.people),
            default=9.0,
        )
        for m in moments
    ]
    closest, last, half = int(np.argmin(nearest)), len(moments) - 1, MOMENTS // 2
    spacing = max(1, round(0.5 / rules.tick_s))
    around = [closest + spacing * k for k in range(2 - half, 2)]
    spread = np.linspace(0, last, half).round().astype(int).tolist()
    return sorted({min(last, max(0, tick)) for tick in (*around, *spread)})


def _outcome(score: Score) -> str:
    touched = f"touched {score.people_touched}" if score.touched else "no contact"
    imposed = f", imposed {score.displacement_m:.2f} m" if score.displacement_m else ""
    arrived = f"{score.time_ratio:.2f} × the time" if score.reached else "did not arrive"
    return f"{touched}, {arrived}, clearance {score.clearance_m:+.2f} m{imposed}"


def _draw(
    axes: Any,
    environment: Environment,
    episode: Episode,
    moment: Moment,
    trajectory: Floats,
    rules: Rules,
) -> None:
    here, circle = moment.observation.position, import_module("matplotlib.patches").Circle
    for (x0, y0), (x1, y1) in environment.replay.obstacles.outline:
        axes.plot([x0, x1], [y0, y1], color="0.25", lw=2)
    for x, y, radius_m in moment.debug_info.circles:
        axes.add_patch(circle((x, y), radius_m, fill=False, ec="tab:red", alpha=0.3, lw=0.8))
    tick = episode.first_tick + round(moment.observation.t / rules.tick_s)
    for person in moment.observation.people:
        axes.plot(*person.track.T, color="tab:red", lw=0.8, alpha=0.6)
        disc = circle(tuple(person.position), rules.person_radius_m, color="tab:red", alpha=0.7)
        axes.add_patch(disc)
        recorded = environment.replay.at(person.id, tick)
        if (recorded != person.position).any():
            unmoved = circle(tuple(recorded), rules.person_radius_m, fill=False, ec="0.5", ls=":")
            axes.add_patch(unmoved)
        axes.annotate(environment.replay.ids[person.id], person.position, fontsize=7, clip_on=True)
    axes.plot(*trajectory.T, color="tab:blue", lw=1.2)
    axes.plot(*moment.debug_info.path.T, ".-", color="tab:green", lw=1.0, ms=3)
    axes.add_patch(circle(tuple(here), rules.robot_radius_m, color="tab:blue"))
    axes.plot(*episode.goal, "*", color="goldenrod", ms=14)
    axes.set_xlim(here[0] - DRAWN_RANGE_M, here[0] + DRAWN_RANGE_M)
    axes.set_ylim(here[1] - DRAWN_RANGE_M, here[1] + DRAWN_RANGE_M)
    axes.set_aspect("equal")
    axes.set_title(f"{moment.observation.t:.1f} s", fontsize=9)
    axes.tick_params(labelsize=7)
