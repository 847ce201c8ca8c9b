"""Draw what becomes of a building and a plan, for docs/files.md.

python tools/draw_imports.py            plans of an IFC house and a DXF office
python tools/draw_imports.py --world    also the house in a browser, with people and actors
"""

import socket
import subprocess
import sys
import tempfile
import time
import urllib.request
from importlib import import_module
from pathlib import Path
from typing import Any
from urllib.error import URLError

from esplanade.cli import main

IMAGES = Path(__file__).resolve().parents[1] / "docs" / "images"
METRES_A_CM = "2"
FLAGS = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
READY_S = 300.0
WALK_S = 12.0


def draw_plan(source: Path, picture: Path) -> None:
    """Import a file as anybody would, and draw the plans of its storeys."""
    scene = source.with_suffix(".json")
    for words in (
        ["scene", "import", str(source), "--out", str(scene)],
        ["scene", "export", str(scene), "--metres-per-cm", METRES_A_CM, "--out", str(picture)],
    ):
        if main(words):
            raise SystemExit(f"esplanade {' '.join(words)}: failed")


def photograph(source: Path, picture: Path) -> None:
    """Run the demo on a file, and take a picture of what a visitor sees."""
    from playwright.sync_api import sync_playwright  # noqa: PLC0415 - it may not be installed

    port, private_port = (_free_port() for _ in range(2))
    ports = [f"--port={port}", f"--private-port={private_port}"]
    words = ["demo", "--scene", str(source), "--actors=10", "--visitors=5", *ports]
    demo = subprocess.Popen([sys.executable, "-m", "esplanade", *words])
    try:
        _wait_for(f"http://127.0.0.1:{private_port}/readyz")
        with sync_playwright() as playwright:
            path = _chromium(playwright.chromium.executable_path)
            browser = playwright.chromium.launch(executable_path=path, args=[*FLAGS])
            page = browser.new_page(viewport={"width": 1280, "height": 720})
            page.set_default_timeout(1e3 * READY_S)
            page.goto(f"http://localhost:{port}")
            page.fill("#join-name", "Ada")
            page.click("#join-button")
            time.sleep(WALK_S)
            page.screenshot(path=picture)
            browser.close()
    finally:
        demo.terminate()
        demo.wait()


def _chromium(usual: str) -> str:
    return usual if Path(usual).exists() else "/usr/bin/chromium"


def _free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port: int = taken.getsockname()[1]
    return port


def _wait_for(url: str) -> None:
    until = time.monotonic() + READY_S
    while time.monotonic() < until:
        try:
            with urllib.request.urlopen(url, timeout=1.0):  # noqa: S310 - it is our own server
                return
        except (URLError, OSError):
            time.sleep(0.5)
    raise SystemExit("the world was not ready in time")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        sample_plans: Any = import_module("sample_plans")  # beside this file
        house = sample_plans.house(Path(folder) / "house.ifc")
        office = sample_plans.office(Path(folder) / "office.dxf")
        draw_plan(house, IMAGES / "import-house.png")
        draw_plan(office, IMAGES / "import-office.png")
        if "--world" in sys.argv:
            photograph(house, IMAGES / "import-world.png")
