"""Stereolithography (STL), as text and as bytes: triangles one by one."""

from typing import Final

import numpy as np

from esplanade.files.text import lines_of, shown
from esplanade.planning.scene.formats.faces import Triangles
from esplanade.planning.scene.formats.mesh_text import text_of_mesh

_HEADER_BYTES: Final = 84
_WIDE: Final = (b"\xff\xfe", b"\xfe\xff", b"s\0o\0", b"\0s\0o", b"S\0O\0", b"\0S\0O")
"""Text in UTF-16 begins so, with a byte order mark or with the word `solid`."""
_ROW: Final = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])


def read_stl(data: bytes) -> Triangles:
    """The triangles of an STL file.

    Raises
    ------
    ValueError
        It is none, or its length is not that of its triangles.
    """
    count = int.from_bytes(data[80:84], "little")
    length = _HEADER_BYTES + count * _ROW.itemsize
    if len(data) >= _HEADER_BYTES and len(data) == length:
        rows = np.frombuffer(data, dtype=_ROW, count=count, offset=_HEADER_BYTES)
        return Triangles(rows["corners"].astype(np.float64))
    is_text = b"\0" not in data[:_HEADER_BYTES] or data.startswith(_WIDE)
    if is_text and data[: 2**10].lstrip(b"\xef\xbb\xbf\xff\xfe \t\r\n\0").lower().startswith(b"s"):
        return _of_text(text_of_mesh(data))
    if len(data) > length >= _HEADER_BYTES:
        rows = np.frombuffer(data, dtype=_ROW, count=count, offset=_HEADER_BYTES)
        return Triangles(rows["corners"].astype(np.float64))
    raise ValueError(f"it should have {length} bytes for {count} triangles, and has {len(data)}")


def _of_text(text: str) -> Triangles:
    numbers: list[float] = []
    in_loop = 0
    for number, line in enumerate(lines_of(text), 1):
        words = line.split()
        match [word.lower() for word in words]:
            case ["vertex", x, y, z]:
                try:
                    numbers += (float(x), float(y), float(z))
                except ValueError:
                    raise ValueError(
                        f"line {number}: {shown(line)}: three numbers are expected"
                    ) from None
                in_loop += 1
            case ["vertex", *_]:
                raise ValueError(f"line {number}: {shown(line)}: three numbers are expected")
            case ["endloop"]:
                if in_loop != 3:
                    raise ValueError(f"line {number}: a triangle has {in_loop} corners")
                in_loop = 0
    if in_loop:
        raise ValueError("it ends within a triangle")
    return Triangles(np.array(numbers, dtype=np.float64).reshape(-1, 3, 3))
