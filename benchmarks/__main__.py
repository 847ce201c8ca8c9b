"""Runs one benchmark, or all of them: `python -m benchmarks [NAME] [options]`.

The names are those in `NAMES`. Without a name all benchmarks run one after the other, with their
default options.
"""

import runpy
import sys

NAMES = (
    "planning",
    "layered",
    "meshes",
    "turned",
    "server",
    "live",
    "crowds",
    "social",
    "doorways",
    "walking",
    "steps",
    "gallery",
    "audit",
    "consoles",
    "shift",
)


def main() -> None:
    named = [name for name in sys.argv[1:2] if name in NAMES]
    for name in named or NAMES:
        print(f"--- {name}", flush=True)
        sys.argv = [f"benchmarks {name}", *sys.argv[1 + len(named) :]]
        runpy.run_module(f"benchmarks.{name}", run_name="__main__")


if __name__ == "__main__":
    main()
