"""Pictures of the demo in a browser: what a visitor sees some seconds after coming in."""

import socket
import subprocess
import sys
import time
import urllib.request
from collections.abc import Sequence
from pathlib import Path
from urllib.error import URLError

FLAGS = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
READY_S = 300.0
WALK_S = 12.0


def photograph(words: Sequence[str], picture: Path, people: int = 0, south_s: float = 0.0) -> None:
    """Run `esplanade demo` with these words, and take a picture of what a visitor sees.

    It is taken once so many people and actors are about, and the visitor has walked to the south
    for so many seconds.
    """
    from playwright.sync_api import sync_playwright  # noqa: PLC0415 - it may not be installed

    port, private_port = (_free_port() for _ in range(2))
    ports = [f"--port={port}", f"--private-port={private_port}"]
    demo = subprocess.Popen([sys.executable, "-m", "esplanade", "demo", *words, *ports])
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
            page.wait_for_function(
                "n => Number(document.querySelector('#people-count').textContent) >= n",
                arg=people,
            )
            if south_s:
                page.keyboard.down("s")
                time.sleep(south_s)
                page.keyboard.up("s")
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
