"""Stages of a load test: read, refused, and when each bot comes and goes."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.bots.stages import Stage, Stay, read_stages, stays

stages = st.lists(
    st.builds(Stage, st.floats(0.5, 100.0), st.integers(0, 40)), min_size=1, max_size=6
).map(tuple)


def test_stages_are_read_as_people_write_them() -> None:
    assert read_stages("30s:100, 1.5m:500,500ms:20,1h:0") == (
        (30.0, 100),
        (90.0, 500),
        (0.5, 20),
        (3600.0, 0),
    )


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("", "'' is no stage, expected TIME:BOTS like 30s:100"),
        ("30:100", "'30:100' is no stage"),
        ("30s:100,", "'' is no stage"),
        ("-3s:1", "'-3s:1' is no stage"),
        ("3s:1.5", "'3s:1.5' is no stage"),
        ("30s:0", "no stage has any bots"),
        ("1s:10001", "there may be 10000 bots at once, not 10001"),
        (",".join(["1s:1"] * 101), "there may be 100 stages, not 101"),
        ("300h:1", "all stages together last 1.08e[+]06 s"),
        ("0s:3", "all stages together last 0 s"),
    ],
)
def test_what_means_no_stages_is_told(text: str, fault: str) -> None:
    with pytest.raises(ValueError, match=fault):
        read_stages(text)


def test_bots_come_evenly_and_the_last_goes_first() -> None:
    plan = read_stages("10s:10,5s:10,20s:0")
    assert stays(plan, 0) == [Stay(1.0, 33.0)]
    assert stays(plan, 9) == [Stay(10.0, 15.0)]
    assert stays(plan, 10) == []


def test_a_bot_comes_again_when_it_is_wanted_again() -> None:
    plan = read_stages("2s:2,2s:0,2s:1,1s:1")
    assert stays(plan, 0) == [Stay(1.0, 3.0), Stay(6.0, 7.0)]
    assert stays(plan, 1) == [Stay(2.0, 2.0)]


def test_a_stage_without_a_time_is_a_jump() -> None:
    assert stays(read_stages("0s:5,3s:5"), 4) == [Stay(0.0, 3.0)]


@given(stages)
def test_as_many_are_there_as_the_stage_ends_with(plan: tuple[Stage, ...]) -> None:
    ends = [sum(stage.duration_s for stage in plan[: place + 1]) for place in range(len(plan))]
    every = [stays(plan, index) for index in range(41)]
    for end_s, stage in zip(ends[:-1], plan[:-1], strict=True):
        here = sum(any(s.begin_s <= end_s + 1e-9 < s.end_s + 2e-9 for s in each) for each in every)
        assert abs(here - stage.bots) <= 1
    for each in every:
        assert all(stay.begin_s <= stay.end_s <= ends[-1] + 1e-9 for stay in each)
        assert each == sorted(each)
