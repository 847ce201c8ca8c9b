"""Draw what becomes of a building and a plan, for docs/files.md.

python tools/draw_imports.py            plans of an IFC house and a DXF office
python tools/draw_imports.py --world    also the house in a browser, with people and actors
"""

import sys
import tempfile
from importlib import import_module
from pathlib import Path
from typing import Any

from esplanade.cli import main

IMAGES = Path(__file__).resolve().parents[1] / "docs" / "images"
METRES_A_CM = "2"


def draw_plan(source: Path, picture: Path) -> None:
    """Import a file as anybody would, and draw the plans of its storeys."""
    scene = source.with_suffix(".json")
    for words in (
        ["scene", "import", str(source), "--out", str(scene)],
        ["scene", "export", str(scene), "--metres-per-cm", METRES_A_CM, "--out", str(picture)],
    ):
        if main(words):
            raise SystemExit(f"esplanade {' '.join(words)}: failed")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        sample_plans: Any = import_module("sample_plans")  # beside this file
        house = sample_plans.house(Path(folder) / "house.ifc")
        office = sample_plans.office(Path(folder) / "office.dxf")
        draw_plan(house, IMAGES / "import-house.png")
        draw_plan(office, IMAGES / "import-office.png")
        if "--world" in sys.argv:
            demo_pictures: Any = import_module("demo_pictures")
            words = ["--scene", str(house), "--actors=10", "--visitors=5"]
            demo_pictures.photograph(words, IMAGES / "import-world.png")
