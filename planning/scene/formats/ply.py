"""Polygon File Format (PLY), as text and as bytes of either order: corners and faces."""

from __future__ import annotations

import re
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.files.text import decoded, shown
from esplanade.planning.scene.formats.faces import Faces

_TYPES: Final = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}
_ORDERS: Final = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_FACES: Final = ("vertex_indices", "vertex_index")
_MAX_HEADER_BYTES: Final = 2**16


class _Property(NamedTuple):
    name: str
    kind: str
    count_kind: str
    """The type of the count of a list; empty for a single value."""


class _Element(NamedTuple):
    name: str
    length: int
    properties: list[_Property]


def read_ply(data: bytes) -> Faces:
    """The faces of a PLY file; triangle strips are refused.

    Raises
    ------
    ValueError
        The file is none of PLY, or ends too early.
    """
    data = _with_lines(data.removeprefix(b"\xef\xbb\xbf"))
    end = data.find(b"end_header", 0, _MAX_HEADER_BYTES)
    line_end = data.find(b"\n", end)
    if end < 0 or line_end < 0:
        raise ValueError("its header has no end")
    order, elements = _header(data[:end].decode("latin-1"))
    if any(element.name == "tristrips" for element in elements):
        raise ValueError("it holds triangle strips, which are not read; save it with faces")
    body = data[line_end + 1 :]
    columns = _ascii(body, elements) if not order else _binary(body, elements, order)
    vertex = columns.get("vertex", {})
    if not all(axis in vertex for axis in "xyz"):
        raise ValueError("its vertices have no x, y, z")
    vertices = np.stack([np.asarray(vertex[axis], dtype=np.float64) for axis in "xyz"], axis=1)
    face = columns.get("face", {})
    corners, sizes = next(
        (face[name] for name in _FACES if name in face),
        (np.empty(0, np.int64), np.empty(0, np.int64)),
    )
    if len(corners) and not 0 <= corners.min() <= corners.max() < len(vertices):
        raise ValueError(f"a face names a corner that is out of bounds: there are {len(vertices)}")
    return Faces(vertices, corners, sizes)


def _with_lines(data: bytes) -> bytes:
    """A text in another encoding, or with other ends of lines, as it is defined; bytes stay."""
    head = data[:_MAX_HEADER_BYTES]
    is_wide = not head.startswith(b"ply")
    is_old = b"\n" not in head and b"format ascii" in head
    return decoded(data, eight_bit=True).text.encode() if is_wide or is_old else data


def _header(text: str) -> tuple[str, list[_Element]]:
    order, elements = None, list[_Element]()
    for number, line in enumerate(text.splitlines(), 1):
        match line.split():
            case ["format", name, *_] if name in _ORDERS:
                order = _ORDERS[name]
            case ["element", name, length] if length.isdecimal():
                elements.append(_Element(name, int(length), []))
            case ["property", *_] if not elements:
                raise ValueError(f"line {number}: a property of no element")
            case ["property", "list", count, kind, name] if {count, kind} <= _TYPES.keys():
                elements[-1].properties.append(_Property(name, _TYPES[kind], _TYPES[count]))
            case ["property", kind, name] if kind in _TYPES:
                elements[-1].properties.append(_Property(name, _TYPES[kind], ""))
            case ["ply" | "comment" | "obj_info", *_] | []:
                pass
            case _:
                raise ValueError(f"line {number}: {shown(line)} is no header of PLY")
    if order is None:
        raise ValueError("its header names no format")
    return order, elements


def _binary(body: bytes, elements: list[_Element], order: str) -> dict[str, dict[str, Any]]:
    found: dict[str, dict[str, Any]] = {}
    place = 0
    for element in elements:
        values, place = _binary_element(body, place, element, order)
        found[element.name] = values
    return found


def _binary_element(
    body: bytes, place: int, element: _Element, order: str
) -> tuple[dict[str, Any], int]:
    """The columns of an element, and where the next begins.

    All lists are first taken to be as long as those of the first row, which is almost always so.
    """
    fields: list[Any] = []
    start = place
    for part in element.properties:
        if part.count_kind:
            count_type = np.dtype(order + part.count_kind)
            count = _count(body, start, count_type) if element.length else 0
            fields += [(f"{part.name} count", count_type.str, ())]
            fields += [(part.name, order + part.kind, (count,))]
            start += count_type.itemsize + count * np.dtype(part.kind).itemsize
        else:
            fields.append((part.name, order + part.kind, ()))
            start += np.dtype(part.kind).itemsize
    row = np.dtype(fields)
    if place + row.itemsize * element.length <= len(body):
        rows = np.frombuffer(body, dtype=row, count=element.length, offset=place)
        lists = [part.name for part in element.properties if part.count_kind]
        if all((rows[f"{name} count"] == row[name].shape[0]).all() for name in lists):
            columns: dict[str, Any] = {}
            for part in element.properties:
                columns[part.name] = rows[part.name]
                if part.count_kind:
                    size = row[part.name].shape[0]
                    corners = rows[part.name].astype(np.int64).reshape(-1)
                    columns[part.name] = (corners, np.full(element.length, size, dtype=np.int64))
            return columns, place + row.itemsize * element.length
    return _row_by_row(body, place, element, order)


def _count(body: bytes, place: int, kind: np.dtype[np.generic]) -> int:
    if place + kind.itemsize > len(body):
        raise ValueError("it ends within its faces")
    return _length(int(np.frombuffer(body, dtype=kind, count=1, offset=place)[0]))


def _length(count: int) -> int:
    if count < 0:
        raise ValueError(f"a list of {count} values cannot be")
    return count


def _row_by_row(
    body: bytes, place: int, element: _Element, order: str
) -> tuple[dict[str, Any], int]:
    """The lists of an element whose rows differ in length; single values are passed over."""
    types = [
        (part.name, np.dtype(order + part.kind), part.count_kind and order + part.count_kind)
        for part in element.properties
    ]
    corners: dict[str, list[NDArray[np.generic]]] = {name: [] for name, _, count in types if count}
    sizes: dict[str, list[int]] = {name: [] for name in corners}
    for _ in range(element.length):
        for name, kind, count_kind in types:
            count = 1
            if count_kind:
                count_type = np.dtype(count_kind)
                count = _count(body, place, count_type)
                place += count_type.itemsize
            if place + count * kind.itemsize > len(body):
                raise ValueError(f"it ends within its {element.name}s")
            if count_kind:
                sizes[name].append(count)
                corners[name].append(np.frombuffer(body, kind, count, place))
            place += count * kind.itemsize
    columns: dict[str, Any] = {
        name: (
            np.concatenate([np.empty(0, np.int64), *parts]).astype(np.int64),
            np.array(sizes[name], dtype=np.int64),
        )
        for name, parts in corners.items()
    }
    return columns, place


def _ascii(body: bytes, elements: list[_Element]) -> dict[str, dict[str, Any]]:
    least = sum(element.length * max(1, len(element.properties)) for element in elements)
    if 2 * least > len(body) + 1:
        raise ValueError(f"it ends before its {least} numbers")
    words = (found.group() for found in re.finditer(rb"\S+", body))
    found: dict[str, dict[str, Any]] = {}
    try:
        for element in elements:
            single: dict[str, list[float]] = {p.name: [] for p in element.properties}
            sizes: dict[str, list[int]] = {p.name: [] for p in element.properties if p.count_kind}
            for _ in range(element.length):
                for part in element.properties:
                    values = single[part.name]
                    if part.count_kind:
                        count = _length(int(next(words)))
                        sizes[part.name].append(count)
                        values.extend([float(next(words)) for _ in range(count)])
                    else:
                        values.append(float(next(words)))
            found[element.name] = {
                name: (np.array(values, dtype=np.int64), np.array(sizes[name], dtype=np.int64))
                if name in sizes
                else np.array(values)
                for name, values in single.items()
            }
    except StopIteration:
        raise ValueError(f"it ends within its {element.name}s") from None
    return found
