"""The AsyncAPI document against the models that it is made of, and against real frames."""

import json
from pathlib import Path
from runpy import run_path
from typing import Any

import jsonschema_rs
import msgpack
import pytest

from esplanade.protocol import ProtocolError, decode_client, messages
from esplanade.protocol.messages import FromClient
from tests.protocol.test_golden import GOLDEN

ROOT = Path(__file__).parents[2]
FILE = ROOT / "protocol" / "asyncapi.json"
DOCUMENT: dict[str, Any] = json.loads(FILE.read_text(encoding="utf-8"))
CLIENT = [row for row in GOLDEN if row["from"] == "client"]


def name_of(row: dict[str, Any]) -> str:
    """The name of a golden frame's message in the document."""
    return f"{row['from']}_{getattr(messages, row['message']).code.name.lower()}"


def allows(name: str, value: Any) -> bool:
    """Whether the document has such a frame for a message; bytes are text in JSON."""
    payload = DOCUMENT["components"]["messages"][name]["payload"]
    schema = {"definitions": {"payload": payload}, "components": DOCUMENT["components"]}
    plain = [part.decode("latin-1") if isinstance(part, bytes) else part for part in value]
    checker = jsonschema_rs.Draft7Validator({**schema, "allOf": [payload]})
    return bool(checker.is_valid(plain))


def frame_of(row: dict[str, Any]) -> list[Any]:
    parts: list[Any] = msgpack.unpackb(bytes.fromhex(row["frame"]))
    return parts


def test_the_file_is_what_the_models_are() -> None:
    assert run_path(str(ROOT / "tools" / "write_asyncapi.py"))["text"]() == FILE.read_text("utf-8")


@pytest.mark.parametrize("row", GOLDEN, ids=[row["message"] for row in GOLDEN])
def test_every_golden_frame_is_allowed(row: dict[str, Any]) -> None:
    assert allows(name_of(row), frame_of(row))


def test_every_message_is_there_and_in_one_operation() -> None:
    described = DOCUMENT["components"]["messages"]
    assert described.keys() == {name_of(row) for row in GOLDEN}
    operations = DOCUMENT["operations"].values()
    told = [each["$ref"].rsplit("/", 1)[1] for one in operations for each in one["messages"]]
    assert sorted(told) == sorted(described)


@pytest.mark.parametrize("row", CLIENT, ids=[row["message"] for row in CLIENT])
def test_what_the_document_forbids_the_server_refuses(row: dict[str, Any]) -> None:
    code, fields = frame_of(row)
    model: type[FromClient] = getattr(messages, row["message"])
    required = [name for name, field in model.model_fields.items() if field.is_required()]
    wrong = [
        {**fields, "surely_not_a_field": 1},
        *({key: value for key, value in fields.items() if key != name} for name in required),
        *({**fields, name: {"a": "map"}} for name in fields),
    ]
    for each in wrong:
        assert not allows(name_of(row), [code, each])
        with pytest.raises(ProtocolError):
            decode_client(msgpack.packb([code, each]))


def test_fields_carry_their_sentences() -> None:
    hello = DOCUMENT["components"]["schemas"]["Hello"]["properties"]
    assert "operator's rights" in hello["operator"]["description"]
    assert "visible characters" in hello["name"]["description"]
