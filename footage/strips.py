"""Strips, trails and GIFs of a walk that was filmed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final

import numpy as np
from PIL import Image

from esplanade.footage.camera import Camera
from esplanade.footage.figure import parts_of
from esplanade.footage.film import Film
from esplanade.footage.painting import SKY, Canvas
from esplanade.footage.vector import Panel, write_shapes
from esplanade.planning.compiled.arrays import Floats

PANELS: Final = 9
"""Number of pictures in a row of a strip."""

_PANEL: Final = (170, 270)
_PANEL_SCALE: Final = 124.0
_FILM: Final = (340, 290)
_FILM_SCALE: Final = 122.0
_COLOURS: Final = 96
_METHOD: Final = Image.Quantize.MAXCOVERAGE
"""With this method footprints, which are small, keep their colours."""
_TRAIL_WIDTH: Final = 1500
_TRAIL_MARGIN: Final = 70
_TRAIL_SCALE: Final = 170.0
_APART_M: Final = 0.62
"""Distance between the bodies of a trail."""
_FOLLOWED_S: Final = 0.8
"""The camera follows the mean place of the body over this time."""
_SHADOW_M: Final = 0.19


def draw_strip(film: Film, path: Path) -> None:
    """Write pictures at even times, a row for each span of the walk; the camera goes along."""
    followed = _followed(film)
    spans = film.walk.spans_s
    size = _PANEL[0] * PANELS, _PANEL[1] * len(spans)
    panels = []
    for row, span in enumerate(spans):
        for column, seconds in enumerate(np.linspace(*span, PANELS).tolist()):
            frame = int(np.argmin(np.abs(film.times_s - seconds)))
            canvas = _frame(film, frame, followed[frame], _PANEL, _PANEL_SCALE)
            canvas.write(f"{film.times_s[frame]:.2f} s", (9, _PANEL[1] - 22), 12)
            panels.append(((column * _PANEL[0], row * _PANEL[1]), canvas))
    _save(path, size, panels)


def draw_trail(film: Film, path: Path) -> None:
    """Write the whole path in one picture: the body where it was, and all footprints."""
    walk, poses = film.walk, film.poses
    frames = _spread_out(film)
    points = np.concatenate([poses.head[frames], poses.toes[frames].reshape(-1, 3)])
    probe = Camera((0.0, 0.0, 0.0), *walk.view, 1.0, (0, 0))
    seen = probe.seen(points)
    low, high = seen.min(axis=0), seen.max(axis=0)
    scale = min(_TRAIL_SCALE, (_TRAIL_WIDTH - 2 * _TRAIL_MARGIN) / float(high[0] - low[0]))
    width, height = (round(float(span) * scale) + 2 * _TRAIL_MARGIN for span in (high - low)[:2])
    x, y, z = (0.5 * (low + high) @ probe.axes).tolist()
    camera = Camera((x, y, z), *walk.view, scale, (width, height))
    canvas = Canvas(camera)
    canvas.paint_scene(walk.scene)
    for footprint in film.footprints:
        canvas.paint_footprint(footprint, float(film.sizes.leg_m[0]))
    for frame in frames:
        _paint_shadow(canvas, film, frame)
    nearness = poses.root[frames] @ camera.axes[2]
    for k in np.argsort(nearness, kind="stable").tolist():
        canvas.paint_body(parts_of(poses, frames[k]))
    canvas.write(walk.caption, (14, 10), 16)
    _save(path, canvas.size, [((0, 0), canvas)])


def draw_film(film: Film, path: Path, advance: Callable[[], None]) -> None:
    """Write a GIF of all frames; `advance` is called after each of them."""
    followed = _followed(film)
    pictures = []
    for frame, seconds in enumerate(film.times_s.tolist()):
        canvas = _frame(film, frame, followed[frame], _FILM, _FILM_SCALE)
        canvas.write(film.walk.caption, (12, 8), 14)
        canvas.write(f"{seconds:.2f} s", (12, _FILM[1] - 26), 14)
        pictures.append(canvas.picture())
        advance()
    # One palette for all frames: colours that change from frame to frame would flicker.
    palette = pictures[len(pictures) // 2].quantize(_COLOURS, _METHOD)
    indexed = [picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures]
    frame_s = float(film.times_s[1] - film.times_s[0])
    indexed[0].save(
        path,
        save_all=True,
        append_images=indexed[1:],
        duration=round(1000.0 * frame_s),
        loop=0,
        optimize=True,
    )


def _save(
    path: Path, size: tuple[int, int], panels: Sequence[tuple[tuple[int, int], Canvas]]
) -> None:
    """Write canvases at their corners: as shapes, or as a PNG of 256 colours.

    The loss cannot be seen, and files are a third as large.
    """
    if path.suffix != ".png":
        drawn = [Panel(corner, canvas.size, SKY, canvas.shapes) for corner, canvas in panels]
        write_shapes(path, size, drawn)
        return
    picture = Image.new("RGB", size)
    for corner, canvas in panels:
        picture.paste(canvas.picture(), corner)
    palette = picture.quantize(256, _METHOD)
    picture.quantize(palette=palette, dither=Image.Dither.NONE).save(path, optimize=True)


def _frame(film: Film, frame: int, target: Floats, size: tuple[int, int], scale: float) -> Canvas:
    """Paint one frame, the camera on a target (3,), metres."""
    walk = film.walk
    x, y, z = target.tolist()
    canvas = Canvas(Camera((x, y, z), *walk.view, scale, size))
    canvas.paint_scene(walk.scene)
    for footprint in film.footprints:
        if footprint.since_s <= film.times_s[frame]:
            canvas.paint_footprint(footprint, float(film.sizes.leg_m[0]))
    _paint_shadow(canvas, film, frame)
    canvas.paint_body(parts_of(film.poses, frame))
    return canvas


def _followed(film: Film) -> Floats:
    """Points (F, 3) that the camera looks at: bodies sway, but the camera must not."""
    root, times = film.poses.root, film.times_s
    half = max(1, round(0.5 * _FOLLOWED_S / float(times[1] - times[0])))
    padded = np.pad(root, ((half, half), (0, 0)), mode="edge")
    window = np.ones(2 * half + 1) / (2 * half + 1)
    return np.stack([np.convolve(axis, window, mode="valid") for axis in padded.T], axis=1)


def _paint_shadow(canvas: Canvas, film: Film, frame: int) -> None:
    """Paint a shadow below the hips, on level ground only."""
    if not film.walk.scene.solids():
        x, y, _ = film.poses.root[frame].tolist()
        canvas.paint_shadow(np.array([x, y, 0.0]), _SHADOW_M)


def _spread_out(film: Film) -> list[int]:
    """Frames between which the body has moved by an even distance, ends included."""
    root = film.poses.root
    travelled = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(root, axis=0), axis=1))))
    count = max(2, round(float(travelled[-1]) / _APART_M) + 1)
    frames = np.searchsorted(travelled, np.linspace(0.0, travelled[-1] - 1e-9, count))
    return sorted(set(map(int, frames)))
