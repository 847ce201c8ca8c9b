"""Looks: parts that do not exist are refused by name, and passed over where others tell of them."""

import msgpack
import pytest

from esplanade.protocol import ErrorCode, ProtocolError, decode_client, encode
from esplanade.protocol.codes import Kind
from esplanade.protocol.entities import Entity, pack_constants, pack_entity
from esplanade.protocol.looks import (
    MOST,
    NO_LOOK,
    SHORTEST_CM,
    Look,
    checked_look,
    known_look,
    parts_of,
)
from esplanade.protocol.messages import ChooseLook, Hello


@pytest.mark.parametrize(
    "look",
    [NO_LOOK, MOST._replace(sign=0), Look(stature_cm=SHORTEST_CM), Look(1, 2, 3, 4, 5, 171)],
)
def test_a_look_comes_through(look: Look) -> None:
    for message in (ChooseLook(look=look), Hello(name="Ann", version=6, look=look)):
        assert decode_client(encode(message)) == message
    assert known_look(list(look)) == look


@pytest.mark.parametrize(
    ("look", "fault"),
    [
        ([13, 0, 0, 0, 0, 0], "shirt is 13; it can be 0 or 1 to 12"),
        ([0, -1, 0, 0, 0, 0], "trousers is -1; it can be 0 or 1 to 8"),
        ([0, 0, 6, 0, 0, 0], "hair is 6; it can be 0 or 1 to 5"),
        ([0, 0, 0, True, 0, 0], "hair_colour is True, and no whole number"),
        ([0, 0, 0, 0, 1.5, 0], "skin is 1.5, and no whole number"),
        ([0, 0, 0, 0, 0, 149], "stature_cm is 149; it can be 0 or 150 to 200"),
        ([0, 0, 0, 0, 0, "x" * 500], "stature_cm is 'xxxxxxxxxxxxxxxxxxx, and no whole number"),
        ([1, 2, 3], "a look is the array [shirt, trousers, hair, hair_colour, skin, stature_cm]"),
        ("red", "a look is the array [shirt, trousers, hair, hair_colour, skin, stature_cm]"),
    ],
)
def test_a_part_that_does_not_exist_is_refused_by_its_name(look: object, fault: str) -> None:
    with pytest.raises(ValueError, match=r"is |look") as refused:
        checked_look(look)
    assert str(refused.value) == fault
    frame = msgpack.packb([int(ChooseLook.code), {"look": look}])
    with pytest.raises(ProtocolError) as error:
        decode_client(frame)
    assert error.value.code == ErrorCode.INVALID
    assert fault in error.value.text


def test_a_sign_is_told_and_cannot_be_chosen() -> None:
    guide = Look(shirt=3, sign=1)
    assert known_look(parts_of(guide)) == guide
    assert parts_of(Look(shirt=3)) == [3, 0, 0, 0, 0, 0]
    with pytest.raises(ValueError, match="a look is the array"):
        checked_look(parts_of(guide))


def test_parts_of_later_versions_are_passed_over() -> None:
    assert known_look([99, 2, 3, 4, 250, 260, 7, 7]) == Look(0, 2, 3, 4, 0, 0)
    assert known_look([5]) == Look(5)
    assert known_look(None) == NO_LOOK


def test_an_avatar_without_a_look_is_as_long_as_before_there_were_any() -> None:
    plain = Entity(7, Kind.PERSON, "Ann", 0.25, 0.88, 1.7)
    place = (0, (1.0, 2.0, 0.0), 0.0, None)
    told = pack_entity(pack_constants(plain), *place)
    assert b"look" not in told
    dressed = Entity(7, Kind.PERSON, "Ann", 0.25, 0.88, 1.7, Look(1, 2, 3, 4, 5, 171))
    assert len(pack_entity(pack_constants(dressed), *place)) == len(told) + 13
