"""Draw docs/images/encounters.svg: how one search bends around a person, four cases.

python tools/draw_encounters.py
"""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from esplanade.actors import ActorParameters, Navigator
from esplanade.planning import PlanModel, Scene

OUT = Path(__file__).resolve().parents[1] / "docs" / "images" / "encounters.svg"
START, GOAL = (2.0, 5.0), (12.0, 5.0)
CASES = {
    "(a) far away": ((4.0, 8.6), (0.5, 0.0)),
    "(b) near": ((5.4, 5.5), (0.5, 0.0)),
    "(c) heading for the actor": ((7.5, 5.2), (-0.8, 0.0)),
    "(d) heading away": ((7.5, 5.2), (0.8, 0.0)),
}
SCALE = 34.0
WIDTH, HEIGHT = 14.0, 7.6
TOP = 9.8
WALKED_S = 2.0


def plan(where: tuple[float, float], way: tuple[float, float]) -> tuple[NDArray[np.float64], ...]:
    """Path of an actor already walking, and one person's predicted circles."""
    nav = Navigator(Scene.open_space((0.0, 0.0, WIDTH, 10.0)), plan=PlanModel(threads=1))
    nav.add_actor("a", START, GOAL, ActorParameters())
    for k in range(round(WALKED_S / nav.tick_s) + 1):
        seconds = k * nav.tick_s - WALKED_S
        nav.place_actor("a", START, (1.3, 0.0))
        nav.observe({"p": (where[0] + way[0] * seconds, where[1] + way[1] * seconds)})
        state = nav.tick()["a"]
    (circles,) = nav.predicted_near(START, 0, 20.0)
    nav.close()
    return state.path, circles


def panel(title: str, path: NDArray[np.float64], circles: NDArray[np.float64]) -> str:
    def at(x: float, y: float) -> str:
        return f"{SCALE * x:.1f},{SCALE * (TOP - y):.1f}"

    parts = [f'<text x="12" y="{SCALE * HEIGHT - 14:.0f}">{title}</text>']
    parts.append(f'<path d="M{at(*START)} L{at(*GOAL)}" class="straight"/>')
    for x, y, _, sigma in circles[::4]:
        cx, cy = at(x, y).split(",")
        parts.append(f'<circle cx="{cx}" cy="{cy}" r="{SCALE * 2 * sigma:.1f}" class="likely"/>')
    x, y = at(*circles[0, :2]).split(",")
    parts.append(f'<circle cx="{x}" cy="{y}" r="{SCALE * 0.25:.1f}" class="person"/>')
    line = " L".join(at(x, y) for x, y in path[:, :2])
    parts.append(f'<path d="M{line}" class="path"/>')
    for x, y in path[::4, :2]:
        cx, cy = at(x, y).split(",")
        parts.append(f'<circle cx="{cx}" cy="{cy}" r="3.5" class="instant"/>')
    x, y = at(*START).split(",")
    parts.append(f'<circle cx="{x}" cy="{y}" r="{SCALE * 0.25:.1f}" class="actor"/>')
    x, y = at(*GOAL).split(",")
    parts.append(f'<circle cx="{x}" cy="{y}" r="5" class="goal"/>')
    return "\n".join(parts)


STYLE = """
rect { fill: #fbfaf7; stroke: #d8d4ca; }
text { font: 17px sans-serif; fill: #333; }
.straight { stroke: #b9b4a8; stroke-dasharray: 5 6; fill: none; }
.likely { fill: #d1495b; fill-opacity: 0.10; stroke: #d1495b; stroke-opacity: 0.45; }
.person { fill: #d1495b; }
.path { fill: none; stroke: #1c6e8c; stroke-width: 3; }
.instant, .actor { fill: #1c6e8c; }
.goal { fill: none; stroke: #1c6e8c; stroke-width: 2.5; }
"""


def main() -> None:
    width, height = SCALE * WIDTH, SCALE * HEIGHT
    panels = []
    for k, (title, person) in enumerate(CASES.items()):
        x, y = (k % 2) * (width + 12), (k // 2) * (height + 12)
        panels.append(
            f'<g transform="translate({x:.0f} {y:.0f})"><rect width="{width:.0f}" '
            f'height="{height:.0f}" rx="6"/>\n{panel(title, *plan(*person))}</g>'
        )
    size = f"{2 * width + 12:.0f} {2 * height + 12:.0f}"
    body = "\n".join(panels)
    OUT.write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size}">'
        f"<style>{STYLE}</style>\n{body}\n</svg>\n"
    )


if __name__ == "__main__":
    main()
