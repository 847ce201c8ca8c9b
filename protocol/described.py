"""The protocol as an AsyncAPI document, made of the messages' models.

Frames are msgpack; what the document describes is the value that a frame holds, an array. Records
within the blocks of snapshots and steps are bytes there, and docs/protocol.md says what they hold.
"""

import ast
import inspect
from typing import Any, Final

from pydantic.json_schema import models_json_schema

from esplanade.protocol import messages
from esplanade.protocol.codec import CLIENT_MESSAGES, SERVER_MESSAGES
from esplanade.protocol.codes import VERSION
from esplanade.protocol.messages import FromClient, FromServer, Snapshot, StepBlock

ASYNCAPI: Final = "3.0.0"
"""The version of AsyncAPI, whose schemas are those of JSON Schema's draft 7."""
_REFERENCE: Final = "#/components/schemas/{model}"
_FLAT: Final[tuple[type[FromServer], ...]] = (Snapshot, StepBlock)
"""Messages whose fields stand in the frame itself, one after the other."""

_Schema = dict[str, Any]
_Model = type[FromClient] | type[FromServer]


def document() -> _Schema:
    """The whole document, as plain data."""
    client: list[_Model] = list(CLIENT_MESSAGES.values())
    server: list[_Model] = sorted(
        (*SERVER_MESSAGES.values(), *_FLAT), key=lambda model: int(model.code)
    )
    schemas = _schemas([*client, *server])
    described = {_name(model): _message(model) for model in (*client, *server)}
    for model in _FLAT:
        described[_name(model)] = _flat_message(model, schemas.pop(model.__name__))
    return {
        "asyncapi": ASYNCAPI,
        "info": {
            "title": "Esplanade",
            "version": str(VERSION),
            "description": (
                "What clients and a world say to each other. Each binary message of a WebSocket is "
                "one msgpack value, an array that begins with a code. Metres, seconds, radians."
            ),
        },
        "defaultContentType": "application/msgpack",
        "channels": {
            "world": {
                "address": "/ws",
                "messages": {name: {"$ref": f"#/components/messages/{name}"} for name in described},
                "bindings": {"ws": {"method": "GET", "bindingVersion": "0.1.0"}},
            }
        },
        "operations": {
            "hear": _operation("receive", "The world hears what a client says.", client),
            "tell": _operation("send", "The world tells its clients.", server),
        },
        "components": {"messages": described, "schemas": schemas},
    }


def _operation(action: str, summary: str, models: list[_Model]) -> _Schema:
    references = [{"$ref": f"#/channels/world/messages/{_name(model)}"} for model in models]
    return {
        "action": action,
        "channel": {"$ref": "#/channels/world"},
        "summary": summary,
        "messages": references,
    }


def _name(model: _Model) -> str:
    """The name of a message, which is that of its code; some codes have one in either direction."""
    side = "client" if issubclass(model, FromClient) else "server"
    return f"{side}_{model.code.name.lower()}"


def _summary(model: _Model) -> _Schema:
    return {"title": model.code.name.lower(), "summary": inspect.cleandoc(model.__doc__ or "")}


def _message(model: _Model) -> _Schema:
    fields = {"$ref": _REFERENCE.format(model=model.__name__)}
    return {**_summary(model), "payload": _array([{"const": int(model.code)}, fields])}


def _flat_message(model: type[FromServer], schema: _Schema) -> _Schema:
    fields = [schema["properties"][name] for name in model.model_fields]
    return {**_summary(model), "payload": _array([{"const": int(model.code)}, *fields])}


def _array(items: list[_Schema]) -> _Schema:
    return {"type": "array", "items": items, "minItems": len(items), "maxItems": len(items)}


def _schemas(models: list[_Model]) -> dict[str, _Schema]:
    """The schemas of all models and of what is in them, by name."""
    _, found = models_json_schema(
        [(model, "validation") for model in models], ref_template=_REFERENCE
    )
    told = _told_of_fields()
    schemas: dict[str, _Schema] = {}
    for name, schema in found["$defs"].items():
        for field, what in schema.get("properties", {}).items():
            what.pop("title", None)  # it only repeats the name of the field
            if (name, field) in told and "$ref" not in what:
                what["description"] = told[name, field]
        schemas[name] = _in_draft_7(schema)
    return schemas


def _in_draft_7(schema: Any) -> Any:
    """A schema of pydantic, which is one of a later draft, as one of draft 7."""
    if isinstance(schema, list):
        return [_in_draft_7(each) for each in schema]
    if not isinstance(schema, dict):
        return schema
    return {
        "items" if key == "prefixItems" else key: _in_draft_7(value)
        for key, value in schema.items()
    }


def _told_of_fields() -> dict[tuple[str, str], str]:
    """The sentences that stand below fields of the models, by model and field."""
    told: dict[tuple[str, str], str] = {}
    for model in ast.parse(inspect.getsource(messages)).body:
        if not isinstance(model, ast.ClassDef):
            continue
        for field, below in zip(model.body, model.body[1:], strict=False):
            if (
                isinstance(field, ast.AnnAssign)
                and isinstance(field.target, ast.Name)
                and isinstance(below, ast.Expr)
                and isinstance(below.value, ast.Constant)
            ):
                told[model.name, field.target.id] = inspect.cleandoc(str(below.value.value))
    return told
