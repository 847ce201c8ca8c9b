"""Frames that must never change within a version: `golden.json` is for every implementation."""

import json
from pathlib import Path
from typing import Any

import pytest

from esplanade.protocol import decode_client, decode_server, encode, messages
from esplanade.protocol.messages import FromClient, FromServer

GOLDEN: list[dict[str, Any]] = json.loads(
    (Path(__file__).parents[2] / "protocol" / "golden.json").read_text(encoding="utf-8")
)


@pytest.mark.parametrize("row", GOLDEN, ids=[row["message"] for row in GOLDEN])
def test_frames(row: dict[str, Any]) -> None:
    model = getattr(messages, row["message"])
    fields = dict(row["fields"])
    if "block" in fields:
        fields["block"] = bytes.fromhex(fields["block"])
    message = model.model_validate(fields)
    decode = decode_client if row["from"] == "client" else decode_server
    assert encode(message).hex() == row["frame"]
    assert decode(bytes.fromhex(row["frame"])) == message


def test_every_message_has_its_frame() -> None:
    models = {model.__name__ for model in FromClient.__subclasses__()} | {
        model.__name__ for model in FromServer.__subclasses__()
    }
    assert {row["message"] for row in GOLDEN} == models
