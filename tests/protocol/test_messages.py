"""The values that a message may hold."""

import math
from typing import Any

import pytest
from pydantic import ValidationError

from esplanade.protocol.messages import (
    ChatLine,
    FromClient,
    Hello,
    Move,
    Ping,
    Pong,
    SetDoor,
    WalkTo,
    Watch,
)


@pytest.mark.parametrize(
    ("model", "fields", "where"),
    [
        (Hello, {"name": "", "version": 1}, "name"),
        (Hello, {"name": "   ", "version": 1}, "name"),
        (Hello, {"name": "x" * 33, "version": 1}, "name"),
        (Hello, {"name": 5, "version": 1}, "name"),
        (Hello, {"name": b"Ann", "version": 1}, "name"),
        (Hello, {"name": "Ann"}, "version"),
        (Hello, {"name": "Ann", "version": "1"}, "version"),
        (Hello, {"name": "Ann", "version": True}, "version"),
        (Hello, {"name": "Ann", "version": 1, "resume": "x" * 65}, "resume"),
        (Hello, {"name": "Ann", "version": 1, "at": [1.0, 2.0]}, "at"),
        (Hello, {"name": "Ann", "version": 1, "at": [1.0, math.nan, 0]}, "at"),
        (Hello, {"name": "Ann", "version": 1, "at": [1.0, 2.0, 1e6]}, "at"),
        (Hello, {"name": "Ann", "version": 1, "operator": "x" * 65}, "operator"),
        (Hello, {"name": "Ann", "version": 1, "admin": True}, "admin"),
        (Move, {"seq": -1, "direction": 0.0, "speed": 1.0}, "seq"),
        (Move, {"seq": 2**32, "direction": 0.0, "speed": 1.0}, "seq"),
        (Move, {"seq": 1.0, "direction": 0.0, "speed": 1.0}, "seq"),
        (Move, {"seq": 1, "direction": math.inf, "speed": 1.0}, "direction"),
        (Move, {"seq": 1, "direction": 0.0, "speed": math.nan}, "speed"),
        (Move, {"seq": 1, "direction": 0.0, "speed": -1.0}, "speed"),
        (Move, {"seq": 1, "direction": 0.0, "speed": "fast"}, "speed"),
        (WalkTo, {"seq": 1, "x": 1e6, "y": 0.0}, "x"),
        (WalkTo, {"seq": 1, "x": 0.0, "y": 0.0, "z": math.nan}, "z"),
        (ChatLine, {"text": "x" * 301}, "text"),
        (ChatLine, {"text": "\n\t "}, "text"),
        (Ping, {"nonce": None}, "nonce"),
        (Watch, {}, "id"),
        (SetDoor, {"name": "", "open": True}, "name"),
        (SetDoor, {"name": "gate", "open": 1}, "open"),
    ],
)
def test_what_breaks_a_rule_is_refused(
    model: type[FromClient], fields: dict[str, Any], where: str
) -> None:
    with pytest.raises(ValidationError) as caught:
        model.model_validate(fields)
    assert caught.value.errors()[0]["loc"][0] == where


@pytest.mark.parametrize(
    "text", ["a\nb", "a\x00b", "a\x1b[31m", "a\u202eb", "a\u2028b", "\u200b", "\u3164"]
)
def test_texts_for_others_are_one_visible_line(text: str) -> None:
    with pytest.raises(ValidationError, match=r"visible|not allowed"):
        ChatLine(text=text)
    with pytest.raises(ValidationError, match=r"visible|not allowed"):
        Hello(name=text, version=1)


@pytest.mark.parametrize("name", ["Ann", "Ann Lee", "李雷", "Zoë", "👩‍🚀", "שרה"])
def test_names_of_all_the_world_are_welcome(name: str) -> None:
    assert Hello(name=f"  {name} ", version=1).name == name


def test_whole_numbers_are_numbers() -> None:
    """An encoder of another language may write 2.0 as 2."""
    assert Move.model_validate({"seq": 1, "direction": 2, "speed": 1}).speed == 1.0


def test_unknown_fields_of_the_server_are_passed_over() -> None:
    assert Pong.model_validate({"nonce": 1, "server_time": 2.0, "mood": "good"}).nonce == 1
