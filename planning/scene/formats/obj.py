"""Wavefront OBJ: corners and faces; materials, textures and normals are never looked at."""

from __future__ import annotations

import re
from array import array
from collections import Counter
from collections.abc import Iterator
from typing import Final

import numpy as np

from esplanade.files.text import shown
from esplanade.planning.scene.formats.faces import Faces
from esplanade.planning.scene.formats.lengths import metres_in
from esplanade.planning.scene.formats.mesh_text import text_of_mesh
from esplanade.planning.scene.formats.obj_runs import Run, run_at

MAX_ELEMENTS: Final = 15_000_000
"""Most corners of all faces, and most numbers of all vertices."""

_HEAD: Final = 4096
_UNIT: Final = re.compile(
    r"^[ \t]*#.*\bunits?[ \t]*(?:[:=]|is|are)[ \t]*(\w+)", re.IGNORECASE | re.MULTILINE
)
_LOOKS: Final = frozenset(
    (
        *("vt", "vn", "vp", "o", "g", "s", "mg", "l", "p"),
        *("usemtl", "mtllib", "usemap", "maplib", "shadow_obj", "trace_obj"),
        *("bevel", "c_interp", "d_interp", "lod", "cstype", "deg", "bmat", "step"),
        *("parm", "trim", "hole", "scrv", "sp", "end", "con"),
    )
)
"""Statements that add no faces."""
_CURVED: Final = frozenset(("curv", "curv2", "surf", "bzp", "bsp", "cdc", "cdp", "res"))
_ELSEWHERE: Final = frozenset(("call", "csh"))


def read_obj(data: bytes) -> Faces:
    """The faces of an OBJ file.

    Any white space divides words, a backslash at the end continues a line, and negative indices
    count back from the last vertex that was given before.

    Raises
    ------
    ValueError
        A line is none of OBJ, with its number.
    """
    numbers, corners, sizes = array("d"), array("q"), array("q")
    lines_of_faces = array("q")
    passed: Counter[str] = Counter()
    text = text_of_mesh(data)
    for line, words in _statements(text):
        if isinstance(words, Run):
            if words.corners:
                corners.frombytes((words.numbers.astype(np.int64) - 1).tobytes())
                sizes.extend(array("q", [words.corners]) * words.lines)
                lines_of_faces.extend(range(line, line + words.lines))
            else:
                numbers.frombytes(words.numbers.tobytes())
            _check_count(line, numbers, corners)
            continue
        key = words[0]
        if key == "v":
            _add_vertex(line, words, numbers)
        elif key in ("f", "fo"):
            _add_face(line, words, corners, len(numbers) // 3)
            sizes.append(len(words) - 1)
            lines_of_faces.append(line)
        elif key in _ELSEWHERE:
            raise ValueError(f"line {line}: {key!r} takes in another file, which is not read")
        elif key in _CURVED:
            passed["curves and curved surfaces"] += 1
        elif key not in _LOOKS:
            passed[f"lines that are no statement of OBJ, as line {line}"] += 1
        _check_count(line, numbers, corners)
    vertices = np.frombuffer(numbers, dtype=np.float64).reshape(-1, 3) if numbers else _none()
    faces = np.frombuffer(corners, dtype=np.int64) if corners else np.empty(0, dtype=np.int64)
    counts = np.frombuffer(sizes, dtype=np.int64) if sizes else np.empty(0, dtype=np.int64)
    beyond = np.flatnonzero(faces >= len(vertices))
    if len(beyond):
        face = int(np.searchsorted(np.cumsum(counts), beyond[0], side="right"))
        raise ValueError(
            f"line {lines_of_faces[face]}: the face names corner {faces[beyond[0]] + 1}, which is "
            f"out of bounds: there are {len(vertices)}"
        )
    return Faces(vertices, faces, counts, _one_line_of_unknown(passed), _unit_said(text))


def _unit_said(text: str) -> str:
    """The unit of length that a comment at the beginning names, as SketchUp and 3ds Max do."""
    found = _UNIT.search(text, 0, _HEAD)
    return found[1] if found and metres_in(found[1]) is not None else ""


def _check_count(line: int, numbers: array[float], corners: array[int]) -> None:
    if max(len(numbers), len(corners)) > MAX_ELEMENTS:
        raise ValueError(f"line {line}: it has more vertices or faces than are possible")


def _none() -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    return np.empty((0, 3))


def _statements(text: str) -> Iterator[tuple[int, list[str] | Run]]:
    """The words of each statement, with the number of its last line.

    Runs of plain lines come as one, with the number of the first.
    """
    begun = ""
    continued = "\\" in text
    begin, number = 0, 1
    while begin <= len(text):
        if not continued and (run := run_at(text, begin)) is not None:
            yield number, run
            begin, number = run.end, number + run.lines
            continue
        end = text.find("\n", begin)
        end = len(text) if end < 0 else end
        line = text[begin:end]
        begin, number = end + 1, number + 1
        if "#" in line:
            line = line[: line.index("#")]
        elif continued and line.rstrip().endswith("\\"):
            begun += line.rstrip()[:-1] + " "
            continue
        if begun:
            line, begun = begun + line, ""
        words = line.split()
        if words:
            yield number - 1, words
    if begun.split():
        yield number - 1, begun.split()


def _add_vertex(line: int, words: list[str], numbers: array[float]) -> None:
    try:
        numbers.extend((float(words[1]), float(words[2]), float(words[3])))
    except (ValueError, IndexError):
        raise ValueError(
            f"line {line}: {shown(' '.join(words))}: a vertex is 'v' and three numbers"
        ) from None


def _add_face(line: int, words: list[str], corners: array[int], known: int) -> None:
    for word in words[1:]:
        try:
            index = int(word.partition("/")[0])
        except ValueError:
            raise ValueError(
                f"line {line}: {shown(word)}: a corner of a face is a whole number"
            ) from None
        place = index - 1 if index > 0 else known + index
        if index == 0 or place < 0:
            raise ValueError(
                f"line {line}: the face names corner {index}, which is out of bounds: there are "
                f"{known} before it"
            )
        if place > MAX_ELEMENTS:
            raise ValueError(f"line {line}: the face names corner {index}, which is out of bounds")
        corners.append(place)


def _one_line_of_unknown(passed: Counter[str]) -> Counter[str]:
    """Unknown lines under the name of the first of them."""
    unknown = [name for name in passed if name.startswith("lines that are no")]
    if unknown:
        count = sum(passed.pop(name) for name in unknown)
        passed[unknown[0]] = count
    return passed
