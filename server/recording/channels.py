"""The channels of a recording and their schemas."""

from typing import Any, Final, NamedTuple

from esplanade.server.recording.container import CHECKPOINTS, COMMANDS, DIGESTS, EVENTS, INPUTS
from esplanade.server.world.recorded_inputs import schema as inputs_schema


class Channel(NamedTuple):
    """A channel: the name of its schema, how messages are encoded, and the schema, if any."""

    schema: str
    encoding: str
    described: dict[str, Any] | None


_TICK: Final = {"type": "integer", "description": "Number of the tick; time is tick x dt."}
_WHO: Final = {"type": ["integer", "string", "null"], "description": "Id of an avatar or actor."}


def channels() -> dict[str, Channel]:
    """All channels by their topics."""
    inputs = inputs_schema()
    defs = inputs.pop("$defs", {})
    return {
        INPUTS: Channel(
            "esplanade.Inputs",
            "json",
            {
                "type": "object",
                "description": "All inputs of the ticks of a second.",
                "properties": {
                    "tick": {**_TICK, "description": "Number of the first of these ticks."},
                    "inputs": {
                        "type": "array",
                        "description": "The inputs of each tick.",
                        "items": {"type": "array", "items": {"type": "object", **inputs}},
                    },
                    "checks": {
                        "type": "array",
                        "description": "A checksum of what each tick told of avatars.",
                        "items": {"type": "integer"},
                    },
                },
                "$defs": defs,
            },
        ),
        DIGESTS: Channel(
            "esplanade.Digests",
            "json",
            {
                "type": "object",
                "properties": {
                    "tick": _TICK,
                    "parts": {
                        "type": "object",
                        "description": "The digest of each part of the state after the tick.",
                        "additionalProperties": {"type": "string"},
                    },
                },
            },
        ),
        CHECKPOINTS: Channel("esplanade.ExactState", "msgpack", None),
        COMMANDS: Channel(
            "esplanade.Command",
            "json",
            {
                "type": "object",
                "properties": {
                    "tick": _TICK,
                    "number": {"type": "integer"},
                    "command": {"type": ["object", "null"]},
                    "fault": {"type": ["object", "null"]},
                },
            },
        ),
        EVENTS: Channel(
            "esplanade.Event",
            "json",
            {
                "type": "object",
                "properties": {
                    "tick": _TICK,
                    "kind": {"type": "string"},
                    "text": {"type": "string"},
                    "who": _WHO,
                    "other": _WHO,
                },
            },
        ),
    }
