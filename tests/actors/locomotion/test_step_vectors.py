"""The steps that the web client is tested with are drawn as `posing` draws them."""

import json
import math

from tests.actors.locomotion import step_vectors


def test_the_stored_vectors_are_up_to_date() -> None:
    stored = json.loads(step_vectors.FIXTURE.read_text(encoding="utf-8"))
    differences = _differences(stored, step_vectors.vectors())
    assert not differences, "run: python -m tests.actors.locomotion.step_vectors"


def _differences(a: object, b: object) -> list[tuple[object, object]]:
    """Leaves that differ, numbers by more than rounding."""
    if isinstance(a, dict) and isinstance(b, dict) and a.keys() == b.keys():
        return [pair for key in a for pair in _differences(a[key], b[key])]
    if isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        return [pair for x, y in zip(a, b, strict=True) for pair in _differences(x, y)]
    if isinstance(a, float) and isinstance(b, int | float):
        return [] if math.isclose(a, b, rel_tol=0.0, abs_tol=1e-9) else [(a, b)]
    return [] if a == b else [(a, b)]
