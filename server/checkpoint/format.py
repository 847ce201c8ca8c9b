"""The bytes of a checkpoint: plain data and arrays, packed and compressed."""

import hashlib
import zlib
from collections.abc import Mapping
from typing import Any, Final

import msgpack
import numpy as np

from esplanade.server.checkpoint.errors import CheckpointError

FORMAT: Final = "esplanade checkpoint 1"
MOST_BYTES: Final = 128 * 1024**2
"""A checkpoint that unpacks to more is refused."""
_ARRAY: Final = 1
_LEVEL: Final = 1
"""Higher levels take several times as long for a tenth of the bytes."""


def pack(parts: Mapping[str, Any]) -> bytes:
    """The bytes of parts: numbers, text, bytes, lists, mappings and arrays."""
    return zlib.compress(packed(parts), _LEVEL)


def packed(parts: Any) -> bytes:
    """The same, not compressed; equal parts have equal bytes."""
    made: bytes = msgpack.packb(parts, default=_packed)
    return made


def unpack(payload: bytes) -> dict[str, Any]:
    """The parts that `pack` was given; tuples have become lists.

    Raises
    ------
    CheckpointError
        These are no such bytes.
    """
    try:
        stream = zlib.decompressobj()
        found = stream.decompress(payload, MOST_BYTES)
    except zlib.error as error:
        raise CheckpointError(f"it cannot be unpacked: {error}") from error
    parts = parts_of(found)
    if not stream.eof or stream.unused_data:
        raise CheckpointError("it is cut off, or too large")
    return parts


def parts_of(found: bytes) -> dict[str, Any]:
    """The parts that `packed` was given; tuples have become lists.

    Raises
    ------
    CheckpointError
        These are no such bytes.
    """
    try:
        parts = msgpack.unpackb(
            found, ext_hook=_unpacked, strict_map_key=False, max_ext_len=MOST_BYTES
        )
    except (msgpack.UnpackException, ValueError, TypeError, RecursionError) as error:
        raise CheckpointError(f"it cannot be unpacked: {error}") from error
    if not isinstance(parts, dict) or not all(isinstance(name, str) for name in parts):
        raise CheckpointError("it does not have parts with names")
    return parts


def digest(payload: bytes) -> str:
    """The digest by which damage is seen."""
    return hashlib.sha256(payload).hexdigest()


def _packed(value: object) -> Any:
    if isinstance(value, np.ndarray):
        fields = value.dtype.names
        kind = value.dtype.str if fields is None else [list(each) for each in value.dtype.descr]
        header = msgpack.packb([kind, value.shape])
        return msgpack.ExtType(_ARRAY, header + np.ascontiguousarray(value).tobytes())
    if isinstance(value, set | frozenset):
        return sorted(value)
    raise TypeError(f"a checkpoint cannot hold a {type(value).__name__}")


def _unpacked(code: int, data: bytes) -> Any:
    if code != _ARRAY:
        raise ValueError(f"values of kind {code} are not known")
    reader = msgpack.Unpacker(max_buffer_size=len(data) or 1)
    reader.feed(data)
    kind, shape = reader.unpack()
    dtype = np.dtype(_descr(kind))
    if dtype.hasobject or dtype.itemsize == 0:
        raise ValueError(f"arrays of {dtype} are not known")
    return np.frombuffer(data, dtype, offset=reader.tell()).reshape(shape).copy()


def _descr(kind: Any) -> Any:
    """The description that numpy makes a type of, with tuples instead of lists."""
    if isinstance(kind, str):
        return kind
    return [(name, _descr(inner), *map(tuple, shape)) for name, inner, *shape in kind]
