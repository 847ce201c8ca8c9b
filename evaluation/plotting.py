"""Pictures of episodes: a strip of moments, each with people, what is expected, and the way."""

from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.episodes import Episode
from esplanade.evaluation.policies.policy import Policy, PolicyError, Thoughts, View
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.scores import Score
from esplanade.evaluation.simulation import Ground, run_episode

Floats = NDArray[np.float64]

MOMENTS: Final = 8
COLUMNS: Final = 4
VIEW_M: Final = 5.0
"""What is within this distance of the robot, to all sides, is drawn."""


@dataclass(frozen=True)
class Moment:
    """What is to be drawn of one tick."""

    view: View
    thoughts: Thoughts


def require_matplotlib() -> Any:
    """matplotlib's Figure; PolicyError where it is not installed."""
    try:
        return import_module("matplotlib.figure").Figure
    except ImportError:
        raise PolicyError(
            "plots need matplotlib: install it, or everything of `esplanade[evaluate]`"
        ) from None


def draw_episode(
    path: Path, title: str, ground: Ground, episode: Episode, policy: Policy, rules: Rules
) -> Score:
    """Run an episode again and draw it; returns its score.

    Half of the moments are spread over the whole trip, the others lie around its closest call.
    """
    moments: list[Moment] = []

    def keep(view: View, policy: Policy) -> None:
        moments.append(Moment(view, policy.thoughts()))

    run = run_episode(ground, episode, policy, rules, keep)
    figure = require_matplotlib()(figsize=(4.0 * COLUMNS, 4.2 * MOMENTS / COLUMNS), dpi=70)
    for place, tick in enumerate(_chosen(moments, rules), start=1):
        axes = figure.add_subplot(MOMENTS // COLUMNS, COLUMNS, place)
        _draw(axes, ground, episode, moments[tick], run.way[: tick + 1], rules)
    figure.suptitle(f"{title}: {_verdict(run.score)}")
    figure.tight_layout()
    figure.savefig(path)
    return run.score


def _chosen(moments: list[Moment], rules: Rules) -> list[int]:
    """Ticks to be drawn, in their order."""
    nearest = [
        min((float(np.hypot(*(p.position - m.view.position))) for p in m.view.people), default=9.0)
        for m in moments
    ]
    closest, last, half = int(np.argmin(nearest)), len(moments) - 1, MOMENTS // 2
    spacing = max(1, round(0.5 / rules.tick_s))
    around = [closest + spacing * k for k in range(2 - half, 2)]
    spread = np.linspace(0, last, half).round().astype(int).tolist()
    return sorted({min(last, max(0, tick)) for tick in (*around, *spread)})


def _verdict(score: Score) -> str:
    touched = f"touched {score.people_touched}" if score.touched else "no contact"
    arrived = f"{score.time_ratio:.2f} × the time" if score.reached else "did not arrive"
    return f"{touched}, {arrived}, clearance {score.clearance_m:+.2f} m"


def _draw(
    axes: Any, ground: Ground, episode: Episode, moment: Moment, way: Floats, rules: Rules
) -> None:
    here, circle = moment.view.position, import_module("matplotlib.patches").Circle
    for (x0, y0), (x1, y1) in ground.replay.obstacles.outline:
        axes.plot([x0, x1], [y0, y1], color="0.25", lw=2)
    for x, y, radius_m in moment.thoughts.circles:
        axes.add_patch(circle((x, y), radius_m, fill=False, ec="tab:red", alpha=0.3, lw=0.8))
    for person in moment.view.people:
        axes.plot(*person.track.T, color="tab:red", lw=0.8, alpha=0.6)
        disc = circle(tuple(person.position), rules.person_radius_m, color="tab:red", alpha=0.7)
        axes.add_patch(disc)
        axes.annotate(ground.replay.ids[person.id], person.position, fontsize=7, clip_on=True)
    axes.plot(*way.T, color="tab:blue", lw=1.2)
    axes.plot(*moment.thoughts.path.T, ".-", color="tab:green", lw=1.0, ms=3)
    axes.add_patch(circle(tuple(here), rules.robot_radius_m, color="tab:blue"))
    axes.plot(*episode.goal, "*", color="goldenrod", ms=14)
    axes.set_xlim(here[0] - VIEW_M, here[0] + VIEW_M)
    axes.set_ylim(here[1] - VIEW_M, here[1] + VIEW_M)
    axes.set_aspect("equal")
    axes.set_title(f"{moment.view.t:.1f} s", fontsize=9)
    axes.tick_params(labelsize=7)
