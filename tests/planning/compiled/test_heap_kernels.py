"""The heap against a sorted list."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from esplanade.planning.compiled._heap_kernels import heap_pop, heap_push
from tests.planning.worlds import holds

# None takes the first item off; a number goes in as a key.
actions = st.lists(st.none() | st.integers(0, 9).map(float), max_size=60)


@given(actions)
@holds(150, 50)
def test_a_heap_gives_the_smallest_key_and_of_equal_ones_the_smallest_item(actions) -> None:
    keys = np.zeros(61)
    items = np.zeros(61, dtype=np.int64)
    size = 0
    listed: list[tuple[float, int]] = []
    for item, key in enumerate(actions):
        if key is not None:
            size = heap_push(keys, items, size, key, item)
            listed.append((key, item))
        elif listed:
            assert (keys[0], items[0]) == min(listed)
            listed.remove(min(listed))
            size = heap_pop(keys, items, size)
        assert size == len(listed)
