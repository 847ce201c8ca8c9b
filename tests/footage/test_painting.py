"""Paint: grounds, solids, footprints and bodies land where the camera has them."""

import numpy as np
import pytest
from PIL import ImageColor

from esplanade.footage import painting
from esplanade.footage.camera import Camera
from esplanade.footage.figure import Part
from esplanade.footage.film import FilmedFootprint
from esplanade.footage.painting import Canvas
from esplanade.planning import Polygon, Scene

ABOVE = Camera((0.0, 0.0, 0.0), -90.0, 90.0, 50.0, (100, 100))
SIDE = Camera((0.0, 0.0, 0.5), -90.0, 0.0, 50.0, (100, 100))


def colour_at(canvas: Canvas, x: int, y: int) -> tuple[int, ...]:
    return canvas.picture().getpixel((x, y))


def test_ground_fills_its_bounds_and_no_more():
    canvas = Canvas(ABOVE)
    canvas.paint_scene(Scene(bounds=(-0.75, -0.75, 0.75, 0.75)))
    assert colour_at(canvas, 42, 42) == ImageColor.getrgb(painting.GROUND)
    assert colour_at(canvas, 4, 4) == ImageColor.getrgb(painting.SKY)


def test_solids_show_their_tops_from_above_and_their_sides_from_aside():
    box = Polygon(points=((-0.4, -0.4), (0.4, -0.4), (0.4, 0.4), (-0.4, 0.4)), height_m=0.5)
    scene = Scene(bounds=(-3.0, -3.0, 3.0, 3.0), polygons=(box,))
    above, aside = Canvas(ABOVE), Canvas(SIDE)
    above.paint_scene(scene)
    aside.paint_scene(scene)
    assert colour_at(above, 50, 50) == ImageColor.getrgb(painting.TREAD)
    assert colour_at(aside, 50, 65) == ImageColor.getrgb(painting.SIDE)
    assert colour_at(aside, 50, 40) == ImageColor.getrgb(painting.SKY)


@pytest.mark.parametrize("right", [False, True])
def test_footprints_reach_from_heel_to_toe_in_the_colour_of_their_side(right: bool):
    canvas = Canvas(ABOVE)
    canvas.paint_footprint(FilmedFootprint(np.array([0.0, 0.0, 0.0, 0.0]), right, 0.0), leg_m=4.0)
    expected = ImageColor.getrgb(painting.FOOTPRINTS[right])
    # Shrinking overshoots a little beside edges.
    assert colour_at(canvas, 70, 50) == pytest.approx(expected, abs=15)
    assert colour_at(canvas, 45, 50) == ImageColor.getrgb(painting.SKY)


def test_nearer_parts_hide_farther_ones():
    far = Part(np.array([[0.0, 1.0, 0.5]]), np.array([0.3]), "#0000ff")
    near = Part(np.array([[0.0, -1.0, 0.5]]), np.array([0.3]), "#ff0000")
    for order in ((far, near), (near, far)):
        canvas = Canvas(SIDE)
        canvas.paint_body(order)
        red, _, blue = colour_at(canvas, 58, 56)
        assert red > 200
        assert blue < 80
