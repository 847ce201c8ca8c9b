"""A zone goes on bit for bit in another process, whatever had happened to it before."""

import subprocess
import sys
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from esplanade.server.checkpoint.format import packed
from esplanade.server.world.recorded_inputs import recorded
from tests.server.populated import Populated
from tests.server.recording.goes_on import read, told, write
from tests.server.recording.happenings import MAKERS, OFTEN, Happening, hall, input_of

FEW = (Phase.explicit, Phase.reuse, Phase.generate)
"""Worlds are too dear to look for the smallest one that fails."""
TICKS_AFTER = 50

GoesOn = Callable[[bytes, list[list[dict[str, Any]]]], list[dict[str, str]]]


@pytest.fixture(scope="module")
def goes_on() -> Iterator[GoesOn]:
    """A zone that goes on from bytes, in one process for all of these tests."""
    with subprocess.Popen(
        [sys.executable, "-m", "tests.server.recording.goes_on"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    ) as other:
        assert other.stdin is not None
        assert other.stdout is not None

        def ask(state: bytes, ticks: list[list[dict[str, Any]]]) -> list[dict[str, str]]:
            assert other.stdin is not None
            assert other.stdout is not None
            write(other.stdin, [state, ticks])
            found: list[dict[str, str]] = read(other.stdout)
            return found

        yield ask
        other.stdin.close()
        assert other.wait(60) == 0


happenings = st.lists(
    st.builds(
        Happening,
        st.integers(0, 12),
        st.sampled_from([*MAKERS, *OFTEN]),
        st.integers(0, 11),
        st.floats(0.0, 1.0),
    ),
    min_size=4,
    max_size=16,
)


def lived(before: list[Happening]) -> tuple[Populated, bytes, int]:
    """A zone to which all that has happened, and its state after the first part."""
    world = hall()
    for number, happening in enumerate(before, start=1):
        world.frames(happening.ticks)
        world.frame(input_of(world, happening, number))
    state, saved_at = packed(world.zone.save_exactly()), len(world.inputs)
    return world, state, saved_at


@given(before=happenings, after=happenings)
@settings(max_examples=6, phases=FEW, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_a_zone_goes_on_bit_for_bit_in_another_process(
    goes_on: GoesOn, before: list[Happening], after: list[Happening]
) -> None:
    world, state, saved_at = lived(before)
    expected = [told(world)]
    for number, happening in enumerate(after, start=100):
        for _ in range(happening.ticks):
            world.frame()
            expected.append(told(world))
        world.frame(input_of(world, happening, number))
        expected.append(told(world))
    for _ in range(TICKS_AFTER):
        world.frame()
        expected.append(told(world))
    ticks = [[recorded(item) for item in given] for given in world.inputs[saved_at:]]
    world.population.close()
    found = goes_on(state, ticks)
    for tick, (one, other) in enumerate(zip(expected, found, strict=True)):
        differing = [part for part in one if one[part] != other[part]]
        assert not differing, (tick, differing)
