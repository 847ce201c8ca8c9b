"""Strips, trails and films are written, in the sizes they should have."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image

from esplanade.actors.locomotion.reference.posing import Pose
from esplanade.footage.film import Film
from esplanade.footage.strips import PANELS, draw_film, draw_strip, draw_trail
from tests.footage.films import filmed


def beginning(frames: int) -> Film:
    film = filmed("stairs")
    poses = Pose._make(values[:frames] for values in film.poses)
    return replace(film, times_s=film.times_s[:frames], poses=poses)


def test_strips_have_a_row_for_every_span(tmp_path: Path):
    film = filmed("stairs")
    draw_strip(film, tmp_path / "strip.png")
    with Image.open(tmp_path / "strip.png") as strip:
        assert strip.width % PANELS == 0
        assert strip.height % len(film.walk.spans_s) == 0
        colours = strip.convert("RGB").getcolors(1 << 20)
    assert colours is not None
    assert len(colours) > 20


def test_panels_of_a_strip_differ(tmp_path: Path):
    draw_strip(filmed("flat"), tmp_path / "strip.png")
    with Image.open(tmp_path / "strip.png") as strip:
        pixels = np.asarray(strip.convert("RGB"), dtype=int)
    width = pixels.shape[1] // PANELS
    first, second = pixels[:, :width], pixels[:, width : 2 * width]
    assert np.mean(np.abs(first - second).max(axis=2) > 40) > 0.01


def test_trails_hold_the_whole_way(tmp_path: Path):
    draw_trail(filmed("flat"), tmp_path / "trail.png")
    with Image.open(tmp_path / "trail.png") as trail:
        assert trail.width > 2 * trail.height
        assert trail.width <= 1500


def test_films_have_all_frames_and_tell_of_each(tmp_path: Path):
    told = []
    draw_film(beginning(12), tmp_path / "film.gif", lambda: told.append(1))
    assert len(told) == 12
    with Image.open(tmp_path / "film.gif") as film:
        assert film.n_frames > 1
        shown_ms = 0
        for frame in range(film.n_frames):
            film.seek(frame)
            shown_ms += film.info["duration"]
    assert shown_ms == 12 * 50


def test_strips_and_trails_are_shapes_where_papers_want_them(tmp_path: Path):
    film = filmed("flat")
    draw_strip(film, tmp_path / "strip.svg")
    text = (tmp_path / "strip.svg").read_text()
    assert "<image" not in text
    assert text.count("<path") > 200
    for name in ("one.svg", "two.svg", "trail.pdf"):
        draw_trail(film, tmp_path / name)
    assert (tmp_path / "one.svg").read_bytes() == (tmp_path / "two.svg").read_bytes()
    assert (tmp_path / "trail.pdf").read_bytes().startswith(b"%PDF")
