"""Paints bodies, ground, stairs and footprints, from the farthest to the nearest."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import ArrayLike
from PIL import Image, ImageColor, ImageDraw, ImageFont

from esplanade.actors.locomotion.body.skeleton import FOOT
from esplanade.footage.camera import Camera
from esplanade.footage.figure import Part
from esplanade.footage.film import FilmedFootprint
from esplanade.footage.vector import Shape
from esplanade.planning import Polygon, Scene
from esplanade.planning.compiled.arrays import Floats

Colour = str | tuple[int, int, int]

SMOOTHING: Final = 3
"""Pictures are painted larger by this factor, and then shrunk."""
SKY: Final = "#eef2f4"
GROUND: Final = "#d9d3c6"
GRID: Final = "#bfb7a6"
TREAD: Final = "#e9e2d3"
SIDE: Final = "#b9ae9c"
EDGE: Final = "#8d8373"
SHADOW: Final = "#b5ad9e"
INK: Final = "#2f3640"
FOOTPRINTS: Final = ("#3f7fbf", "#c0562f")
"""Colours of footprints of left and right feet."""

_GRID_M: Final = 0.5
_ROUND: Final = np.linspace(0.0, 2.0 * math.pi, 20, endpoint=False)
_CIRCLE: Final = np.stack((np.cos(_ROUND), np.sin(_ROUND)), axis=1)


class Canvas:
    """A picture that is being painted."""

    def __init__(self, camera: Camera) -> None:
        width, height = camera.size
        self.size = camera.size
        self._camera = Camera(
            camera.target,
            camera.azimuth_deg,
            camera.elevation_deg,
            camera.scale * SMOOTHING,
            (width * SMOOTHING, height * SMOOTHING),
        )
        self._image = Image.new("RGB", self._camera.size, SKY)
        self._draw = ImageDraw.Draw(self._image)
        self.shapes: list[Shape] = []
        """The shapes painted so far, in their order, in pixels of the camera."""

    def picture(self) -> Image.Image:
        """The picture painted so far, in the size of the camera."""
        return self._image.resize(self.size, Image.Resampling.LANCZOS)

    def paint_scene(self, scene: Scene) -> None:
        """Paint the ground with a grid of half metres, and what stands on it."""
        x0, y0, x1, y1 = scene.bounds
        corners = [(x0, y0, 0.0), (x1, y0, 0.0), (x1, y1, 0.0), (x0, y1, 0.0)]
        self._fill(corners, GROUND)
        for x in np.arange(x0, x1 + 1e-9, _GRID_M).tolist():
            self._line([(x, y0, 0.0), (x, y1, 0.0)], GRID)
        for y in np.arange(y0, y1 + 1e-9, _GRID_M).tolist():
            self._line([(x0, y, 0.0), (x1, y, 0.0)], GRID)
        towards = self._camera.axes[2]
        solids = scene.solids()
        for solid in sorted(solids, key=lambda solid: float(_middle(solid) @ towards[:2])):
            self._paint_solid(solid, towards)

    def paint_shadow(self, place: Floats, radius_m: float) -> None:
        """Paint a shadow on the ground at a place (3,), metres."""
        ring = np.column_stack((radius_m * _CIRCLE, np.zeros(len(_CIRCLE)))) + place
        self._fill(ring, SHADOW)

    def paint_footprint(self, footprint: FilmedFootprint, leg_m: float) -> None:
        """Paint a sole, for a leg of a length in metres."""
        x, y, z, heading = footprint.place.tolist()
        ahead = np.array([math.cos(heading), math.sin(heading)])
        aside = np.array([-ahead[1], ahead[0]])
        along = 0.5 * FOOT * leg_m * (1.0 + _CIRCLE[:, 0]) * 1.1
        across = 0.045 * _CIRCLE[:, 1] * (0.8 + 0.25 * _CIRCLE[:, 0])
        ring = np.array([x, y]) + along[:, None] * ahead + across[:, None] * aside
        ring3 = np.column_stack((ring, np.full(len(ring), z + 0.002)))
        self._fill(ring3, FOOTPRINTS[int(footprint.right)])

    def paint_body(self, parts: Sequence[Part]) -> None:
        """Paint the parts of a body from the farthest to the nearest."""
        towards = self._camera.axes[2]
        # Balls of a part count by their mean: so sleeves lie on the shirt, and hair on the head.
        for part in sorted(parts, key=lambda part: float(np.mean(part.centres @ towards))):
            self._paint_part(part)

    def write(self, text: str, at: tuple[float, float], size: float, colour: str = INK) -> None:
        """Write text at a place in pixels from the upper left corner."""
        font = ImageFont.load_default(size * SMOOTHING)
        self._draw.text((at[0] * SMOOTHING, at[1] * SMOOTHING), text, fill=colour, font=font)
        self.shapes.append(Shape([at], colour, size, text))

    def _paint_solid(self, solid: Polygon, towards: Floats) -> None:
        ring = list(solid.points)
        top = [(x, y, solid.top_at(x, y)) for x, y in ring]
        bottom = [(x, y, solid.offset_m) for x, y in ring]
        turning = sum(
            (x1 - x0) * (y1 + y0)
            for (x0, y0), (x1, y1) in zip(ring, ring[1:] + ring[:1], strict=True)
        )
        for k in range(len(ring)):
            n = (k + 1) % len(ring)
            (x0, y0), (x1, y1) = ring[k], ring[n]
            outward = np.array([y1 - y0, x0 - x1]) * (-1.0 if turning > 0.0 else 1.0)
            if outward @ towards[:2] > 0.0:
                shade = abs(outward[0]) / float(np.hypot(*outward))
                face = [bottom[k], bottom[n], top[n], top[k]]
                self._fill(face, _mixed(SIDE, "#ffffff", 0.18 * shade), EDGE)
        self._fill(top, TREAD, EDGE)

    def _paint_part(self, part: Part) -> None:
        centres = self._camera.pixels(part.centres)
        radii = part.radii_m * self._camera.scale
        outline = _hull(_balls(centres, radii + 1.1 * SMOOTHING))
        self._polygon(outline, _mixed(part.colour, "#101418", 0.55))
        self._polygon(_hull(_balls(centres, radii)), part.colour)
        lit = centres + radii[:, None] * np.array([-0.22, -0.3])
        self._polygon(_hull(_balls(lit, 0.45 * radii)), _mixed(part.colour, "#ffffff", 0.16))

    def _fill(self, points: ArrayLike, colour: Colour, edge: str | None = None) -> None:
        ring = [(x, y) for x, y in self._camera.pixels(points).tolist()]
        self._polygon(ring, colour)
        if edge is not None:
            self._stroke([*ring, ring[0]], edge)

    def _line(self, points: Sequence[tuple[float, float, float]], colour: str) -> None:
        self._stroke([(x, y) for x, y in self._camera.pixels(points).tolist()], colour)

    def _polygon(self, ring: Sequence[tuple[float, float]], colour: Colour) -> None:
        self._draw.polygon(ring, fill=colour)
        self.shapes.append(Shape(_shrunk(ring), colour))

    def _stroke(self, points: Sequence[tuple[float, float]], colour: str) -> None:
        self._draw.line(points, fill=colour, width=SMOOTHING)
        self.shapes.append(Shape(_shrunk(points), colour, 1.0))


def _shrunk(points: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    return [(x / SMOOTHING, y / SMOOTHING) for x, y in points]


def _middle(solid: Polygon) -> Floats:
    middle: Floats = np.mean(np.array(solid.points), axis=0)
    return middle


def _balls(centres: Floats, radii: Floats) -> Floats:
    """Points (20 K, 2) around K balls."""
    points: Floats = (centres[:, None] + radii[:, None, None] * _CIRCLE).reshape(-1, 2)
    return points


def _hull(points: Floats) -> list[tuple[float, float]]:
    """The corners of the convex hull of points (N, 2), by Andrew's monotone chain."""
    ordered = sorted(set(map(tuple, points.tolist())))

    def half(row: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
        made: list[tuple[float, float]] = []
        for point in row:
            while len(made) > 1 and _turns_right(made[-2], made[-1], point):
                made.pop()
            made.append(point)
        return made[:-1]

    return half(ordered) + half(ordered[::-1])


def _turns_right(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> bool:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) <= 0.0


def _mixed(colour: str, other: str, share: float) -> Colour:
    a, b = ImageColor.getrgb(colour), ImageColor.getrgb(other)
    red, green, blue = (round(p + share * (q - p)) for p, q in zip(a[:3], b[:3], strict=True))
    return red, green, blue
