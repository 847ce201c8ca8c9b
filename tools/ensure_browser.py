"""Print the path of a chromium for the browser tests; where there is none, install one.

It tries, in this order: the one that ESPLANADE_CHROMIUM names, the machine's own, playwright's
download, the system's package manager where we may use it. Attempts are told on stderr, the path
goes to stdout.
"""

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

VARIABLE = "ESPLANADE_CHROMIUM"
NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
MAC_PATHS = (
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "/Applications/Chromium.app/Contents/MacOS/Chromium",
)
PACKAGE_MANAGERS = {
    "apt-get": (("update", "-qq"), ("install", "-y", "-qq", "--no-install-recommends", "chromium")),
    "dnf": (("install", "-y", "-q", "chromium"),),
    "apk": (("add", "-q", "chromium"),),
    "pacman": (("-Sy", "--noconfirm", "chromium"),),
}
PLAYWRIGHT_PATH = (
    "from playwright.sync_api import sync_playwright\n"
    "with sync_playwright() as p: print(p.chromium.executable_path)"
)
DOWNLOAD_LIMIT_S = 600.0


def main() -> int:
    """Print the first browser that runs; exit code 1 where none can be had."""
    named = os.environ.get(VARIABLE)
    if named:
        return _done(named) if _runs(named) else _fail(f"{VARIABLE}={named} does not run.")
    for path in _candidates():
        if path and _runs(path):
            return _done(path)
    return _fail(
        "No chromium: there is none on this machine, playwright could download none, and no\n"
        f"package manager may install one. Install chromium, or name one with {VARIABLE}."
    )


def _candidates() -> Iterator[str | None]:
    """Ways to a browser, each tried only when those before it gave none that runs."""
    yield from map(shutil.which, NAMES)
    yield from MAC_PATHS
    yield _playwright_path()
    _say("No chromium or chrome on this machine: trying playwright's download ...")
    if _run(sys.executable, "-m", "playwright", "install", "chromium"):
        yield _playwright_path()
    if _install_by_system():
        yield from map(shutil.which, NAMES)


def _playwright_path() -> str | None:
    """The path at which playwright keeps its own browser, downloaded or not."""
    done = subprocess.run(
        [sys.executable, "-c", PLAYWRIGHT_PATH], check=False, capture_output=True, text=True
    )
    return done.stdout.strip() or None


def _install_by_system() -> bool:
    """Install chromium by the system's package manager, as root or by a sudo that asks nothing."""
    manager = next(filter(shutil.which, PACKAGE_MANAGERS), None)
    if manager is None or not hasattr(os, "geteuid"):
        return False
    prefix = () if os.geteuid() == 0 else ("sudo", "-n")
    _say(f"No download either: trying {' '.join((*prefix, manager))} ...")
    results = [_run(*prefix, manager, *arguments) for arguments in PACKAGE_MANAGERS[manager]]
    return results[-1]


def _runs(path: str) -> bool:
    """Whether this is a browser that starts here, with all the libraries it wants."""
    return _run(path, "--version", quiet=True)


def _run(*command: str, quiet: bool = False) -> bool:
    """Whether the command ended well; what it says goes to stderr, away from our answer."""
    said = subprocess.DEVNULL if quiet else sys.stderr
    try:
        done = subprocess.run(
            command,
            check=False,
            stdin=subprocess.DEVNULL,
            stdout=said,
            stderr=said,
            timeout=DOWNLOAD_LIMIT_S,
        )
    except (OSError, subprocess.TimeoutExpired):
        return False
    return done.returncode == 0


def _done(path: str) -> int:
    print(Path(path))
    return 0


def _fail(message: str) -> int:
    _say(message)
    return 1


def _say(message: str) -> None:
    print(message, file=sys.stderr)


if __name__ == "__main__":
    sys.exit(main())
