"""Run tests with the oldest releases that pyproject.toml allows: `python -m tools.lowest`.

The environment is made on the oldest Python there is.
"""

import sys
import tempfile
from pathlib import Path
from typing import Final, NamedTuple

from tools.environments import ROOT, UV, StepError, install, interpreters, make_environment, run


class Group(NamedTuple):
    """Tests for one resolution: an extra may itself ask for newer releases than the others."""

    extras: tuple[str, ...]
    tests: tuple[str, ...]


GROUPS: Final = (
    Group(
        ("gait", "scene", "test"),
        (
            "tests/bots",
            "tests/commandline",
            "tests/esplanade",
            "tests/footage",
            "tests/planning/people",
            "tests/planning/routes",
            "tests/protocol",
            "tests/recordings",
            "tests/scenery",
            "tests/server",
            "tests/test_packaging.py",
        ),
    ),
    Group(("evaluate", "test"), ("tests/evaluation/policies", "tests/evaluation/test_plotting.py")),
)
"""Every dependency is used by some of these; where only kernels are long to compile is left out."""

VIEWER_OF_JUPEDSIM: Final = ("pyside6", "vtk")
"""It takes a gigabyte, and no import of ours reaches it."""


def main() -> int:
    """Test all groups; exit code 1 where one fails."""
    version, python = next(iter(interpreters().items()))
    print(f"The oldest Python here is {version}.", flush=True)
    failed = False
    for group in GROUPS:
        with tempfile.TemporaryDirectory(prefix="esplanade-lowest-") as folder:
            try:
                check(Path(folder), version, python, group)
            except StepError as error:
                print(error, file=sys.stderr)
                failed = True
    return 1 if failed else 0


def check(folder: Path, version: str, interpreter: Path, group: Group) -> None:
    """Resolve, install and test; StepError where one of these fails."""
    wanted = folder / "requirements.txt"
    left_out = folder / "left-out.txt"
    never = "".join(f"{package}; python_version < '3'\n" for package in VIEWER_OF_JUPEDSIM)
    left_out.write_text(never, encoding="utf-8")
    resolve: list[str | Path] = [UV, "pip", "compile", ROOT / "pyproject.toml"]
    resolve += ["--resolution", "lowest-direct", "--python-version", version]
    resolve += ["--overrides", left_out, "--output-file", wanted]
    resolve += ["--quiet", "--no-header", "--no-annotate"]
    resolve += [part for extra in group.extras for part in ("--extra", extra)]
    run(resolve)
    print(wanted.read_text("utf-8"), flush=True)

    python = make_environment(folder / "environment", interpreter)
    install(python, "--requirements", wanted)
    install(python, "--no-deps", "--editable", ROOT)
    options = ("--quiet", "-p", "no:cacheprovider")
    run([python, "-m", "pytest", *options, *group.tests], cwd=ROOT)


if __name__ == "__main__":
    sys.exit(main())
