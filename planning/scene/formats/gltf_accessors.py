"""The arrays of a glTF file: views, accessors, sparse ones, and those that meshopt packed."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.scene.formats.gltf_container import MAX_BYTES, Container
from esplanade.planning.scene.formats.gltf_extensions import MESHOPT, requires
from esplanade.planning.scene.formats.unpacking import unpacked_meshopt

_COMPONENTS: Final[dict[Any, np.dtype[Any]]] = {
    5120: np.dtype("<i1"),
    5121: np.dtype("<u1"),
    5122: np.dtype("<i2"),
    5123: np.dtype("<u2"),
    5125: np.dtype("<u4"),
    5126: np.dtype("<f4"),
}
_WIDTHS: Final = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


class Accessors:
    """The accessors of an open file, each read once."""

    def __init__(self, container: Container) -> None:
        self._container = container
        self._views: dict[int, tuple[memoryview, int]] = {}

    def count(self, index: Any) -> int:
        """The elements of an accessor as the file tells them."""
        return _whole(self._container.part("accessors", index).get("count"), "count")

    def has_plain(self, primitive: Any, extension: str) -> bool:
        """Whether the positions of a packed primitive are there unpacked as well."""
        place = primitive.get("attributes", {}).get("POSITION")
        return (
            not requires(self._container.content, extension)
            and place is not None
            and "bufferView" in self._container.part("accessors", place)
        )

    def values(self, index: Any, width: int) -> NDArray[np.float64]:
        """An accessor as float64 (N, width), normalised where it is said to be."""
        found, normalised = self._raw(index, width)
        values = found.astype(np.float64)
        if normalised and found.dtype.kind in "iu":
            values = np.maximum(values / np.iinfo(found.dtype).max, -1.0)
        return values

    def indices(self, index: Any) -> NDArray[np.int64]:
        """An accessor of indices."""
        found, _ = self._raw(index, 1)
        if found.dtype.kind not in "iu":
            raise ValueError(f"accessor {index} holds no whole numbers")
        return found.astype(np.int64).reshape(-1)

    def _raw(self, index: Any, width: int) -> tuple[NDArray[Any], bool]:
        described = self._container.part("accessors", index)
        kind = _COMPONENTS.get(described.get("componentType"))
        if kind is None or _WIDTHS.get(described.get("type")) != width:
            raise ValueError(f"accessor {index} is not of the type that it should be")
        count = _whole(described.get("count"), "count")
        if count * width * 8 > MAX_BYTES:
            raise ValueError(f"accessor {index} has {count} elements, more than are possible")
        if "bufferView" in described:
            offset = _whole(described.get("byteOffset", 0), "byteOffset")
            values = self._elements(described["bufferView"], offset, count, width, kind)
        elif "sparse" in described:
            values = np.zeros((count, width), dtype=kind)
        else:
            raise ValueError(f"accessor {index} has no bytes")
        if "sparse" in described:
            values = self._with_sparse(values.copy(), described["sparse"], kind)
        return values, bool(described.get("normalized"))

    def _with_sparse(self, values: NDArray[Any], sparse: Any, kind: np.dtype[Any]) -> NDArray[Any]:
        count = _whole(sparse.get("count"), "count")
        places, new = sparse.get("indices", {}), sparse.get("values", {})
        index_kind = _COMPONENTS.get(places.get("componentType"), np.dtype("<u4"))
        at = self._elements(
            places.get("bufferView"), places.get("byteOffset", 0), count, 1, index_kind
        ).reshape(-1)
        if count and int(at.max()) >= len(values):
            raise ValueError("a sparse accessor names an element that is out of bounds")
        width = values.shape[1]
        values[at] = self._elements(
            new.get("bufferView"), new.get("byteOffset", 0), count, width, kind
        )
        return values

    def _elements(
        self, view: Any, offset: int, count: int, width: int, kind: np.dtype[Any]
    ) -> NDArray[Any]:
        """Elements of a view, (count, width); they may lie apart by its stride."""
        data, stride = self.view(view)
        size = width * kind.itemsize
        stride = stride or size
        if count == 0:
            return np.empty((0, width), dtype=kind)
        if offset < 0 or stride < size or offset + (count - 1) * stride + size > len(data):
            raise ValueError(f"an accessor goes beyond the end of bufferView {view}")
        found: NDArray[Any] = np.ndarray(
            (count, width), kind, data, offset, (stride, kind.itemsize)
        )
        return found

    def view(self, index: Any) -> tuple[memoryview, int]:
        """The bytes of a view, and its stride or 0."""
        described = self._container.part("bufferViews", index)
        if index not in self._views:
            extensions = described.get("extensions", {})
            name = next((name for name in MESHOPT if name in extensions), "")
            packed = extensions.get(name)
            if packed is None or self._is_plain(described, name):
                self._views[index] = self._span(described), _stride(described)
            else:
                data = unpacked_meshopt(bytes(self._span(packed)), packed)
                self._views[index] = memoryview(data), _stride(described)
        return self._views[index]

    def _is_plain(self, described: Any, extension: str) -> bool:
        """Whether the bytes of a packed view are there unpacked as well."""
        buffer = self._container.part("buffers", described.get("buffer"))
        marked = any(name in buffer.get("extensions", {}) for name in MESHOPT)
        return not requires(self._container.content, extension) and not marked

    def _span(self, described: Any) -> memoryview:
        data = memoryview(self._container.buffer(described.get("buffer")))
        start = _whole(described.get("byteOffset", 0), "byteOffset")
        length = _whole(described.get("byteLength"), "byteLength")
        if start + length > len(data):
            raise ValueError("a bufferView goes beyond the end of its buffer")
        return data[start : start + length]


def _stride(described: Any) -> int:
    return _whole(described.get("byteStride", 0), "byteStride")


def _whole(value: Any, name: str) -> int:
    if type(value) is not int or value < 0:
        raise ValueError(f"a {name} is {value!r}, and must be a whole number from 0")
    return value
