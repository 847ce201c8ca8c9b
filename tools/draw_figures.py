"""Draw figs. 4, 7, 8, 10 and 11 of Lei & Li into docs/images, from the planner's own decisions.

python tools/draw_figures.py
"""

from collections.abc import Hashable, Sequence
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray
from tools.paper_scenes import FIG_10, FIG_11, Figure, Point

from esplanade.actors import ActorParameters, Navigator, Reason
from esplanade.planning import (
    PEOPLE,
    LayeredGrid,
    PlanModel,
    Potential,
    Prediction,
    RiskField,
    RiskModel,
    RuleModel,
    Scene,
)
from esplanade.planning.agents._bottleneck_kernels import Lane
from esplanade.planning.agents._perturb_kernels import perturb_path, risks_along, room_to_perturb
from esplanade.planning.agents._reservation_kernels import index_paths
from esplanade.planning.agents._task_kernels import Task, World, needed_clearance
from esplanade.planning.agents.search import make_reservations
from esplanade.planning.grid._grid_kernels import follow_path
from esplanade.planning.routes._potential_kernels import PotentialValues

Floats = NDArray[np.float64]
IMAGES: Final = Path(__file__).resolve().parents[1] / "docs" / "images"
SCALE: Final = 16.0
GAP: Final = 10.0
TICK_S: Final = 0.1
RADIUS_M: Final = 0.25

STYLE: Final = """
rect.ground { fill: #fbfaf7; stroke: #d8d4ca; }
text { font: 14px sans-serif; fill: #333; }
.building { fill: #cfc9bb; }
.straight { stroke: #b9b4a8; stroke-dasharray: 4 5; fill: none; }
.likely { fill: #d1495b; fill-opacity: 0.10; stroke: #d1495b; stroke-opacity: 0.4; }
.person { fill: #d1495b; }
.past { fill: none; stroke: #d1495b; stroke-width: 1.5; }
.path { fill: none; stroke: #1c6e8c; stroke-width: 2.5; }
.walked { fill: none; stroke: #1c6e8c; stroke-width: 1.5; stroke-dasharray: 2 3; }
.actor, .end { fill: #1c6e8c; }
.tried { fill: none; stroke: #1c6e8c; }
.taken { fill: #1c6e8c; }
.goal { fill: none; stroke: #1c6e8c; stroke-width: 2; }
"""


class Panel:
    """One picture of a strip: a part of the plane, seen from above."""

    def __init__(
        self, title: str, x0: float, y0: float, x1: float, y1: float, scale: float = SCALE
    ) -> None:
        self._x0, self._y1, self._scale = x0, y1, scale
        self.width, self.height = scale * (x1 - x0), scale * (y1 - y0)
        self.parts = [
            f'<rect class="ground" width="{self.width:.0f}" height="{self.height:.0f}" rx="5"/>'
        ]
        self._title = f'<text x="8" y="{self.height - 9:.0f}">{title}</text>'

    def at(self, point: Sequence[float]) -> tuple[float, float]:
        """A point of the plane in the picture."""
        return self._scale * (point[0] - self._x0), self._scale * (self._y1 - point[1])

    def disc(self, point: Sequence[float], radius_m: float, kind: str) -> None:
        """Draw a circle."""
        x, y = self.at(point)
        self.parts.append(
            f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{self._scale * radius_m:.1f}" class="{kind}"/>'
        )

    def line(self, points: Sequence[Sequence[float]] | Floats, kind: str) -> None:
        """Draw a line through points."""
        corners = " L".join("{:.1f},{:.1f}".format(*self.at(point)) for point in points)
        self.parts.append(f'<path d="M{corners}" class="{kind}"/>')

    def buildings(self, scene: Scene) -> None:
        """Draw the buildings."""
        for polygon in scene.polygons:
            corners = " ".join("{:.0f},{:.0f}".format(*self.at(p)) for p in polygon.points)
            self.parts.append(f'<polygon points="{corners}" class="building"/>')

    def text(self) -> str:
        """The picture."""
        return "\n".join([*self.parts, self._title])


def write(name: str, panels: Sequence[Panel], columns: int, defs: str = "") -> None:
    """Write panels of one size into a file."""
    width, height = panels[0].width + GAP, panels[0].height + GAP
    rows = -(-len(panels) // columns)
    groups = [
        f'<svg x="{k % columns * width:.0f}" y="{k // columns * height:.0f}" '
        f'width="{panel.width:.0f}" height="{panel.height:.0f}">{panel.text()}</svg>'
        for k, panel in enumerate(panels)
    ]
    body = "\n".join(groups)
    (IMAGES / name).write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" '
        f'viewBox="0 0 {columns * width - GAP:.0f} {rows * height - GAP:.0f}">'
        f"<style>{STYLE}</style>{defs}\n{body}\n</svg>\n"
    )


def fig_4() -> None:
    """Where a person will be: the probability at five times, darker where it is greater."""
    nav = Navigator(Scene.open_space((0.0, 0.0, 16.0, 9.0)), TICK_S, plan=PlanModel(threads=1))
    past = []
    for k in range(30):
        past.append((2.0 + 0.11 * k, 7.0 - 0.0012 * k * k))
        nav.observe({"p": past[-1]})
        nav.tick()
    (future,) = nav.predicted_near(past[-1], 0.0, 1.0)
    nav.close()
    model, shades, panels = RiskModel(), [], []
    for n, k in enumerate((0, 4, 8, 12, 18)):
        seconds = k * PlanModel().slice_s
        panel = Panel(f"({'bcdef'[n]}) in {seconds:.1f} s", 1.0, 1.0, 12.0, 8.5)
        panel.line(past, "past")
        x, y, _, sigma = future[k]
        deviations = np.hypot(sigma, model.sway_m) * np.array(PEOPLE.scales)
        shades.append(_shade(f"s{n}", deviations))
        cx, cy = panel.at((x, y))
        reach = SCALE * 3.0 * float(deviations.max())
        panel.parts.append(
            f'<circle cx="{cx:.1f}" cy="{cy:.1f}" r="{reach:.1f}" fill="url(#s{n})"/>'
        )
        panel.disc(past[-1], RADIUS_M, "person")
        panels.append(panel)
    first = Panel("(a) the way so far", 1.0, 1.0, 12.0, 8.5)
    first.line(past, "past")
    first.disc(past[-1], RADIUS_M, "person")
    write("fig-4.svg", [first, *panels], 3, f"<defs>{''.join(shades)}</defs>")


def _shade(name: str, deviations: Floats) -> str:
    """Grey by the density of the mixture, as a part of what it is with a deviation of 0.1 m."""
    parts = np.linspace(0.0, 1.0, 16)
    away = 3.0 * deviations.max() * parts[:, None]
    weights = np.array(PEOPLE.weights) / deviations**2
    density = (weights * np.exp(-0.5 * (away / deviations) ** 2)).sum(axis=1) * 0.1**2
    stops = [
        f'<stop offset="{part:.3f}" stop-color="#222" stop-opacity="{min(1.0, d) ** 0.5:.3f}"/>'
        for part, d in zip(parts, density, strict=True)
    ]
    return f'<radialGradient id="{name}">{"".join(stops)}</radialGradient>'


def figs_7_and_8() -> None:
    """A followed path near two people: the candidates of one stretch, and all that are bent."""
    start, goal = (1.0, 4.0), (8.5, 4.0)
    people = np.array([(2.17, 4.65), (4.51, 3.35)])
    world, potential, task = _question(start, goal, people)
    seconds = PlanModel().slice_s * np.arange(PlanModel().slices + 1)
    straight = np.array(start) + np.outer(1.3 * seconds, (1.0, 0.0))
    bent, stretches = straight.copy(), []
    room = room_to_perturb(len(bent))
    room.cells[0] = task.cell
    follow_path(world.grid, bent, room.cells, 0, len(bent) - 1)
    need, rules = needed_clearance(world, task), world.rules[0]
    risks_along(world, task, task.cell, bent, 0, len(bent) - 1, np.inf, room.risks)
    left = [(0, len(bent) - 1)]
    while left:  # as `update_path`, step by step
        first, last = left.pop()
        before = bent.copy()
        held = perturb_path(world, potential, task, need, bent, first, last, room)
        stretches.append((first, last, before, bent.copy(), bool(held)))
        if not held and last - first >= rules["shortest_stretch"]:
            middle = (first + last) // 2
            left += [(middle, last), (first, middle)]
    panels = []
    for first, last, before, after, held in [s for s in stretches if s[-1] or s[1] - s[0] > 8][:3]:
        panel = _ground(f"slices {first} to {last}: " + ("bent" if held else "halved"), people)
        panel.line(before, "straight")
        chord = before[last] - before[first]
        normal = np.array([-chord[1], chord[0]]) / np.hypot(*chord)
        for n in range(-rules["offsets"], rules["offsets"] + 1):
            tip = before[first] + 0.5 * chord + n * rules["offset_m"] * normal
            panel.disc(tip, 0.07, "tried" if n else "end")
        panel.line(after[first : last + 1], "path")
        for end in (before[first], before[last]):
            panel.disc(end, 0.1, "end")
        if held:
            panel.disc(after[(first + last) // 2], 0.1, "taken")
        panels.append(panel)
    whole = _ground("the whole path, updated", people)
    whole.line(straight, "straight")
    whole.line(bent, "path")
    write("fig-7-8.svg", [*panels, whole], 2)


def _ground(title: str, people: Floats) -> Panel:
    panel = Panel(title, 0.5, 2.7, 7.0, 5.3, 60.0)
    for place in people:
        panel.disc(place, RADIUS_M, "person")
    return panel


def _question(start: Point, goal: Point, people: Floats) -> tuple[World, PotentialValues, Task]:
    """The task of an actor alone among people who stand, at its preferred speed."""
    plan, own, rules = PlanModel(), ActorParameters(), RuleModel()
    grid = LayeredGrid.from_scene(Scene.open_space((0.0, 0.0, 10.0, 8.0)))
    field = RiskField(grid, RiskModel(), plan.slices, PEOPLE)
    shape = len(people), plan.slices + 1
    sigmas = np.broadcast_to(0.17 * plan.slice_s * np.arange(shape[1]), shape).copy()
    still = np.zeros((*shape, 2))
    field.fill(Prediction(still + people[:, None], still, sigmas, np.zeros(shape), still[:, 0]))
    paths = np.full((1, shape[1], 2), start)
    alone = make_reservations(
        grid, paths, np.zeros((1, shape[1])), np.array([RADIUS_M]), np.zeros(1, np.int64), 0.4
    )
    index_paths(alone)
    world = World(grid.arrays, field.arrays, alone, rules.row, plan.step_s, RADIUS_M)
    values = {**own.model_dump(), "wall_room_m": rules.wall_room_m}
    values |= {"x": start[0], "y": start[1], "vx": own.speed_mps, "vy": 0.0, "hold": False}
    values |= {"goal_x": goal[0], "goal_y": goal[1], "me": 0, "body": 0, "contact": 0}
    values |= {"cell": int(grid.on_ground([start], [0.0])[1][0]), "on_edges": 0.0}
    values["edge_cells"] = float(own.edge_cells)
    values["lane"] = Lane(0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
    task = Task(**{name: values[name] for name in Task._fields})
    return world, Potential(grid, goal, 0, RADIUS_M).values, task


def experiment(name: str, figure: Figure, instants_s: Sequence[float]) -> None:
    """Pictures of an experiment at some times, and one of the whole way."""
    nav = Navigator(figure.scene, TICK_S, plan=PlanModel(threads=1))
    nav.add_actor("a", figure.start, figure.goal)
    walked, panels = [figure.start], []
    ways: dict[Hashable, list[Point]] = {who: [] for who in figure.people}
    for k in range(round(figure.seconds / TICK_S)):
        now: dict[Hashable, Point] = {who: walk(k * TICK_S) for who, walk in figure.people.items()}
        nav.observe(now)
        state = nav.tick()["a"]
        for who, where in now.items():
            ways[who].append(where)
        if any(abs(k * TICK_S - instant) < TICK_S / 2 for instant in instants_s):
            panel = _seen(figure, f"t = {k * TICK_S:.1f} s", walked, ways)
            for circles in nav.predicted_near(walked[-1], 0.0, 20.0):
                for x, y, _, sigma in circles[4::4]:
                    panel.disc((x, y), 2.0 * sigma, "likely")
            panel.line(state.way[:, :2], "path")
            panels.append(panel)
        walked.append(state.position)
        if state.reason is Reason.ARRIVED:
            break
    nav.close()
    last = _seen(figure, f"the whole way, {k * TICK_S:.1f} s", walked, ways)
    last.line(walked, "path")
    write(name, [*panels, last], 4)


def _seen(
    figure: Figure, title: str, walked: Sequence[Point], ways: dict[Hashable, list[Point]]
) -> Panel:
    panel = Panel(title, *figure.scene.bounds)
    panel.buildings(figure.scene)
    panel.line([figure.start, figure.goal], "straight")
    panel.line(walked, "walked")
    panel.disc(walked[-1], RADIUS_M, "actor")
    panel.disc(figure.goal, 0.3, "goal")
    for way in ways.values():
        panel.line(way, "past")
        panel.disc(way[-1], RADIUS_M, "person")
    return panel


def main() -> None:
    fig_4()
    figs_7_and_8()
    experiment("fig-10.svg", FIG_10, (0.0, 1.5, 3.0, 4.0, 5.0, 6.0, 7.5))
    experiment("fig-11.svg", FIG_11, (0.0, 3.0, 5.0, 7.0, 9.0, 11.0, 13.0))


if __name__ == "__main__":
    main()
