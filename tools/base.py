"""Run an installed wheel without any extra through every reader and command: `-m tools.base`.

The wheel is built once into an empty environment. Then `base_check.py` runs there, in a folder
that has nothing of the clone, with kernels uncompiled: it is about what is installed.
"""

import os
import shutil
import sys
import tempfile
from pathlib import Path

from tools.environments import ROOT, StepError, build_wheel, install, make_environment, run


def main() -> int:
    """Check a base install; exit code 1 where it fails."""
    # Serving has tests of its own, and takes longest to build.
    os.environ["ESPLANADE_SKIP_CLIENT"] = "1"
    with tempfile.TemporaryDirectory(prefix="esplanade-base-") as name:
        folder = Path(name)
        try:
            wheel = build_wheel(folder)
            python = make_environment(folder / "environment", Path(sys.executable))
            install(python, wheel)
            work = folder / "work"
            work.mkdir()
            script = folder / "base_check.py"
            shutil.copy(ROOT / "tools" / "base_check.py", script)
            scene = ROOT / "scenes" / "plaza.json"
            run((python, script, scene), cwd=work, environment={"NUMBA_DISABLE_JIT": "1"})
        except StepError as error:
            print(error, file=sys.stderr)
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
