"""Lines of chat: nothing invisible gets through, and no writing of the world is harmed."""

import unicodedata

import pytest
from hypothesis import given

from esplanade.protocol.codes import MAX_CHAT_CHARS
from esplanade.protocol.lines import plain_line
from esplanade.protocol.messages import ChatLine
from esplanade.protocol.visible import MAX_MARKS
from tests.protocol.test_names import TEXTS


def accepted(text: str) -> str | None:
    try:
        return plain_line(text)
    except ValueError:
        return None


@given(TEXTS)
def test_a_line_that_is_accepted_is_visible_bounded_and_stays_as_it_is(text: str) -> None:
    line = accepted(text)
    if line is None:
        return
    assert plain_line(line) == line == line.strip()
    assert any(char.isprintable() and not char.isspace() for char in line)
    assert not set(line) & set("\u115f\u1160\u3164\uffa0\u2800\u034f\u17b4\u200b\u2060\ufeff")
    marks = [unicodedata.category(char)[0] == "M" for char in line]
    assert not any(all(marks[k : k + MAX_MARKS + 1]) for k in range(len(line) - MAX_MARKS))


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("he\u3164llo", "hello"),
        ("\u115fhello\u1160 \u2800", "hello"),
        ("hel\u200b\u2060\ufefflo", "hello"),
        ("⠓⠊\u2800⠞⠓⠑⠗⠑", "⠓⠊ ⠞⠓⠑⠗⠑"),
        ("x" + "\u0301" * 31 + "y", "x" + "\u0301" * MAX_MARKS + "y"),
        ("x" + "\u0301\u200b" * 31 + "y", "x" + "\u0301" * MAX_MARKS + "y"),
        ("\u0301hello", "hello"),
        ("Zoe\u0308", "Zoë"),
        ("e\u200b\u0301", "é"),
    ],
)
def test_what_cannot_be_seen_is_taken_out(text: str, line: str) -> None:
    assert ChatLine(text=text).text == line


@pytest.mark.parametrize(
    "line",
    [
        "Hello there!",
        "Nguyễn Thị Việt",
        "שָׁלוֹם",
        "น้ำผึ้ง",
        "می\u200cخواهم",
        "क्\u200dष",
        "ශ්\u200dරී",
        "👩🏽\u200d🚀 ❤\ufe0f 1\ufe0f\u20e3",
        "李雷",
    ],
)
def test_the_writing_of_people_stays_as_it_is(line: str) -> None:
    normal = unicodedata.normalize("NFC", line)
    assert ChatLine(text=line).text == normal


@pytest.mark.parametrize(
    "text", ["\u3164", "\u2800 \u2800", "\u115f\u1160", "\u200b", "\u0301\u0301", "\u200d"]
)
def test_a_line_with_nothing_to_see_is_refused_by_name(text: str) -> None:
    with pytest.raises(ValueError, match="at least one visible character"):
        ChatLine(text=text)


def test_a_line_that_grows_too_long_is_refused() -> None:
    with pytest.raises(ValueError, match="at most 300 characters, this one 600"):
        ChatLine(text="\u0958" * MAX_CHAT_CHARS)
