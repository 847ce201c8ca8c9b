"""Names that people give themselves."""

import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.protocol.codes import MAX_NAME_CHARS
from esplanade.protocol.names import MAX_ACCENTS, MAX_MARKS, plain_name

TRICKS = st.sampled_from(
    "aA\u0301\u0300\u0323\u200b\u200c\u200d\u2060\ufeff\u00ad\u034f\u115f\u1160\u3164\uffa0"
    "\u2800\u180e\u061c\u202e\u2066\ufe0f\ufb01\ufdfa\u00a8\u3000\u00a0\u1680\u0085\u2028"
    "\U000e0041\U0001f469\U0001f680\U0001f3fd\ud800\ue000\u0e47\u17b4ｎ "
)
TEXTS = st.text(st.one_of(st.characters(), TRICKS), max_size=MAX_NAME_CHARS)


def accepted(text: str) -> str | None:
    try:
        return plain_name(text)
    except ValueError:
        return None


@given(TEXTS)
def test_a_name_that_is_accepted_is_visible_bounded_and_stays_as_it_is(text: str) -> None:
    name = accepted(text)
    if name is None:
        return
    assert plain_name(name) == name
    assert unicodedata.is_normalized("NFKC", name)
    assert 1 <= len(name) <= MAX_NAME_CHARS
    assert name == name.strip()
    assert "  " not in name
    for place, char in enumerate(name):
        if char == "\u200d":  # within an emoji
            assert unicodedata.category(name[place + 1]) in {"So", "Sk"}
            continue
        assert char == " " or unicodedata.category(char)[0] not in "CZ"
        assert char not in "\u115f\u1160\u3164\uffa0\u2800\u034f\u17b4\ufe0f"
    marks = [unicodedata.category(char)[0] == "M" for char in name]
    assert not any(all(marks[k : k + MAX_MARKS + 1]) for k in range(len(name) - MAX_MARKS))
    assert not marks[0]


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("  Ann  ", "Ann"),
        ("Ann\u00a0\u3000Lee", "Ann Lee"),
        ("Ａｎｎ", "Ann"),
        ("Zoe\u0308", "Zoë"),
        ("ﬁnn", "finn"),
        ("❤️", "❤"),
        ("李雷", "李雷"),
        ("שרה", "שרה"),
        ("Nguyễn Thị Việt", "Nguyễn Thị Việt"),
        ("ကြွေး", "ကြွေး"),
        ("น้ำผึ้ง", unicodedata.normalize("NFKC", "น้ำผึ้ง")),
        ("👩‍🚀", "👩‍🚀"),
        ("👩🏽‍🚀", "👩🏽‍🚀"),
    ],
)
def test_a_name_has_one_way_of_writing(text: str, name: str) -> None:
    assert plain_name(text) == name


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("", "at least one visible"),
        ("   ", "at least one visible"),
        ("\u3000\u00a0", "at least one visible"),
        ("\ufe0f", "at least one visible"),
        ("\u3164", r"U\+3164 is not allowed in a name: it is an invisible"),
        ("\u2800", r"U\+2800 is not allowed in a name: it is an invisible"),
        ("A\u115fB", r"U\+115F is not allowed in a name: it is an invisible"),
        ("A\u200bnn", r"U\+200B is not allowed in a name: it is an invisible"),
        ("A\u200dnn", r"U\+200D is not allowed in a name: it is an invisible"),
        ("\u200dAnn", r"U\+200D is not allowed in a name: it is an invisible"),
        ("👩\u200d", r"U\+200D is not allowed in a name: it is an invisible"),
        ("\u202eAnn", r"U\+202E is not allowed in a name: it is an invisible"),
        ("A\u2066nn", r"U\+2066 is not allowed in a name: it is an invisible"),
        ("\U000e0041", r"U\+E0041 is not allowed in a name: it is an invisible"),
        ("A\nB", r"U\+000A is not allowed in a name: it is a control"),
        ("A\u2028B", r"U\+2028 is not allowed in a name: it is a line"),
        ("\ue000", r"U\+E000 is not allowed in a name: it is a private"),
        ("\ud800", r"U\+D800 is not allowed in a name: it is half"),
        ("\u0301", "without a letter"),
        ("A \u0301", "without a letter"),
        ("A" + 31 * "\u0301", "accents"),
        ("A" + (MAX_ACCENTS + 2) * "\u0301", "accents"),
        ("ก" + (MAX_MARKS + 1) * "\u0e47", "marks in a row"),
        ("x" * 33, "at most 32"),
        ("\ufdfa" * 2, "at most 32"),
    ],
)
def test_what_is_refused_is_refused_by_name(text: str, complaint: str) -> None:
    with pytest.raises(ValueError, match=complaint):
        plain_name(text)
