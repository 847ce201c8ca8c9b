"""3D Manufacturing Format (3MF): the items that a zip archive builds, in metres, z up."""

from __future__ import annotations

import io
import re
import zipfile
from array import array
from collections import Counter
from pathlib import PurePosixPath
from typing import Final
from xml.parsers import expat

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.scene.formats.faces import Triangles

MAX_UNPACKED_BYTES: Final = 160 * 2**20
MAX_RATIO: Final = 60
"""Text packs to a twentieth at best; an archive that grows more is meant to fill a memory."""
MAX_TRIANGLES: Final = 5_000_000
MAX_THINGS: Final = 5_000
MAX_DEPTH: Final = 32
_UNITS: Final = {
    "micron": 1e-6,
    "millimeter": 1e-3,
    "centimeter": 1e-2,
    "inch": 0.0254,
    "foot": 0.3048,
    "meter": 1.0,
}
_EMPTY: Final = np.empty((0, 3, 3))
_KNOWN: Final = re.compile(r"/(core|production|material|securecontent|triangleset)s?/")
"""Extensions that are read or change no geometry."""
_MOST_RELATIONS_BYTES: Final = 2**16
_Floats = NDArray[np.float64]


class _Thing:
    """A mesh, or a group of other things."""

    def __init__(self) -> None:
        self.numbers = array("d")
        self.corners = array("q")
        self.parts: list[tuple[tuple[str, str], _Floats]] = []


class _Model:
    """One model part of the archive."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.unit = 1e-3
        self.things: dict[tuple[str, str], _Thing] = {}
        self.items: list[tuple[tuple[str, str], _Floats]] = []
        self._open = _Thing()
        self.passed: Counter[str] = Counter()

    def read(self, data: bytes) -> None:
        """Read the XML of the part; entities are refused."""
        parser = expat.ParserCreate()
        parser.StartElementHandler = self._start
        parser.StartDoctypeDeclHandler = _refuse_doctype
        try:
            parser.Parse(data, True)
        except expat.ExpatError as error:
            raise ValueError(f"{self.name}: it is no XML: {error}") from None
        except (KeyError, OverflowError) as error:
            raise ValueError(f"{self.name}: an element lacks {error}") from None

    def _start(self, tag: str, has: dict[str, str]) -> None:
        match tag.rpartition(":")[2]:
            case "vertex":
                self._open.numbers.extend((float(has["x"]), float(has["y"]), float(has["z"])))
            case "triangle":
                self._open.corners.extend((int(has["v1"]), int(has["v2"]), int(has["v3"])))
            case "model":
                unit = has.get("unit", "millimeter")
                if unit not in _UNITS:
                    raise ValueError(f"{self.name}: its unit {unit!r} is unknown")
                self.unit = _UNITS[unit]
                self._check_required(has)
            case "object":
                self._open = self.things[(self.name, has["id"])] = _Thing()
            case "component":
                self._open.parts.append((self._named(has), _transform(has.get("transform"))))
            case "beam" | "ball":
                self.passed["beams of lattices"] += 1
            case "item" if has.get("printable", "1") in ("0", "false"):
                self.passed["items that are not to be built"] += 1
            case "item":
                self.items.append((self._named(has), _transform(has.get("transform"))))

    def _check_required(self, has: dict[str, str]) -> None:
        """Refuse extensions that are required and unknown, as the specification has it."""
        for prefix in has.get("requiredextensions", "").split():
            namespace = has.get(f"xmlns:{prefix}", prefix)
            if not _KNOWN.search(namespace):
                raise ValueError(f"it requires the extension {namespace!r:.80}, unknown here")

    def _named(self, has: dict[str, str]) -> tuple[str, str]:
        path = next((value for key, value in has.items() if key.endswith(":path")), self.name)
        return path.lstrip("/"), has["objectid"]


def read_3mf(data: bytes) -> Triangles:
    """The triangles that a 3MF file builds, in metres, z up.

    Raises
    ------
    ValueError
        It is no 3MF, or grows larger than may be when it is unpacked.
    """
    try:
        archive = zipfile.ZipFile(io.BytesIO(data))
        names = [n for n in archive.namelist() if PurePosixPath(n).suffix.lower() == ".model"]
        parts = archive.infolist()
        unpacked = sum(part.file_size for part in parts)
        if unpacked > min(MAX_UNPACKED_BYTES, MAX_RATIO * len(data) + 2**20):
            raise ValueError(f"it grows to {unpacked / 2**20:.0f} MiB when it is unpacked")
        if not names:
            raise ValueError(
                "the archive holds no model of 3MF: unpack it, if it holds another file"
            )
        models = [_Model(name) for name in names]
        for model in models:
            with archive.open(model.name) as file:
                model.read(file.read(MAX_UNPACKED_BYTES))
    except (zipfile.BadZipFile, NotImplementedError, RuntimeError, EOFError) as error:
        raise ValueError(f"it is no archive that can be read: {error}") from None
    root = _root(archive, models)
    passed = sum((model.passed for model in models), Counter[str]())
    things = {key: thing for model in models for key, thing in model.things.items()}
    shown: list[_Floats] = [np.empty((0, 3, 3))]
    for name, transform in root.items:
        _show(things, name, transform * [[root.unit]], shown, MAX_DEPTH)
    return Triangles(np.concatenate(shown), +passed)


def _root(archive: zipfile.ZipFile, models: list[_Model]) -> _Model:
    """The model that is built; all others only hold parts for it."""
    try:
        relations = archive.read("_rels/.rels")[:_MOST_RELATIONS_BYTES].decode(errors="replace")
    except KeyError:
        relations = ""
    found = re.findall(r"<[^>]*3dmodel[^>]*>", relations)
    targets = {name.lstrip("/") for part in found for name in re.findall(r'Target="([^"]*)"', part)}
    named = [model for model in models if model.name in targets]
    return (named or [model for model in models if model.items] or models)[0]


def _show(
    things: dict[tuple[str, str], _Thing],
    name: tuple[str, str],
    at: _Floats,
    shown: list[_Floats],
    left: int,
) -> None:
    """Add the triangles of a thing where a transform (4, 3) puts it."""
    thing = things.get(name)
    if thing is None:
        raise ValueError(f"it builds object {name[1]!r}, which is not there")
    if left == 0:
        raise ValueError("its components lie too deep within each other")
    if thing.corners:
        vertices = np.array(thing.numbers).reshape(-1, 3)
        corners = np.array(thing.corners, dtype=np.int64).reshape(-1, 3)
        if not 0 <= corners.min() <= corners.max() < len(vertices):
            raise ValueError("a triangle names a corner that is out of bounds")
        points = (vertices @ at[:3] + at[3])[corners]
        shown.append(points[:, ::-1] if np.linalg.det(at[:3]) < 0.0 else points)
    else:
        shown.append(_EMPTY)  # counts as a thing that is built
    if len(shown) > MAX_THINGS or sum(map(len, shown)) > MAX_TRIANGLES:
        raise ValueError(f"it builds more than {MAX_TRIANGLES} triangles or {MAX_THINGS} objects")
    for part, transform in thing.parts:
        below = np.concatenate([transform[:3] @ at[:3], transform[3:] @ at[:3] + at[3]])
        _show(things, part, below, shown, left - 1)


def _transform(text: str | None) -> _Floats:
    """A transform of 3MF: rows of a matrix (4, 3) by which rows are multiplied."""
    if text is None:
        return np.eye(4)[:, :3]
    numbers = [float(word) for word in text.split()]
    if len(numbers) != 12:
        raise ValueError(f"a transform has {len(numbers)} numbers, and not 12")
    return np.array(numbers).reshape(4, 3)


def _refuse_doctype(*_: object) -> None:
    raise ValueError("its XML declares a document type, which 3MF forbids")
