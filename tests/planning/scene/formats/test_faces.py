"""Faces of many corners are filled whole and no further, in whatever plane they lie."""

import math
from collections import Counter

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely.geometry import Polygon

from esplanade.planning.scene.formats.faces import MAX_CORNERS, Faces, cut


def faces_of(*rings: list[tuple[float, float, float]]) -> Faces:
    sizes = np.array([len(ring) for ring in rings], dtype=np.int64)
    return Faces(np.concatenate(rings).astype(float), np.arange(sizes.sum()), sizes)


def area(points: np.ndarray) -> float:
    normals = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
    return float(0.5 * np.linalg.norm(normals, axis=1).sum())


U_SHAPE = [(0, 0), (12, 0), (12, 10), (8, 10), (8, 4), (4, 4), (4, 10), (0, 10)]
DART = [(0, 0), (4, 0), (1, 1), (0, 4)]
KEYHOLE = [(0, 0), (10, 0), (10, 10), (0, 10), (0, 0), (3, 3), (3, 7), (7, 7), (7, 3), (3, 3)]
"""A square with a square hole, joined to the outside by one edge there and back."""


def turned(ring: list[tuple[float, float]], seed: int) -> np.ndarray:
    """A ring in some plane."""
    rng = np.random.default_rng(seed)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    flat = np.array([(x, y, 0.0) for x, y in ring], dtype=float)
    return flat @ turn.T + rng.uniform(-50.0, 50.0, 3)


@pytest.mark.parametrize(
    ("ring", "expected"), [(U_SHAPE, 96.0), (DART, 4.0), (KEYHOLE, 84.0)], ids="UDK"
)
@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("backward", [False, True])
def test_concave_faces_are_filled(
    ring: list[tuple[float, float]], expected: float, seed: int, backward: bool
) -> None:
    for first in range(len(ring)):
        begun = ring[first:] + ring[:first]
        corners = turned(begun[::-1] if backward else begun, seed)
        found = cut(faces_of(corners))
        assert not found.passed
        assert area(found.points) == pytest.approx(expected)
        normals = np.cross(*(found.points[:, k] - found.points[:, 0] for k in (1, 2)))
        newell = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)
        assert (normals @ newell >= -1e-9).all()


@given(st.lists(st.floats(0.2, 3.0), min_size=5, max_size=40), st.integers(0, 99))
def test_stars_of_any_plane_are_filled_as_shapely_measures_them(
    radii: list[float], seed: int
) -> None:
    turns = [2.0 * math.pi * k / len(radii) for k in range(len(radii))]
    ring = [(r * math.cos(t), r * math.sin(t)) for r, t in zip(radii, turns, strict=True)]
    found = cut(faces_of(turned(ring, seed)))
    assert area(found.points) == pytest.approx(Polygon(ring).area, rel=1e-6)


def test_what_cannot_be_filled_is_passed_over_and_counted() -> None:
    crossing = [(0, 0, 0), (10, 10, 0), (10, 0, 0), (0, 9, 0)]
    line = [(0, 0, 0), (1, 1, 1), (2, 2, 2), (3, 3, 3)]
    pair = [(0, 0, 0), (1, 0, 0)]
    found = cut(faces_of(crossing, line, pair, turned(U_SHAPE, 1)))
    assert area(found.points) == pytest.approx(96.0)
    assert found.passed == Counter(
        {
            "faces that cross themselves": 1,
            "faces of no area": 1,
            "faces of fewer than three corners": 1,
        }
    )


def test_corners_of_a_face_are_bounded() -> None:
    ring = np.zeros((MAX_CORNERS + 1, 3))
    with pytest.raises(ValueError, match=f"{MAX_CORNERS} are possible"):
        cut(faces_of(ring))
