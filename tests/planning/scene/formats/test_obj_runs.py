"""Runs of lines of OBJ that are alike are read as they are one by one, faults included."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.planning.scene.formats import obj_runs
from esplanade.planning.scene.formats.obj import read_obj

LINES = (
    *("v 1 2 3", "v -1e3 .5 2.", "v  0\t+4 1E-2 ", "v 1 2 3 4", "v 1 2", "v 0x1 2 3", "v ٣ 1 2"),
    *("f 1 2 3", "f 3 1 2", "f 1/2/3 2//1 3/", "f 1 2 3 4", "f 4 3 2 1", "f 1 2 3 4 5", "f -1 -2 -3"),  # noqa: E501
    *("f 1 2 3 ", "f 0 1 2", "f 1/x 2 3", "f 99999999 1 2", "# v 1 2 3", "vt 0 0", "", "g all"),
)  # fmt: skip
RUNS = st.lists(st.tuples(st.sampled_from(LINES), st.integers(1, 6)), max_size=8)


def outcome(text: str, least_lines: int) -> object:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(obj_runs, "_LEAST_LINES", least_lines)
        patch.setattr(obj_runs, "_PIECE", 64)
        try:
            found = read_obj(text.encode())
        except ValueError as error:
            return str(error)
    return [each.tolist() for each in (found.vertices, found.corners, found.sizes)], found.passed


@given(RUNS, st.booleans())
def test_runs_hold_what_their_lines_hold(runs: list[tuple[str, int]], ended: bool) -> None:
    lines = ["v 0 0 0", "v 1 0 0", "v 1 0 1", "v 0 0 1"]
    lines += [line for line, times in runs for _ in range(times)]
    text = "\n".join(lines) + ended * "\n"
    assert outcome(text, 2) == outcome(text, 2**30)


def test_a_fault_after_many_lines_is_named_with_its_own() -> None:
    vertices = "".join(f"v {n % 7} {n / 3:.4f} -1e-3\n" for n in range(60_000))
    faces = "".join(f"f {n + 1}/1 {n + 2}/1 {n + 3}/1\n" for n in range(50_000))
    found = read_obj((vertices + faces).encode())
    np.testing.assert_allclose(found.vertices[-1], [59_999 % 7, 59_999 / 3, -1e-3], atol=1e-4)
    assert found.corners.reshape(-1, 3)[-1].tolist() == [49_999, 50_000, 50_001]
    for wrong in ("f 1 2 60001", "v 1 2", "f 1 two 3"):
        with pytest.raises(ValueError, match=r"^line 110001: "):
            read_obj((vertices + faces + wrong + "\n").encode())
