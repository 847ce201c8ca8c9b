"""Rows come into the order of people and times, in pieces as all at once."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.recordings import RecordingError, ordering, rows
from esplanade.recordings.ordering import in_order
from esplanade.recordings.rows import Rows, numbered_people

SAMPLES = st.lists(st.tuples(st.integers(0, 6), st.integers(0, 40)), min_size=1, max_size=40)


def rows_of(samples: list[tuple[int, int]], *, together: bool) -> Rows:
    ids, who = numbered_people(np.array([10 * person for person, _ in samples], np.int32))
    places = np.array([[100.0 * person + t, 0.5 * t] for person, t in samples])
    x, y = (places[:, 0], places[:, 1]) if together else places.T.copy()
    return Rows(
        format="table",
        lines=np.arange(2, len(samples) + 2, dtype=np.int32),
        ids=ids,
        who=who,
        clock=np.array([0.4 * t for _, t in samples]),
        x=x,
        y=y,
    )


@pytest.fixture(autouse=True, scope="module")
def _small_pieces() -> object:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ordering, "_PIECE", 5)
        patch.setattr(rows, "_PIECE", 5)
        yield


@given(SAMPLES, st.booleans(), st.sampled_from(["as it comes", "by time", "by person"]))
def test_samples_are_sorted_and_repeats_left_out(
    samples: list[tuple[int, int]], together: bool, order: str
) -> None:
    if order == "by time":
        samples = sorted(samples, key=lambda sample: sample[1])
    elif order == "by person":
        samples = sorted(samples)
    found, repeats = in_order(Path("a"), rows_of(samples, together=together))
    people = list(dict.fromkeys(person for person, _ in samples))
    wanted = sorted(set(samples), key=lambda sample: (people.index(sample[0]), sample[1]))
    assert repeats == len(samples) - len(wanted)
    assert list(found.ids) == [str(10 * person) for person in people]
    assert [people[who] for who in found.who] == [person for person, _ in wanted]
    np.testing.assert_array_equal(found.clock, [0.4 * t for _, t in wanted])
    np.testing.assert_array_equal(found.x, [100.0 * person + t for person, t in wanted])
    np.testing.assert_array_equal(found.y, [0.5 * t for _, t in wanted])
    assert [samples[line - 2] for line in found.lines] == wanted


def test_somebody_at_two_places_is_named_with_both_lines() -> None:
    twice = rows_of([(1, 0), (2, 0), (1, 1), (2, 1), (1, 1)], together=True)
    twice.x[4] += 1.0
    with pytest.raises(RecordingError, match=r"a:6: .* is already at t=0\.4 in line 4"):
        in_order(Path("a"), twice)


@pytest.mark.parametrize("first", [0, -7, 5_000_000_000, 10**12, 2**52])
def test_ids_of_any_size_are_told_apart(first: int) -> None:
    marks = np.array([first + 3, first, first + 3, first + 9, first, first + 1, first], np.float64)
    ids, who = numbered_people(marks)
    assert ids == [str(first + more) for more in (3, 0, 9, 1)]
    assert who.tolist() == [0, 1, 0, 2, 1, 3, 1]
