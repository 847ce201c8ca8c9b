"""Interpreters of this machine, empty environments made of them, and commands run in those."""

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Final

ROOT: Final = Path(__file__).resolve().parents[1]
UV: Final = Path(sys.executable).with_name("uv")
OLDEST_MINOR: Final = 11
NEWEST_MINOR: Final = 20
"""Python releases up to this one are looked for; those that do not exist yet are not found."""


class StepError(Exception):
    """A command failed; its output is shown already."""


def interpreters() -> dict[str, Path]:
    """The Pythons that run here, by version ("3.12"), the oldest first."""
    found: dict[str, Path] = {}
    for minor in range(OLDEST_MINOR, NEWEST_MINOR + 1):
        version = f"3.{minor}"
        path = next((path for path in _candidates(version) if _version_of(path) == version), None)
        if path is not None:
            found[version] = path
    return found


def _candidates(version: str) -> Iterator[Path]:
    """Places where a Python of this version may be; a shim of pyenv need not run."""
    if sys.version_info[:2] == tuple(map(int, version.split("."))):
        yield Path(sys.executable)
    on_path = shutil.which(f"python{version}")
    if on_path:
        yield Path(on_path)
    yield from sorted(Path.home().glob(f".pyenv/versions/{version}.*/bin/python"))
    managed = subprocess.run(
        [UV, "python", "find", "--managed-python", "--no-python-downloads", version],
        check=False,
        capture_output=True,
        text=True,
    ).stdout.strip()
    if managed:
        yield Path(managed)


def _version_of(python: Path) -> str | None:
    """The interpreter's version, or None where it does not run."""
    program = "import sys; print('%d.%d' % sys.version_info[:2])"
    try:
        done = subprocess.run(
            [python, "-c", program], check=False, capture_output=True, text=True, timeout=30
        )
    except (OSError, subprocess.TimeoutExpired):
        return None
    return done.stdout.strip() or None


def make_environment(folder: Path, python: Path) -> Path:
    """Make an empty environment with this interpreter; returns the environment's own."""
    run([UV, "venv", "--quiet", "--clear", "--no-project", "--python", python, folder])
    return folder / ("Scripts" if os.name == "nt" else "bin") / "python"


def install(python: Path, *requirements: str | Path) -> None:
    """Install into an environment, by its interpreter."""
    run([UV, "pip", "install", "--quiet", "--python", python, *requirements], cwd=python.parent)


def build_wheel(folder: Path) -> Path:
    """Build the source archive, and the wheel from what is in that; returns the wheel."""
    run([UV, "build", "--quiet", "--out-dir", folder, ROOT], cwd=folder)
    (wheel,) = folder.glob("*.whl")
    return wheel


def run(
    command: Sequence[str | Path],
    *,
    cwd: Path | None = None,
    environment: Mapping[str, str] | None = None,
) -> None:
    """Run a command and show what it says; StepError where it fails."""
    line = " ".join(map(str, command))
    print(f"$ {line}", flush=True)
    begun = time.monotonic()
    # The environment that the calling shell has active must not leak into another one.
    hidden = {"PYTHONPATH", "PYTHONHOME", "VIRTUAL_ENV", "UV_PROJECT_ENVIRONMENT"}
    variables = {name: value for name, value in os.environ.items() if name not in hidden}
    status = subprocess.run(
        command, cwd=cwd, env={**variables, **(environment or {})}, check=False
    ).returncode
    if status != 0:
        raise StepError(f"`{line}` ended with status {status}")
    print(f"  {time.monotonic() - begun:.0f} s", flush=True)
