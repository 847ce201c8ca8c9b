"""A binary heap of (key, item) on two arrays. Equal keys leave in the order of their items."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel


@kernel
def _before(key_a: float, item_a: int, key_b: float, item_b: int) -> bool:
    return key_a < key_b or (key_a == key_b and item_a < item_b)


@inlined
def heap_push(
    keys: NDArray[np.float64], items: NDArray[np.int64], size: int, key: float, item: int
) -> int:
    """Put an item in; returns the new size. The arrays must have room."""
    k = size
    while k > 0:
        parent = (k - 1) >> 1
        if not _before(key, item, keys[parent], items[parent]):
            break
        keys[k] = keys[parent]
        items[k] = items[parent]
        k = parent
    keys[k] = key
    items[k] = item
    return size + 1


@inlined
def heap_pop(keys: NDArray[np.float64], items: NDArray[np.int64], size: int) -> int:
    """Take the first item off a heap that is not empty; it was keys[0], items[0]. New size."""
    size -= 1
    key = keys[size]
    item = items[size]
    k = 0
    while True:
        child = 2 * k + 1
        if child >= size:
            break
        if child + 1 < size and _before(
            keys[child + 1], items[child + 1], keys[child], items[child]
        ):
            child += 1
        if not _before(keys[child], items[child], key, item):
            break
        keys[k] = keys[child]
        items[k] = items[child]
        k = child
    keys[k] = key
    items[k] = item
    return size
