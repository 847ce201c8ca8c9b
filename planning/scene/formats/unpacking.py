"""Meshes that Draco or meshopt packed, unpacked by their libraries (extra `meshes`)."""

from __future__ import annotations

from importlib import import_module
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

MAX_BYTES: Final = 512 * 2**20
_FILTERS: Final = {
    "OCTAHEDRAL": "decode_filter_oct",
    "QUATERNION": "decode_filter_quat",
}


def extra(module: str, name: str, wanted_for: str) -> Any:
    """A library of an extra.

    Raises
    ------
    ValueError
        It is not installed; the message says how it is.
    """
    try:
        return import_module(module)
    except ImportError:
        raise ValueError(
            f"{wanted_for} needs {module}: pip install 'esplanade[{name}]', or save it without"
        ) from None


def unpacked_meshopt(data: bytes, described: Any) -> bytes:
    """The bytes of a view that meshopt packed."""
    library = extra("meshoptimizer", "meshes", "EXT_meshopt_compression")
    count, stride = described.get("count"), described.get("byteStride")
    if type(count) is not int or type(stride) is not int or not 0 < stride <= 256 or count < 0:
        raise ValueError("a view of EXT_meshopt_compression has no count or stride")
    if count * stride > MAX_BYTES:
        raise ValueError("a view of EXT_meshopt_compression is larger than is possible")
    try:
        match described.get("mode"):
            case "ATTRIBUTES":
                # With a `dtype` the library reserves a byte for each vertex, and writes beyond.
                found = np.ascontiguousarray(library.decode_vertex_buffer(count, stride, data))
                octets = found.reshape(-1).view(np.uint8)
                return _filtered(library, octets, described, count, stride)
            case "TRIANGLES":
                found = library.decode_index_buffer(count, stride, data)
            case "INDICES":
                found = library.decode_index_sequence(count, stride, data)
            case mode:
                raise ValueError(f"mode {mode!r} of EXT_meshopt_compression is unknown")
    except RuntimeError as error:
        raise ValueError(f"EXT_meshopt_compression cannot be unpacked: {error}") from None
    # The library reserves four bytes for each index, and fills as many as the stride.
    return np.asarray(found).tobytes()[: count * stride]


def _filtered(
    library: Any, found: NDArray[np.uint8], described: Any, count: int, stride: int
) -> bytes:
    name = described.get("filter", "NONE")
    if name == "NONE":
        return found.tobytes()
    if name == "EXPONENTIAL":
        # Each word is a mantissa of 24 and an exponent of 8 bits, both signed.
        words = np.frombuffer(found.tobytes(), dtype="<i4")
        mantissa = (words << 8) >> 8
        values = np.ldexp(mantissa.astype(np.float64), words >> 24)
        return bytes(values.astype("<f4").tobytes())
    if name not in _FILTERS:
        raise ValueError(f"filter {name!r} of EXT_meshopt_compression is unknown")
    undone = getattr(library, _FILTERS[name])(found, count, stride)
    return np.asarray(undone, dtype=np.uint8).tobytes()


def unpacked_draco(data: bytes) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices (N, 3) and triangles (T, 3) of a mesh that Draco packed."""
    library = extra("DracoPy", "meshes", "KHR_draco_mesh_compression")
    try:
        found = library.decode(data)
    except Exception as error:  # noqa: BLE001  (a class of the library's own, or of C++)
        raise ValueError(f"KHR_draco_mesh_compression cannot be unpacked: {error}") from None
    if not hasattr(found, "faces"):
        return np.empty((0, 3)), np.empty((0, 3), dtype=np.int64)
    return np.asarray(found.points, dtype=np.float64), np.asarray(found.faces, dtype=np.int64)
