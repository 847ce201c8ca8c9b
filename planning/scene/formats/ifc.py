"""Buildings in IFC by IfcOpenShell (extra `ifc`): triangles of all that stands, doors left open."""

from __future__ import annotations

import json
import subprocess
import sys
from collections import Counter
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

import numpy as np

from esplanade.planning.scene.formats import ifc_triangles
from esplanade.planning.scene.formats.faces import Triangles

_GZIP: Final = ".gz"
_LONGEST_S: Final = 1800.0
"""A large building takes minutes; a damaged one might never end."""


def read_ifc(path: Path, data: bytes) -> Triangles:
    """The triangles of a building in metres, z up.

    Slabs, stairs, ramps, walls and furniture are taken as they are. Doors are left out, so that
    one walks through; how many is told, and so are the storeys by name. The library runs in a
    process of its own, since some damaged files end it.

    Raises
    ------
    ValueError
        It is no IFC, or IfcOpenShell is not installed.
    """
    if find_spec("ifcopenshell") is None:
        raise ValueError(
            "a building in IFC needs ifcopenshell: pip install 'esplanade[ifc]', or save it without"
        )
    if not data.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"ISO-10303-21"):
        raise ValueError("it does not begin as IFC does")
    with TemporaryDirectory() as folder:
        made = Path(folder, "triangles.npy")
        building = path
        if path.suffix.lower() == _GZIP:
            building = Path(folder, "building.ifc")
            building.write_bytes(data)
        told = _converted(building, made)
        if "fault" in told:
            raise ValueError(told["fault"])
        return Triangles(np.load(made), +Counter(told["passed"]), tuple(told["told"]))


def _converted(building: Path, made: Path) -> dict[str, Any]:
    """Facts that the other process tells of a building whose triangles it has written."""
    # With -P, none of the modules beside the script can stand for one of a library.
    command = [sys.executable, "-P", str(ifc_triangles.__file__), str(building), str(made)]
    try:
        done = subprocess.run(command, capture_output=True, check=False, timeout=_LONGEST_S)
    except subprocess.TimeoutExpired:
        raise ValueError(f"IfcOpenShell was not done with it after {_LONGEST_S:g} s") from None
    try:
        told: dict[str, Any] = json.loads(done.stdout.decode().rpartition("\n")[2])
    except ValueError:
        raise ValueError(f"IfcOpenShell ended on it with status {done.returncode}") from None
    return told
