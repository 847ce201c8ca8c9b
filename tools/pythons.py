"""Run an installed wheel on every Python that this machine has: `python -m tools.pythons`.

The wheel is built once, by way of the source archive. Each environment is empty at first, the
working folder has nothing of the clone. Then other people's packages whose names are folders of
ours come beside it, and the working folder gets a `server` and a `planning` of its own.
"""

import shutil
import sys
import tempfile
import tomllib
from pathlib import Path
from typing import Final

from tools.environments import (
    ROOT,
    StepError,
    build_wheel,
    install,
    interpreters,
    make_environment,
    run,
)

FEWEST: Final = 3
STRANGERS: Final = ("protocol", "actors", "planning")
"""These names are other people's on PyPI."""
TRAP: Final = "raise ImportError(\"this is another program's module, and not Esplanade's\")\n"


def main() -> int:
    """Check all Pythons; exit code 1 where one fails or fewer than three are there."""
    found = interpreters()
    absent = [version for version in declared_versions() if version not in found]
    print(f"Pythons here: {', '.join(found)}. Absent: {', '.join(absent) or 'none'}.")
    if len(found) < FEWEST:
        print(f"At least {FEWEST} Pythons are needed.", file=sys.stderr)
        return 1
    failed = []
    with tempfile.TemporaryDirectory(prefix="esplanade-pythons-") as name:
        folder = Path(name)
        wheel = build_wheel(folder)
        for version, python in found.items():
            print(f"\n--- Python {version}", flush=True)
            try:
                check(folder / version, python, wheel)
            except StepError as error:
                print(error, file=sys.stderr)
                failed.append(version)
    passed = [version for version in found if version not in failed]
    print(f"\nThe wheel works on {', '.join(passed) or 'no Python'}.")
    if absent:
        print(f"It was not tried on {', '.join(absent)}, which this machine does not have.")
    if failed:
        print(f"It fails on {', '.join(failed)}.", file=sys.stderr)
    return 1 if failed else 0


def declared_versions() -> list[str]:
    """The versions that pyproject.toml names in its classifiers."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    prefix = "Programming Language :: Python :: 3."
    return [line.rpartition(" ")[2] for line in project["classifiers"] if line.startswith(prefix)]


def check(folder: Path, interpreter: Path, wheel: Path) -> None:
    """Check the wheel by itself, then among the strangers; StepError where it fails."""
    python = make_environment(folder / "environment", interpreter)
    install(python, wheel)
    work, script = folder / "work", folder / "installed_check.py"
    work.mkdir()
    shutil.copy(ROOT / "tools" / "installed_check.py", script)
    command = (python, script, ROOT / "docs" / "planning.md")
    run(command, cwd=work)

    print(f"Beside {', '.join(STRANGERS)} from PyPI, where a server and a planning lie:")
    install(python, *STRANGERS)
    (work / "server").mkdir()
    for trap in (work / "server" / "__init__.py", work / "planning.py"):
        trap.write_text(TRAP, encoding="utf-8")
    run(command, cwd=work)


if __name__ == "__main__":
    sys.exit(main())
