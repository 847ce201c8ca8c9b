"""The plots of docs/walking.md: each shows what one part of the gait does, from its own code."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from esplanade.actors.locomotion.footsteps.planner import plan_steps
from esplanade.actors.locomotion.gait.curves import leg_angles
from esplanade.actors.locomotion.gait.durations import step_duration_s
from esplanade.actors.locomotion.gait.step_length import sl_planted, solve_relative_velocity
from esplanade.actors.locomotion.reaching import two_stage
from esplanade.actors.locomotion.reference import bezier, keyframes, paper_gait, rotations, table3
from esplanade.actors.locomotion.reference.published_lengths import sl_noslide, sl_paper
from esplanade.actors.locomotion.reference.step_phase import boundary_rates, step_phase
from esplanade.commandline.pictures import save
from esplanade.footage.film import film_walk
from esplanade.footage.targets import SHARES, random_targets
from esplanade.footage.walks import walks

_STYLE: Final[dict[Any, Any]] = {
    "axes.edgecolor": "#9aa0a6",
    "axes.grid": True,
    "axes.labelcolor": "#3a3f45",
    "axes.labelsize": 9,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlesize": 10,
    "font.size": 9,
    "grid.color": "#e3e3df",
    "grid.linewidth": 0.6,
    "legend.fontsize": 8,
    "legend.frameon": False,
    "lines.linewidth": 1.6,
    "path.simplify_threshold": 0.5,
    "svg.fonttype": "none",
    "svg.hashsalt": "esplanade",
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
}
_BLUE, _RED, _GREEN, _GREY = "#2f6f9f", "#c0562f", "#4b8f5a", "#8a8f96"
_LENGTHS: Final = ((0.2, _GREEN), (0.4, _BLUE), (0.65, _RED))
_PHASES: Final = np.linspace(0.0, 1.0, 161)


@contextmanager
def _figure(path: Path, columns: int, height_in: float = 2.5) -> Iterator[Any]:
    """Axes side by side, which are saved at the end; the same code writes the same file."""
    with mpl.rc_context(_STYLE):
        figure = Figure(figsize=(7.6, height_in), layout="constrained")
        yield figure.subplots(1, columns)
        save(figure, path)


def curves(path: Path) -> None:
    with _figure(path, 3) as axes:
        for column, joint in enumerate(("hip", "knee", "ankle")):
            for length, colour in _LENGTHS:
                rv = np.broadcast_to(solve_relative_velocity(np.array([length])), _PHASES.shape)
                angles = np.degrees(leg_angles(rv, _PHASES)[:, column])
                axes[column].plot(_PHASES, angles, color=colour, label=f"step {length:g}")
            axes[column].set(title=f"{joint}, degrees", xlabel="phase of the leg")
        axes[0].legend()


def step_length(path: Path) -> None:
    rv = np.linspace(0.0, 0.5, 101)
    with _figure(path, 2) as (left, right):
        left.plot(rv, sl_planted(rv), color=_RED, label="planted: what is walked")
        left.plot(rv, sl_paper(rv), "--", color=_BLUE, label="heel to heel, eq. (10)")
        left.plot(rv, sl_noslide(rv), ":", color=_GREEN, label="from heel over toe, eq. (9)")
        left.plot(rv, table3.eq12_printed(rv), "-.", color=_GREY, label="eq. (12) as printed")
        left.set(xlabel="relative velocity", ylabel="step, legs", title="step length")
        left.legend()
        found = table3.reproduce()
        right.plot(table3.LENGTHS, found.rv, color=_BLUE, label="reproduced, offset fitted")
        plain = table3.reproduce(0.0)
        right.plot(table3.LENGTHS, plain.rv, "--", color=_GREY, label="without the offset")
        right.plot(table3.LENGTHS, table3.PRINTED_RV, "o", color=_RED, ms=4, label="table 3")
        right.set(xlabel="step, legs", ylabel="relative velocity", title="table 3")
        right.legend()


def planted(path: Path) -> None:
    length = 0.5
    made = paper_gait.walk(np.full((1, 5), length))
    heels, toes = made.feet()
    steps = np.arange(heels.shape[1]) / paper_gait.FRAMES_A_STEP
    phases = 0.5 * steps
    _, legs = keyframes.walked(length, phases % 1.0)
    with _figure(path, 2) as (left, right):
        left.plot(steps, heels[0, :, 0, 1], color=_GREY, label="published: heel")
        left.plot(steps, toes[0, :, 0, 1], ":", color=_GREY, label="published: toe")
        left.plot(steps, legs.ankles[:, 0, 2], color=_RED, label="planted: heel")
        left.plot(steps, legs.toes[:, 0, 2], ":", color=_RED, label="planted: toe")
        left.axhline(0.0, color="#3a3f45", lw=0.8)
        left.set(xlabel="steps", title="left foot above the ground, legs")
        left.legend()
        travelled = 2.0 * length * phases
        right.plot(steps, toes[0, :, 0, 0], color=_GREY, label="published")
        right.plot(steps, legs.toes[:, 0, 0] + travelled, color=_RED, label="planted")
        right.set(xlabel="steps", title="left toe along the way, legs")
        right.legend()


def planner(path: Path) -> None:
    with _figure(path, 2) as (left, right):
        for distance, colour in ((2.0, _GREEN), (4.5, _BLUE), (9.0, _RED)):
            lengths = plan_steps(distance)
            left.plot(lengths, "o-", ms=3.5, color=colour, label=f"{distance:g} legs")
        left.set(xlabel="step", ylabel="legs", title="steps of a distance")
        left.legend()
        ways = np.linspace(0.05, 8.0, 400)
        full = [float(plan_steps(way).max()) for way in ways.tolist()]
        right.plot(ways, full, color=_BLUE)
        right.set(xlabel="distance, legs", ylabel="legs", title="longest of its steps")


def durations(path: Path) -> None:
    lengths = np.linspace(0.0, 0.75, 151)
    taken = np.array([0.95, 0.7, 0.55, 0.5, 0.75])
    rates = boundary_rates(taken)
    share = np.linspace(0.0, 1.0, 60)
    starts = np.concatenate(([0.0], np.cumsum(taken)))
    with _figure(path, 2) as (left, right):
        left.plot(lengths, step_duration_s(lengths), color=_BLUE)
        left.set(xlabel="step, legs", ylabel="s", title="duration of a step", ylim=(0.0, 1.1))
        for k, seconds in enumerate(taken.tolist()):
            phase = step_phase(share, seconds, rates[k], rates[k + 1])
            pace = np.gradient(phase, share * seconds)
            right.plot(starts[k] + share * seconds, pace, color=_RED)
            right.hlines(1.0 / seconds, starts[k], starts[k + 1], color=_GREY, ls=":")
        right.set(xlabel="s", ylabel="steps a second", title="pace over five steps", ylim=(0, 2.3))


def blending(path: Path) -> None:
    u = np.linspace(0.0, 1.0, 81)
    level = bezier.bernstein(4, u)
    with _figure(path, 2) as (left, right):
        for k in range(4):
            left.plot(u, level[:, k], color=(_BLUE, _BLUE, _RED, _RED)[k], ls="-:"[k % 2])
        left.plot(u, level[:, 2:].sum(axis=1), color="#3a3f45", label="weight of the next step")
        left.set(xlabel="share of the step", title="Bezier weights of two and two poses")
        left.legend()
        made = paper_gait.walk(np.array([[0.2, 0.6, 0.6, 0.3]]))
        knees = np.degrees(made.angles[0, :, 0, 1])
        right.plot(np.arange(len(knees)) / paper_gait.FRAMES_A_STEP, knees, color=_RED)
        right.set(xlabel="steps", title="left knee while steps change: .2 .6 .6 .3, degrees")


def bends(path: Path) -> None:
    taken = film_walk(walks()["curve"], 20)
    with _figure(path, 2, 3.0) as (left, right):
        for footprint in taken.footprints:
            x, y, _, heading = footprint.place.tolist()
            colour = _RED if footprint.right else _BLUE
            tip = 0.22 * np.array([np.cos(heading), np.sin(heading)])
            left.plot([x, x + tip[0]], [y, y + tip[1]], color=colour, lw=3.0)
        left.plot(*taken.poses.root[:, :2].T, color="#3a3f45", lw=1.0, label="hips")
        left.plot(*taken.walk.places.T, ":", color=_GREY, lw=1.2, label="way")
        left.set(title="footprints round two bends, m", aspect="equal")
        left.legend()
        yaw = _headings(taken.poses.pelvis)
        right.plot(taken.times_s, yaw, color="#3a3f45", label="pelvis")
        for side, colour in ((0, _BLUE), (1, _RED)):
            turned = np.degrees(np.unwrap(taken.poses.headings[:, side]))
            right.plot(taken.times_s, turned, color=colour, label=("left", "right")[side])
        right.set(xlabel="s", title="where feet and pelvis point, degrees")
        right.legend()


def stairs(path: Path) -> None:
    taken = film_walk(walks()["stairs"], 40)
    scene = taken.walk.scene
    with _figure(path, 1, 2.8) as axis:
        for solid in scene.solids():
            xs = [x for x, _ in solid.points]
            top = solid.offset_m + solid.height_m
            axis.fill_between([min(xs), max(xs)], 0.0, top, color="#e6ded0", lw=0)
        for side, colour in ((0, _BLUE), (1, _RED)):
            name = ("left", "right")[side]
            ankles = taken.poses.ankles[:, side]
            axis.plot(ankles[:, 0], ankles[:, 2], color=colour, lw=1.2, label=f"{name} heel")
        root = taken.poses.root
        axis.plot(root[:, 0], root[:, 2], color="#3a3f45", lw=1.2, label="hips")
        axis.set(xlabel="m", title="heels and hips on stairs, m", aspect="equal")
        axis.legend(loc="upper right")


def rotations_between(path: Path) -> None:
    a = rotations.from_euler(np.radians([-70.0, -60.0, 20.0]))
    b = rotations.from_euler(np.radians([80.0, 70.0, -60.0]))
    share = np.linspace(0.0, 1.0, 121)
    arc = rotations.slerp(a, b, share)
    start, end = rotations.to_euler(a), rotations.to_euler(b)
    by_angles = rotations.from_euler(start + share[:, None] * (end - start))
    with _figure(path, 2) as (left, right):
        for q, colour, label in (
            (arc, _RED, "slerp"),
            (by_angles, _GREY, "Euler angles, straight"),
        ):
            turned = np.degrees(rotations.angle_between(q[:-1], q[1:])) / np.diff(share)
            left.plot(share[1:], turned, color=colour, label=label)
        left.set(xlabel="share", title="speed of turning, degrees", ylim=(0, None))
        left.legend()
        angles = np.degrees(rotations.to_euler(arc))
        for k, (name, colour) in enumerate(zip("YXZ", (_BLUE, _RED, _GREEN), strict=True)):
            right.plot(share, angles[:, k], color=colour, label=f"about {name}")
        right.set(xlabel="share", title="Euler angles on the way, degrees")
        right.legend()


def key_poses(path: Path) -> None:
    length = 0.5
    phases = keyframes.key_phases(length)
    truth = keyframes.exact(length, _PHASES)
    slerped = keyframes.interpolate(keyframes.exact(length, phases), phases, _PHASES)
    mended = keyframes.repaired(slerped, length, _PHASES)
    with _figure(path, 2) as (left, right):
        for frames, colour, label in (
            (truth, "#3a3f45", "gait"),
            (slerped, _RED, "eight keys, slerp"),
            (mended, _BLUE, "repaired by IK"),
        ):
            style = "--" if frames is mended else "-"
            knee = frames.joints[:, keyframes.KNEES][:, 0]
            bent = np.degrees(rotations.angle_between(knee, rotations.IDENTITY))
            left.plot(_PHASES, bent, style, color=colour, label=label)
            heel = keyframes.feet_of(frames).ankles[:, 0, 2]
            right.plot(_PHASES, heel, style, color=colour)
        left.plot(phases, np.interp(phases, _PHASES, _knee_deg(truth)), "o", color=_RED, ms=4)
        left.set(xlabel="phase", title="left knee, degrees")
        left.legend()
        right.set(xlabel="phase", title="left heel above the ground, legs")


def reaching(path: Path) -> None:
    chain = two_stage.heel_chain(left=True)
    random = np.random.default_rng(5)
    with _figure(path, len(SHARES)) as axes:
        for axis, (title, trunk_share) in zip(axes, SHARES.items(), strict=True):
            starts, targets = random_targets(chain, trunk_share, 1000, random)
            for found, colour, label in (
                (two_stage.reach_by_ccd(chain, targets, starts), _GREY, "plain CCD"),
                (
                    two_stage.reach_by_ccd(chain, targets, starts, limb_sweeps=10),
                    _BLUE,
                    "CCD, then CCD",
                ),
                (two_stage.reach(chain, targets, starts, random), _RED, "closed form, then CCD"),
            ):
                work = np.sort(found.turned[found.reached])
                reached = np.arange(1, len(work) + 1) / len(targets)
                axis.step(work, reached, color=colour, label=label)
            axis.set(
                xscale="log", xlabel="hinges turned", title=f"reached: {title}", ylim=(0, 1.02)
            )
        axes[0].legend(loc="lower right")


def _knee_deg(frames: keyframes.Frames) -> Any:
    knee = frames.joints[:, keyframes.KNEES][:, 0]
    return np.degrees(rotations.angle_between(knee, rotations.IDENTITY))


def _headings(q: Any) -> Any:
    forward = rotations.rotate(q, [1.0, 0.0, 0.0])
    return np.degrees(np.unwrap(np.arctan2(forward[:, 1], forward[:, 0])))


PLOTS: Final[dict[str, Callable[[Path], None]]] = {
    "curves": curves,
    "step-length": step_length,
    "blending": blending,
    "planted": planted,
    "durations": durations,
    "planner": planner,
    "bends": bends,
    "stairs": stairs,
    "rotations": rotations_between,
    "keyframes": key_poses,
    "reaching": reaching,
}
"""All plots by the names of their files."""
