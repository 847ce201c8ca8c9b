"""Object File Format (OFF, with colours COFF, with normals NOFF): corners and faces as text."""

from collections.abc import Iterator
from itertools import islice
from typing import Final

import numpy as np

from esplanade.files.text import lines_of, shown
from esplanade.planning.scene.formats.faces import Faces
from esplanade.planning.scene.formats.mesh_text import text_of_mesh

HEADERS: Final = ("OFF", "COFF", "NOFF", "CNOFF", "STOFF", "STCOFF", "STNOFF", "STCNOFF")


def read_off(data: bytes) -> Faces:
    """The faces of an OFF file.

    Raises
    ------
    ValueError
        The file is none of OFF, with the number of the line.
    """
    lines = _lines(text_of_mesh(data))
    number, words = next(lines, (1, []))
    if not words or words[0].upper() not in HEADERS:
        raise ValueError(f"line {number}: a file of OFF begins with 'OFF', and is text")
    counts = words[1:]
    if not counts:
        number, counts = next(lines, (number, []))
    try:
        vertex_count, face_count = int(counts[0]), int(counts[1])
    except (ValueError, IndexError):
        raise ValueError(f"line {number}: the counts of vertices and faces are expected") from None
    vertices = []
    for number, words in islice(lines, max(0, vertex_count)):
        try:
            vertices.append((float(words[0]), float(words[1]), float(words[2])))
        except (ValueError, IndexError):
            raise ValueError(
                f"line {number}: {shown(' '.join(words))}: three numbers are expected"
            ) from None
    corners: list[int] = []
    sizes = []
    for number, words in islice(lines, max(0, face_count)):
        try:
            size = int(words[0])
            face = [int(word) for word in words[1 : size + 1]]
        except ValueError:
            face, size = [], 1
        if len(face) != size or size < 0:
            raise ValueError(
                f"line {number}: {shown(' '.join(words))}: a face is a count and its corners"
            )
        if face and not 0 <= min(face) <= max(face) < len(vertices):
            raise ValueError(
                f"line {number}: the face names a corner that is out of bounds: there are "
                f"{len(vertices)}"
            )
        corners += face
        sizes.append(size)
    if len(vertices) != vertex_count or len(sizes) != face_count:
        raise ValueError(
            f"line {number}: it ends after {len(vertices)} of {vertex_count} vertices and "
            f"{len(sizes)} of {face_count} faces"
        )
    return Faces(
        np.array(vertices, dtype=np.float64).reshape(-1, 3),
        np.array(corners, dtype=np.int64),
        np.array(sizes, dtype=np.int64),
    )


def _lines(text: str) -> Iterator[tuple[int, list[str]]]:
    for number, line in enumerate(lines_of(text), 1):
        words = line.partition("#")[0].split()
        if words:
            yield number, words
