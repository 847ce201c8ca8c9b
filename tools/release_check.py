"""All that a release has to pass and that takes too long for every change.

`python -m tools.release_check` runs each leg to its end, whatever the others came to.
"""

import subprocess
import sys
import time
from typing import Final

from tools.environments import ROOT

LEGS: Final = {
    "audit": "known faults of what uv.lock names",
    "lowest": "tests with the oldest releases that pyproject.toml allows",
    "pythons": "an installed wheel on every Python, alone and among strangers",
    "image": "the image, built and run in a root folder until it is healthy",
}


def main() -> int:
    """Run all legs and print a table of them; exit code 1 where any has failed."""
    table = []
    passed = True
    for leg, what in LEGS.items():
        print(f"\n=== {leg}: {what}", flush=True)
        begun = time.monotonic()
        status = subprocess.run(
            [sys.executable, "-m", f"tools.{leg}"], cwd=ROOT, check=False
        ).returncode
        passed = passed and status == 0
        verdict = "passed" if status == 0 else "FAILED"
        table.append(f"{verdict}  {time.monotonic() - begun:5.0f} s  {leg}: {what}")
    print("\n=== Result", *table, sep="\n")
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
