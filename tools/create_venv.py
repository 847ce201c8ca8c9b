"""Make the project's virtual environment whatever this Python lacks: `create_venv.py FOLDER`.

It runs before anything is installed, perhaps on an old Python: standard library only.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

OLDEST = (3, 11)
NEWER_NAMES = ("python3.14", "python3.13", "python3.12", "python3.11")


def main(folder: str) -> int:
    """Try the ways there are, the plainest first; say what to install when none works."""
    python = _find_python()
    if python is None:
        wanted, found = ".".join(map(str, OLDEST)), ".".join(map(str, sys.version_info[:2]))
        return _fail(f"Esplanade needs Python {wanted} or newer, and found only {found}.")
    if _create(python, "venv", folder) or _create(python, "virtualenv", folder):
        return 0
    if _install_venv(python) and _create(python, "venv", folder):
        return 0
    return _fail(
        f"{python} can make no virtual environment: neither `venv` nor `virtualenv` works.\n"
        "Install one of them, for example by `apt-get install python3-venv`, and try again."
    )


def _find_python() -> str | None:
    """This interpreter where it is new enough, else a newer one on the path."""
    if sys.version_info >= OLDEST:
        return sys.executable
    return next(filter(None, map(shutil.which, NEWER_NAMES)), None)


def _create(python: str, module: str, folder: str) -> bool:
    """Make the environment; Debian's bare `venv` makes one without pip, which does not count."""
    scripts = Path(folder, "Scripts" if os.name == "nt" else "bin")
    return _run(python, "-m", module, "--clear", folder) and _run(
        str(scripts / "python"), "-m", "pip", "--version"
    )


def _install_venv(python: str) -> bool:
    """Install Debian's package of `venv`: root's right, and only where there is apt-get."""
    if not hasattr(os, "geteuid") or os.geteuid() != 0 or not shutil.which("apt-get"):
        return False
    print("Installing python3-venv by apt-get ...", file=sys.stderr)
    _run("apt-get", "update")
    packages = ("python3-venv", f"{Path(python).name}-venv")
    installed = [_run("apt-get", "install", "-y", package) for package in packages]
    return any(installed)


def _run(*command: str) -> bool:
    """Whether the command ended well; it is kept quiet, for failing only means the next way."""
    silent = subprocess.DEVNULL
    try:
        done = subprocess.run(command, check=False, stdin=silent, stdout=silent, stderr=silent)
    except OSError:
        return False
    return done.returncode == 0


def _fail(message: str) -> int:
    print(message, file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
