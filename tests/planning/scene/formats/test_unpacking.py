"""Views that meshopt packed, with each of its filters."""

import numpy as np
import pytest

from esplanade.planning.scene.formats.unpacking import unpacked_meshopt

meshopt = pytest.importorskip("meshoptimizer")


def unpacked(packed: np.ndarray, name: str) -> bytes:
    """Elements (N, K) after packing and unpacking with a filter."""
    count, stride = len(packed), packed[0].nbytes
    data = bytes(meshopt.encode_vertex_buffer(packed, count, stride))
    described = {"count": count, "byteStride": stride, "mode": "ATTRIBUTES", "filter": name}
    return unpacked_meshopt(data, described)


def test_without_a_filter_elements_are_as_they_were() -> None:
    packed = np.arange(12, dtype="<f4").reshape(4, 3)
    assert unpacked(packed, "NONE") == packed.tobytes()


def test_octahedral_normals_are_unfolded() -> None:
    packed = np.array([(0, 0, 127, 5), (127, 0, 127, 6), (0, -127, 127, 7)], dtype="i1")
    found = np.frombuffer(unpacked(packed, "OCTAHEDRAL"), dtype="i1").reshape(-1, 4)
    assert found.tolist() == [[0, 0, 127, 5], [127, 0, 0, 6], [0, -127, 0, 7]]


def test_quaternions_get_their_greatest_part_back() -> None:
    # The last two bits name the part that was left out.
    packed = np.array([(0, 0, 0, 32767), (0, 0, 0, 32764)], dtype="<i2")
    found = np.frombuffer(unpacked(packed, "QUATERNION"), dtype="<i2").reshape(-1, 4)
    assert found.tolist() == [[0, 0, 0, 32767], [32767, 0, 0, 0]]


def test_exponential_numbers_are_made_whole() -> None:
    words = [[(-1 << 24) | 3, (2 << 24) | 5], [0, (-3 << 24) | (-7 & 0xFFFFFF)]]
    found = np.frombuffer(unpacked(np.array(words, dtype="<i4"), "EXPONENTIAL"), dtype="<f4")
    assert found.tolist() == [1.5, 20.0, 0.0, -0.875]


def test_an_unknown_filter_is_refused_by_name() -> None:
    with pytest.raises(ValueError, match="filter 'COLOR' of EXT_meshopt_compression is unknown"):
        unpacked(np.zeros((4, 3), dtype="<f4"), "COLOR")
