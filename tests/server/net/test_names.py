"""Names in one world: no two look alike."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.protocol.codes import MAX_NAME_CHARS
from esplanade.protocol.names import plain_name
from esplanade.server.net.names import Names, ReservedNameError, skeleton


@pytest.mark.parametrize("text", ["Аlder", "AIder", "A1der", "ALDER", "αlder", "Ꭺlder", "𝓐lder"])
def test_a_name_that_looks_like_an_actors_is_told_apart(text: str) -> None:
    names = Names(["Alder", "Elm"])
    assert names.take(plain_name(text)) == f"{plain_name(text)} 2"
    assert names.take("Elrn") == "Elrn 2"
    assert names.take("Oak") == "Oak"


@pytest.mark.parametrize(
    "text",
    ["server", "SERVER", "Operator", "admin", "ѕеrvеr", "аdmіn", "0perator", "sYstem", "[server]",
     "Admin 2", "s-e-r-v-e-r", "system.", "ｓｅｒｖｅｒ", "Adrnin", "Moderator"],
)  # fmt: skip
def test_names_of_the_world_itself_are_refused(text: str) -> None:
    with pytest.raises(ReservedNameError, match="kept for the world"):
        Names([]).take(plain_name(text))


@pytest.mark.parametrize("text", ["Serverin", "Sysy", "Minna", "Ada", "123", "!"])
def test_names_that_only_resemble_them_are_not(text: str) -> None:
    assert Names([]).take(text) == text


def test_people_of_one_name_are_numbered_and_numbers_come_back() -> None:
    names = Names(["Ann 3"])
    given = [names.take(text) for text in ("Ann", "ann", "ANN")]
    assert given == ["Ann", "ann 2", "ANN 4"]
    names.give_back("ann 2")
    assert names.take("Ann") == "Ann 2"
    for name in ("Ann", "Ann 2", "ANN 4"):
        names.give_back(name)
    assert names.take("aNN") == "aNN"


def test_a_long_name_is_cut_for_its_number() -> None:
    names = Names([])
    long = "x" * MAX_NAME_CHARS
    assert names.take(long) == long
    assert names.take(long) == "x" * (MAX_NAME_CHARS - 2) + " 2"
    assert names.take("x" * (MAX_NAME_CHARS - 2) + " 2") == "x" * (MAX_NAME_CHARS - 2) + " 3"


@given(st.lists(st.tuples(st.sampled_from(["Ann", "AПП", "Bob", "B0b", "Ann 2", "l", "1"]),
                          st.booleans()), max_size=60))  # fmt: skip
def test_no_two_who_are_there_look_alike(visits: list[tuple[str, bool]]) -> None:
    names = Names(["Bob 2"])
    there: list[str] = []
    for wished, leaves in visits:
        if leaves and there:
            names.give_back(there.pop(0))
        there.append(names.take(wished))
        skeletons = {skeleton(name) for name in [*there, "Bob 2"]}
        assert len(skeletons) == len(there) + 1
        assert all(len(name) <= MAX_NAME_CHARS for name in there)


def test_names_of_actors_can_be_reserved_later() -> None:
    names = Names()
    assert names.take("Elm") == "Elm"
    names.reserve(["Alder", "Elm"])
    names.give_back("Elm")
    assert names.take("alder") == "alder 2"
