"""Makes a release ready, up to its upload: `make release VERSION=0.2.0`.

It writes the version wherever one stands and the date over the changes, builds wheel, sdist and the
package for npm into dist/, and says what is left to do: to look, commit, tag and upload. What it
writes is not committed. It refuses a tree with changes, a version that is not newer, and a
changelog without anything new.
"""

import argparse
import re
import shutil
import subprocess
import sys
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Final

from tools.environments import ROOT

VERSION: Final = re.compile(r"(\d+)\.(\d+)\.(\d+)")
PLACES: Final = {
    "pyproject.toml": r'^version = "(.+?)"',
    "CITATION.cff": r"^version: (.+)",
    "client_web/package.json": r'^  "version": "(.+?)"',
    "client_web/codec/package.json": r'^  "version": "(.+?)"',
    "ros/package.xml": r"^  <version>(.+?)</version>",
    "ros/setup.py": r'^    version="(.+?)"',
}
"""The files in which the version stands, each once, and where. The locks follow from these."""
UNRELEASED: Final = "## [Unreleased]\n"


class ReleaseError(Exception):
    """A release cannot be made; the message says why."""


def main(argv: Sequence[str] | None = None) -> int:
    """Make a release ready; exit code 1 where it cannot be."""
    made = argparse.ArgumentParser(prog="python -m tools.release", description=__doc__)
    made.add_argument("version", help="of the release, such as 0.2.0")
    options = made.parse_args(argv)
    try:
        _refuse_changes(ROOT)
        write_version(ROOT, options.version, datetime.now(tz=UTC).date().isoformat())
        _lock(ROOT)
        built = _built(ROOT)
    except ReleaseError as error:
        print(f"release: {error}", file=sys.stderr)
        return 1
    told = "\n".join(f"  {path.relative_to(ROOT)}" for path in built)
    print(f"built\n{told}\n\n{to_do(options.version)}")
    return 0


def current_version(root: Path) -> str:
    """The version that all places have.

    Raises
    ------
    ReleaseError
        A place has none, or they differ.
    """
    found = {name: _stated(root / name, pattern) for name, pattern in PLACES.items()}
    if len(set(found.values())) > 1:
        told = ", ".join(f"{name}: {version}" for name, version in found.items())
        raise ReleaseError(f"versions differ: {told}")
    return found["pyproject.toml"]


def write_version(root: Path, version: str, date: str) -> None:
    """Write a new version to all places, and a heading with it and the date over the changes.

    Raises
    ------
    ReleaseError
        It is no version, is not newer, or nothing has changed. Nothing is written then.
    """
    before = current_version(root)
    if VERSION.fullmatch(version) is None:
        raise ReleaseError(f"{version!r} is no version such as 0.2.0")
    if _numbers(version) <= _numbers(before):
        raise ReleaseError(f"{version} is not newer than {before}")
    log = (root / "CHANGELOG.md").read_text(encoding="utf-8")
    _, found, changes = log.partition(UNRELEASED)
    if not found or not changes.split("\n## ", 1)[0].strip():
        raise ReleaseError("CHANGELOG.md has nothing below Unreleased")
    released = log.replace(UNRELEASED, f"{UNRELEASED}\n## [{version}] - {date}\n", 1)
    for name, pattern in PLACES.items():
        path = root / name
        text = path.read_text(encoding="utf-8")
        stated = re.search(pattern, text, re.MULTILINE)
        if stated is not None:
            path.write_text(text[: stated.start(1)] + version + text[stated.end(1) :])
    (root / "CHANGELOG.md").write_text(released, encoding="utf-8")


def to_do(version: str) -> str:
    """The steps that are left for a person."""
    return f"""left to do, once `make release-check` has passed and the change was looked at:
  git commit -am "Release {version}"
  git tag -a v{version} -m "Esplanade {version}"
  git push origin main v{version}
  .venv/bin/uv publish dist/esplanade-{version}*
  npm publish dist/esplanade-codec-{version}.tgz"""


def _numbers(version: str) -> tuple[int, ...]:
    return tuple(map(int, version.split(".")))


def _stated(path: Path, pattern: str) -> str:
    found = re.search(pattern, path.read_text(encoding="utf-8"), re.MULTILINE)
    if found is None or VERSION.fullmatch(found[1]) is None:
        raise ReleaseError(f"{path.name} states no version")
    return found[1]


def _refuse_changes(root: Path) -> None:
    if _run(["git", "status", "--porcelain"], root):
        raise ReleaseError("there are changes that are not committed")


def _lock(root: Path) -> None:
    """Let the locks state the new version, and nothing else."""
    _run([str(root / ".venv" / "bin" / "uv"), "lock", "--quiet"], root)
    _npm(root, "install", "--package-lock-only", "--ignore-scripts", "--silent")


def _built(root: Path) -> list[Path]:
    """Wheel, sdist and the package for npm, made anew in dist/."""
    folder = root / "dist"
    shutil.rmtree(folder, ignore_errors=True)
    _run([str(root / ".venv" / "bin" / "uv"), "build", "--quiet", "--out-dir", str(folder)], root)
    _npm(root, "run", "--silent", "build:codec")
    codec = root / "client_web" / "codec"
    _npm(root, "pack", "--silent", str(codec), "--pack-destination", str(folder))
    return sorted(path for path in folder.iterdir() if path.suffix in (".whl", ".gz", ".tgz"))


def _npm(root: Path, *words: str) -> None:
    _run([sys.executable, str(root / "tools" / "npm.py"), *words], root)


def _run(command: Sequence[str], root: Path) -> str:
    done = subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise ReleaseError(f"{' '.join(command[:3])} failed: {done.stderr.strip()[-500:]}")
    return done.stdout.strip()


if __name__ == "__main__":
    raise SystemExit(main())
