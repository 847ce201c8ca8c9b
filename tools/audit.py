"""Ask for known faults of every release that uv.lock names: `python -m tools.audit`.

The answer comes from a service on the internet (OSV). Where that cannot be reached there is no
audit, and this fails, unless ESPLANADE_SKIP_AUDIT=1 says that the release goes on without one.
"""

import os
import subprocess
import sys
from typing import Final

from tools.environments import ROOT, UV

SKIP_VARIABLE: Final = "ESPLANADE_SKIP_AUDIT"
COMMAND: Final = ("audit", "--locked", "--preview-features", "audit-command")
FAULTS_FOUND: Final = 1
"""The exit status of `uv audit` that means faults; any other but 0 means that it could not ask."""


def main() -> int:
    """Audit, and say plainly which of the three it was: clean, faulty, or not audited."""
    if os.environ.get(SKIP_VARIABLE) == "1":
        print(f"NOT AUDITED: {SKIP_VARIABLE}=1 skips the question for known faults.")
        return 0
    status = subprocess.run([UV, *COMMAND], cwd=ROOT, check=False).returncode
    if status == FAULTS_FOUND:
        print("The lock file names releases with known faults: see above.", file=sys.stderr)
    elif status != 0:
        print(
            "NOT AUDITED: the service that knows the faults could not be asked; see above.\n"
            f"To go on without an audit, set {SKIP_VARIABLE}=1.",
            file=sys.stderr,
        )
    return 0 if status == 0 else 1


if __name__ == "__main__":
    sys.exit(main())
