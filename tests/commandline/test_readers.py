"""The words that an option accepts, and those that it refuses."""

import os
from argparse import ArgumentTypeError
from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import Field, TypeAdapter, ValidationError

from esplanade.commandline.readers import (
    Folder,
    InputFile,
    Moment,
    Number,
    OutputFile,
    Span,
    Whole,
)


@pytest.mark.parametrize(
    ("read", "text", "value"),
    [
        (Whole(1, 64), "64", 64),
        (Whole(1, 64), " 3 ", 3),
        (Whole(0, 64), "20.0", 20),
        (Whole(0, 2**32 - 1), "4294967295", 4294967295),
        (Whole(1), "123456789", 123456789),
        (Number(0.05, 1.0), "0.05", 0.05),
        (Number(0.0, 1.0, above=True), "1e-9", 1e-9),
    ],
)
def test_numbers_within_limits_are_read(
    read: Callable[[str], float], text: str, value: float
) -> None:
    assert read(text) == value
    assert type(read(text)) is type(value)


@pytest.mark.parametrize(
    ("read", "text", "fault"),
    [
        (Whole(1, 64), "65", "'65' is no whole number from 1 to 64"),
        (Whole(1, 64), "1.5", "'1.5' is no whole number from 1 to 64"),
        (Whole(1, 64), "many", "'many' is no whole number from 1 to 64"),
        (Whole(1), "0", "'0' is no whole number 1 or more"),
        (Whole(1), "inf", "'inf' is no whole number 1 or more"),
        (Number(0.05, 1.0), "nan", "'nan' is no number from 0.05 to 1"),
        (Number(0.0, 60.0, above=True), "0", "'0' is no number above 0 to 60"),
        (Number(0.0, 60.0), "", "'' is no number from 0 to 60"),
    ],
)
def test_other_numbers_are_refused_with_the_limits(
    read: Callable[[str], float], text: str, fault: str
) -> None:
    with pytest.raises(ArgumentTypeError) as caught:
        read(text)
    assert str(caught.value) == fault


@given(
    st.sampled_from([Whole(0, 9), Whole(3), Number(0.0, 2.5), Number(0.0, 2.5, above=True)]),
    st.one_of(
        st.integers(-3, 12).map(str),
        st.floats(-1.0, 4.0).map(str),
        st.sampled_from(["nan", "inf", "-inf", "x", "", "2.50", "-0.0"]),
    ),
)
def test_a_reader_allows_what_pydantic_allows_within_the_same_limits(
    read: Number, text: str
) -> None:
    """The command line reads by itself, so that pydantic need not be imported to refuse."""
    kind = int if isinstance(read, Whole) else float
    judge = TypeAdapter(Annotated[kind, Field(**read.limits, allow_inf_nan=False)])
    try:
        expected = judge.validate_python(text)
    except ValidationError:
        expected = None
    try:
        found = read(text)
    except ArgumentTypeError:
        found = None
    assert found == expected


def test_a_file_to_read_is_there(tmp_path: Path) -> None:
    file = tmp_path / "here.csv"
    file.touch()
    assert InputFile()(str(file)) == file
    for text, fault in (
        (str(tmp_path / "absent.csv"), "cannot be read: No such file"),
        (str(tmp_path), "cannot be read: this is a folder"),
        ("nul\0byte", "cannot be read: "),
    ):
        with pytest.raises(ArgumentTypeError, match=fault):
            InputFile()(text)


def test_a_pipe_is_read_by_nobody_but_the_command(tmp_path: Path) -> None:
    """To look into it would take what the command is to read."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    assert InputFile()(str(pipe)) == pipe


def test_a_file_to_write_has_a_folder(tmp_path: Path) -> None:
    assert OutputFile()(str(tmp_path / "new.json")) == tmp_path / "new.json"
    for read, text, fault in (
        (OutputFile(), str(tmp_path / "no" / "new.json"), "there is no folder"),
        (OutputFile(), str(tmp_path), "is a folder, not a file"),
        (OutputFile(".json"), str(tmp_path / "new.glb"), r"new.glb is no \.json file"),
    ):
        with pytest.raises(ArgumentTypeError, match=fault):
            read(text)


def test_a_folder_may_have_to_be_made(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.touch()
    assert Folder()(str(tmp_path / "a" / "b")) == tmp_path / "a" / "b"
    assert not (tmp_path / "a").exists()
    with pytest.raises(ArgumentTypeError, match="file is a file, not a folder"):
        Folder()(str(file / "in"))


@pytest.mark.parametrize(
    ("text", "seconds"),
    [("90s", 90.0), ("15m", 900.0), ("1h", 3600.0), ("30d", 30 * 86400.0), ("0s", 0.0)],
)
def test_spans_of_time_are_read(text: str, seconds: float) -> None:
    assert Span()(text) == seconds


@pytest.mark.parametrize("text", ["", "h", "1", "1.5h", "-1h", "1 h", "1w", "9999999d", "٣h"])
def test_what_is_no_span_of_time_is_refused(text: str) -> None:
    with pytest.raises(ArgumentTypeError, match="is no span of time such as 90s, 15m, 1h or 30d"):
        Span()(text)


@pytest.mark.parametrize(
    ("text", "seconds"),
    [("00:12:30", 750.0), ("12:30", 750.0), ("750.5", 750.5), ("1:00:00", 3600.0), ("0", 0.0)],
)
def test_moments_are_read(text: str, seconds: float) -> None:
    assert Moment()(text) == seconds


@pytest.mark.parametrize("text", ["", "noon", "-1", "1:", ":30", "1:2:3:4", "1e3", "nan", "٣"])
def test_what_is_no_moment_is_refused(text: str) -> None:
    with pytest.raises(ArgumentTypeError, match=r"is no moment such as 00:12:30, 12:30 or 750\.5"):
        Moment()(text)
