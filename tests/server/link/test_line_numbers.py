"""Numbers of lines tell when each was said, and clients read them exactly."""

from hypothesis import given
from hypothesis import strategies as st

from esplanade.protocol.codes import MAX_LINE_NUMBER
from esplanade.server.link.line_numbers import LINES, TICKS, line_number, tick_of

PLACES = st.integers(0, 4094)
TICKS_OF = st.integers(0, TICKS - 1)
LINES_OF = st.integers(0, LINES - 1)


@given(place=PLACES, tick=TICKS_OF, line=LINES_OF)
def test_a_number_has_its_tick_and_is_exact_in_a_browser(place: int, tick: int, line: int) -> None:
    number = line_number(place, tick, line)
    assert tick_of(number) == tick
    assert 0 < number <= MAX_LINE_NUMBER
    assert int(float(number)) == number


@given(one=st.tuples(PLACES, TICKS_OF, LINES_OF), other=st.tuples(PLACES, TICKS_OF, LINES_OF))
def test_no_two_lines_have_one_number(
    one: tuple[int, int, int], other: tuple[int, int, int]
) -> None:
    assert (line_number(*one) == line_number(*other)) == (one == other)
    assert (line_number(*one) < line_number(*other)) == (one < other)
