"""Draw worlds of files of others, each of which one command opens, for docs/files.md.

python tools/draw_crowds.py         recordings in six forms, and three plans, each in a browser
"""

import tempfile
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

from PIL import Image, ImageDraw

IMAGES = Path(__file__).resolve().parents[1] / "docs" / "images"
TILE = (640, 360)
CAPTION_HEIGHT = 26
COLUMNS = 2
COLOURS = 192
AMID_S = 4.5
"""The ground of recorded people is entered at its edge: walking so long leads amid them."""


def sheet(tiles: Sequence[tuple[str, Path]], picture: Path) -> None:
    """Lay pictures beside each other, with the command below each."""
    width, height = TILE[0], TILE[1] + CAPTION_HEIGHT
    rows = -(-len(tiles) // COLUMNS)
    whole = Image.new("RGB", (COLUMNS * width, rows * height), "white")
    draw = ImageDraw.Draw(whole)
    for number, (caption, file) in enumerate(tiles):
        x, y = number % COLUMNS * width, number // COLUMNS * height
        with Image.open(file) as shot:
            whole.paste(shot.convert("RGB").resize(TILE, Image.Resampling.LANCZOS), (x, y))
        draw.text((x + 8, y + TILE[1] + 5), caption, fill="black", font_size=14)
    whole.quantize(COLOURS).save(picture, optimize=True)


def photographed(
    commands: Sequence[tuple[str, Sequence[str], int]], folder: Path, south_s: float = 0.0
) -> Any:
    """Run each demo, and keep its picture; returns captions and pictures."""
    demo_pictures: Any = import_module("demo_pictures")  # beside this file
    tiles = []
    for number, (caption, words, people) in enumerate(commands):
        file = folder / f"{number}-{words[1].rpartition('/')[2]}.png"
        demo_pictures.photograph(words, file, people, south_s)
        tiles.append((caption, file))
    return tiles


def crowds(folder: Path) -> list[tuple[str, Sequence[str], int]]:
    """The commands for recordings: caption, words, and how many have to be about."""
    samples: Any = import_module("sample_crowds")
    square, passage = samples.walk(folder), samples.passage(folder)
    made = (
        (samples.obsmat(folder / "obsmat.txt", square), ()),
        (samples.four_columns(folder / "biwi.txt", square), ()),
        (samples.trajnet(folder / "scene.ndjson", square), ()),
        (samples.splines(folder / "students.vsp", square), ("--scale", f"{samples.PIXEL_M}")),
        (samples.juelich(folder / "corridor.txt", passage), ()),
        (samples.jupedsim(folder / "trajectory.sqlite"), ()),
    )
    return [
        (" ".join(["esplanade demo --crowd", path.name, *given]),
         ["--crowd", str(path), *given, "--actors=6"], 16)
        for path, given in made
    ]  # fmt: skip


def plans(folder: Path) -> list[tuple[str, Sequence[str], int]]:
    """The commands for plans."""
    samples: Any = import_module("sample_plans")
    made = (samples.office(folder / "office.dxf"), samples.hall(folder / "lab.yaml"))
    return [
        (f"esplanade demo --scene {path.name}",
         ["--scene", str(path), "--actors=16", "--visitors=10"], 20)
        for path in made
    ]  # fmt: skip


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        sheet(photographed(crowds(folder), folder, AMID_S), IMAGES / "import-crowds.png")
        sheet(photographed(plans(folder), folder), IMAGES / "import-plans.png")
