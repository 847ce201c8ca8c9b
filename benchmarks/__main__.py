"""Measure what must stay fast: `python -m benchmarks [NAME] [options]`, with a name of `NAMES`.

Without a name all of them run, one after the other, each as quick as it is by default.
"""

import runpy
import sys

NAMES = ("planning", "layered", "meshes", "server", "social", "walking", "steps", "gallery")


def main() -> None:
    named = [name for name in sys.argv[1:2] if name in NAMES]
    for name in named or NAMES:
        print(f"--- {name}", flush=True)
        sys.argv = [f"benchmarks {name}", *sys.argv[1 + len(named) :]]
        runpy.run_module(f"benchmarks.{name}", run_name="__main__")


if __name__ == "__main__":
    main()
