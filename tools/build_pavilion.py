"""Write scenes/pavilion.obj: a pavilion of two storeys around a spiral stair, amid hills.

python tools/build_pavilion.py
"""

import math
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

OUT = Path(__file__).resolve().parents[1] / "scenes" / "pavilion.obj"

SIDES = 16
GROUND_M = 0.3
UPPER_M = 3.8
SLAB_M = 0.3
EAVES_M = 6.8
APEX_M = 9.0
TERRACE_R, STEP_R, SLAB_R, ROOF_R = 9.0, 9.5, 7.5, 8.2
COLUMNS_R, WELL_R, POST_R = 6.75, 2.75, 0.5
RAILING_M, RAILING_THICK_M = 1.1, 0.15

STEPS = 24
STEP_TURN = math.radians(400) / STEPS
FIRST_STEP = math.radians(-90)
STEP_THICK_M = 0.3
HEAD_ARC = math.radians(60)
"""The angle of the upper railing that is left out where the stair arrives."""

LAND_M, LAND_CELL_M = 26.0, 2.0

Point = tuple[float, float]
Corner = tuple[float, float, float]


class Mesh:
    """Triangles and quads, x east, y north, z up."""

    def __init__(self) -> None:
        self.corners: dict[Corner, int] = {}
        """Each with its number, from 1."""
        self.faces: list[list[int]] = []

    def face(self, *corners: Corner) -> None:
        """Add a face; its corners are counter-clockwise as seen from outside."""
        rounded = [(round(x, 3), round(y, 3), round(z, 3)) for x, y, z in corners]
        numbers = [self.corners.setdefault(each, len(self.corners) + 1) for each in rounded]
        self.faces.append(numbers)

    def prism(self, ring: Sequence[Point], bottom: float, top: float) -> None:
        """Add the prism of a convex, counter-clockwise ring between two heights."""
        for (ax, ay), (bx, by) in pairwise([*ring, ring[0]]):
            self.face((ax, ay, bottom), (bx, by, bottom), (bx, by, top), (ax, ay, top))
        (x0, y0), *rest = ring
        for (ax, ay), (bx, by) in pairwise(rest):
            self.face((x0, y0, top), (ax, ay, top), (bx, by, top))
            self.face((x0, y0, bottom), (bx, by, bottom), (ax, ay, bottom))

    def text(self) -> str:
        """The mesh as OBJ, y up."""
        lines = ["# Esplanade: a pavilion, metres, y up. Written by tools/build_pavilion.py"]
        lines += [f"v {x:g} {z:g} {0.0 - y:g}" for x, y, z in self.corners]
        lines += ["f " + " ".join(map(str, face)) for face in self.faces]
        return "\n".join(lines) + "\n"


def at(radius: float, angle: float) -> Point:
    return radius * math.cos(angle), radius * math.sin(angle)


def disc(radius: float, sides: int = SIDES) -> list[Point]:
    return [at(radius, 2.0 * math.pi * k / sides) for k in range(sides)]


def sector(inner: float, outer: float, start: float, end: float) -> list[Point]:
    """Part of a ring, between two angles."""
    return [at(inner, start), at(outer, start), at(outer, end), at(inner, end)]


def ring(mesh: Mesh, inner: float, outer: float, bottom: float, top: float) -> None:
    for k in range(SIDES):
        start, end = (2.0 * math.pi * (k + i) / SIDES for i in (0, 1))
        mesh.prism(sector(inner, outer, start, end), bottom, top)


def spiral(mesh: Mesh) -> float:
    """The stair around the middle post; returns the angle at which it arrives."""
    rise = (UPPER_M - GROUND_M) / STEPS
    for k in range(STEPS):
        start = FIRST_STEP + k * STEP_TURN
        top = GROUND_M + (k + 1) * rise
        bottom = max(GROUND_M, top - STEP_THICK_M)
        mesh.prism(sector(POST_R, WELL_R, start, start + STEP_TURN), bottom, top)
    return FIRST_STEP + STEPS * STEP_TURN


def railings(mesh: Mesh, head: float) -> None:
    """Add railings around the upper floor, and around the well but for the head of the stair."""
    top = UPPER_M + RAILING_M
    ring(mesh, SLAB_R - RAILING_THICK_M, SLAB_R, UPPER_M, top)
    pieces = 24
    for k in range(pieces):
        start, end = (head + (2.0 * math.pi - HEAD_ARC) * (k + i) / pieces for i in (0, 1))
        mesh.prism(sector(WELL_R, WELL_R + RAILING_THICK_M, start, end), UPPER_M, top)


def roof(mesh: Mesh) -> None:
    for (ax, ay), (bx, by) in pairwise([*disc(ROOF_R), disc(ROOF_R)[0]]):
        mesh.face((ax, ay, EAVES_M), (bx, by, EAVES_M), (0.0, 0.0, APEX_M))
        mesh.face((bx, by, EAVES_M), (ax, ay, EAVES_M), (0.0, 0.0, APEX_M - 0.3))


def land_height(x: float, y: float) -> float:
    """The height of the land: it is level around the pavilion, with hills farther out."""
    away = min(1.0, max(0.0, (math.hypot(x, y) - 11.0) / 11.0))
    hills = 1.7 + 1.2 * math.sin(0.23 * x + 0.6) * math.cos(0.19 * y - 0.4)
    return away * away * (3.0 - 2.0 * away) * hills


def land(mesh: Mesh) -> None:
    count = round(2.0 * LAND_M / LAND_CELL_M)
    lines = [-LAND_M + k * LAND_CELL_M for k in range(count + 1)]
    for x0, x1 in pairwise(lines):
        for y0, y1 in pairwise(lines):
            a, b, c, d = (
                (x, y, land_height(x, y)) for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
            )
            mesh.face(a, b, c)
            mesh.face(a, c, d)


def pavilion() -> Mesh:
    mesh = Mesh()
    land(mesh)
    mesh.prism(disc(STEP_R), 0.0, GROUND_M / 2.0)
    mesh.prism(disc(TERRACE_R), GROUND_M / 2.0, GROUND_M)
    ring(mesh, WELL_R, SLAB_R, UPPER_M - SLAB_M, UPPER_M)
    mesh.prism(disc(POST_R, 12), GROUND_M, APEX_M - 0.5)
    for k in range(8):
        x, y = at(COLUMNS_R, 2.0 * math.pi * (k + 0.5) / 8)
        column = [(x + 0.25 * u, y + 0.25 * v) for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        mesh.prism(column, GROUND_M, UPPER_M - SLAB_M)
        mesh.prism(column, UPPER_M, EAVES_M + 0.3)
    for k in (1, 3, 5, 7):
        start = 2.0 * math.pi * k / 8 - 0.25
        mesh.prism(sector(4.6, 5.1, start, start + 0.5), UPPER_M, UPPER_M + 0.45)
        mesh.prism(sector(4.6, 5.1, start, start + 0.5), GROUND_M, GROUND_M + 0.45)
    railings(mesh, spiral(mesh))
    roof(mesh)
    return mesh


if __name__ == "__main__":
    OUT.write_text(pavilion().text(), encoding="utf-8")
    print(OUT)
