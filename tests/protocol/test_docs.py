"""`docs/protocol.md` says what the code does: tables, fields, limits, the worked example."""

import json
import re
from pathlib import Path
from types import UnionType
from typing import Any, get_args, get_origin

import numpy as np
import pytest
from pydantic import BaseModel
from pydantic_core import PydanticUndefined

from esplanade.protocol import (
    SERVED_VERSIONS,
    VERSION,
    ByeCode,
    ErrorCode,
    Kind,
    Outcome,
    Reason,
    decode_server,
    peek_snapshot,
)
from esplanade.protocol import codes as table
from esplanade.protocol.codec import MAX_BLOCK_BYTES, SNAPSHOT_HEAD_BYTES, STEPS_HEAD_BYTES
from esplanade.protocol.codes import ClientCode, CloseCode, ServerCode
from esplanade.protocol.keys_between import FAR
from esplanade.protocol.looks import CHOSEN, MOST, SHORTEST_CM, Look
from esplanade.protocol.messages import (
    Blocker,
    Circle,
    Entity,
    FromClient,
    FromServer,
    Plan,
    Snapshot,
    StepBlock,
    Tour,
)
from esplanade.protocol.snapshot import (
    MAX_EXTENT_M,
    RECORD,
    Floats,
    headings_rad,
    heights_m,
    positions_m,
    speeds_mps,
    unpack_block,
)
from esplanade.protocol.steps import (
    DIFFERENCES,
    END,
    FOOTPRINT,
    LANDING,
    STEP,
    WALKING,
    step_records,
    unpack_steps,
)

TEXT = (Path(__file__).resolve().parents[2] / "docs" / "protocol.md").read_text(encoding="utf-8")

Row = dict[str, str]


def section(title: str) -> str:
    """Text below a heading, up to the next of any level."""
    found = re.search(rf"^#+ {re.escape(title)}\n(.*?)(?=^#+ |\Z)", TEXT, re.MULTILINE | re.DOTALL)
    assert found is not None, f"no section {title!r}"
    return found[1]


def tables(text: str) -> list[list[Row]]:
    """All tables of a text, as rows by the names of their columns."""
    found = []
    for block in re.findall(r"((?:^\|.*\n)+)", text, re.MULTILINE):
        lines = [
            [cell.strip().replace("`", "") for cell in line.strip().strip("|").split(" | ")]
            for line in block.replace("| |", "|  |").splitlines()
        ]
        lines = [[cell.strip(" |") for cell in line] for line in lines]
        head, _, *rows = lines
        found.append([dict(zip(head, row, strict=False)) for row in rows])
    return found


def wire_name(model: type[FromClient | FromServer]) -> str:
    return model.code.name.lower()


def heading_of(model: type[FromClient | FromServer]) -> str:
    """Both sides have a message `chat`; the server's heading says so."""
    both = {code.name for code in ClientCode} & {code.name for code in ServerCode}
    server = issubclass(model, FromServer) and model.code.name in both
    return wire_name(model) + (" (from the server)" if server else "")


MODELS = [*FromClient.__subclasses__(), *FromServer.__subclasses__()]


def test_the_table_of_messages_is_the_codes() -> None:
    (rows,) = tables(section("Messages"))
    documented = [(int(row["Code"]), row["Name"], row["From"]) for row in rows]
    assert documented == [
        *((code.value, code.name.lower(), "client") for code in ClientCode),
        *((code.value, code.name.lower(), "server") for code in ServerCode),
    ]


@pytest.mark.parametrize("model", MODELS, ids=heading_of)
def test_every_field_is_documented_with_its_type(model: type[FromClient | FromServer]) -> None:
    rows = tables(section(heading_of(model)))[0]
    assert [row["Field"] for row in rows] == list(model.model_fields)
    for row in rows:
        field = model.model_fields[row["Field"]]
        assert row["Type"] == documented_type(field.annotation), row["Field"]
        if issubclass(model, FromClient):
            default = "" if field.default is PydanticUndefined else json.dumps(field.default)
            assert row["Default"] == default, row["Field"]


@pytest.mark.parametrize(
    ("title", "place", "model"),
    [("enter", 1, Entity), ("plan", 1, Circle), ("plan", 2, Blocker), ("plan", 3, Tour)],
)
def test_every_field_of_a_part_is_documented(
    title: str, place: int, model: type[BaseModel]
) -> None:
    rows = tables(section(title))[place]
    assert [row["Field"] for row in rows] == list(model.model_fields)
    for row in rows:
        assert row["Type"] == documented_type(model.model_fields[row["Field"]].annotation)


def documented_type(kind: Any) -> str:
    """The document's name for a field's type."""
    names = {int: "integer", float: "number", str: "text", bool: "boolean", bytes: "binary"}
    if kind in names:
        return names[kind]
    origin, inner = get_origin(kind), get_args(kind)
    if origin is UnionType or str(origin) == "typing.Union":
        return " or ".join(dict.fromkeys(documented_type(part) for part in inner))
    if kind is type(None):
        return "null"
    if str(origin) == "<class 'typing.Annotated'>" or hasattr(kind, "__metadata__"):
        return documented_type(inner[0])
    if origin is tuple:
        return "[" + ", ".join(documented_type(part) for part in inner) + "]"
    if origin is list:
        part = documented_type(inner[0])
        return "list of " + (part if part.startswith("[") else re.sub(r"^(\w+)", r"\1s", part))
    if origin is dict or (isinstance(kind, type) and issubclass(kind, BaseModel)):
        return "map"
    if kind is Look:
        return "array of integers"
    if isinstance(kind, type) and issubclass(kind, int):
        return "integer"
    return "text"


def test_reasons_errors_and_close_codes() -> None:
    (reasons,) = tables(section("Reasons"))
    assert [(int(row["Value"]), row["Name"]) for row in reasons] == [
        (reason.value, reason.name.lower()) for reason in Reason
    ]
    (outcomes,) = tables(section("Outcomes"))
    assert [(int(row["Value"]), row["Name"]) for row in outcomes] == [
        (outcome.value, outcome.name.lower()) for outcome in Outcome
    ]
    errors, closes = tables(section("Errors"))
    assert {row["error"] for row in errors} == {code.value for code in ErrorCode}
    for row in errors:
        close = CloseCode.__members__.get(row["error"].upper())
        assert row["Close code"] == ("" if close is None else str(close.value)), row
    assert [(int(row["Close code"]), row["Name"]) for row in closes] == [
        (code.value, code.name.lower()) for code in CloseCode
    ]


def test_the_parts_of_a_look() -> None:
    (parts,) = tables(section("Looks"))
    assert [(int(row["Place"]), row["Name"]) for row in parts] == list(enumerate(Look._fields))
    ranges = [f"0 to {most}" for most in MOST]
    ranges[CHOSEN.index("stature_cm")] = f"0, or {SHORTEST_CM} to {MOST.stature_cm}"
    assert [row["Range"] for row in parts] == ranges


def test_names_in_running_text() -> None:
    for reason in ByeCode:
        assert f"`{reason.value}`:" in section("bye")
    for kind in Kind:
        assert f"`{kind.value}`" in section("enter")
    behaviours, _ = get_args(Plan.model_fields["behaviour"].annotation)
    for behaviour in get_args(behaviours):
        assert f"`{behaviour}`" in section("plan")
    assert f"# The protocol, version {VERSION}\n" in TEXT


def test_limits() -> None:
    fixed = {row["What"]: row["Limit"] for row in tables(section("Limits"))[0]}
    assert fixed == {
        "A frame from a client": f"{table.MAX_CLIENT_FRAME_BYTES} bytes",
        "Name": f"{table.MAX_NAME_CHARS} characters",
        "Line of chat": f"{table.MAX_CHAT_CHARS} characters",
        "Resume token, operator key": f"{table.MAX_TOKEN_CHARS} characters",
        "Secret of an admission": f"{table.MAX_SECRET_CHARS} characters",
        "Name of a door": f"{table.MAX_DOOR_CHARS} characters",
        "A block of a snapshot or of steps": f"{MAX_BLOCK_BYTES} bytes",
        "Extent of a zone": f"{MAX_EXTENT_M:g} m",
    }


def test_the_servers_defaults() -> None:
    settings = pytest.importorskip("esplanade.server.settings").ServerSettings
    for row in tables(section("Limits"))[1]:
        assert float(row["Default"]) == settings.model_fields[row["Setting"]].default, row


@pytest.mark.parametrize(
    ("title", "place", "record"),
    [
        ("Snapshots", 1, RECORD),
        ("Layout of steps", 1, STEP),
        ("Layout of steps", 2, FOOTPRINT),
        ("Layout of steps", 3, LANDING),
        ("Layout of steps", 4, END),
        ("Layout of steps", 5, DIFFERENCES),
    ],
)
def test_the_layout_of_a_record(title: str, place: int, record: np.dtype[np.void]) -> None:
    layout = tables(section(title))[place]
    assert record.names is not None
    assert record.fields is not None
    assert [(int(row["Offset"]), int(row["Bytes"]), row["Field"]) for row in layout] == [
        (record.fields[name][1], record.fields[name][0].itemsize, name) for name in record.names
    ]


def test_versions() -> None:
    text = " ".join(section("Versions").split())
    *older, newest = map(str, SERVED_VERSIONS)
    served = f"{', '.join(older)} and {newest}"
    assert f"here {VERSION}." in text
    assert f"This server serves version {served}." in text
    # From version 4 on the server serves the version before its own, too.
    assert set(SERVED_VERSIONS) >= {max(4, VERSION - 1), VERSION}


def test_lengths_in_running_text() -> None:
    assert f"f is {', '.join(map(str, FAR))} for keys 1 to 4" in section("Layout of steps")
    assert f"Kind {WALKING}, a walking step, has {STEP.itemsize} bytes" in section(
        "Layout of steps"
    )
    assert f"same {STEPS_HEAD_BYTES} bytes" in section("Layout of steps")
    assert f"{RECORD.itemsize} bytes each" in section("Snapshots")
    assert f"same {SNAPSHOT_HEAD_BYTES} bytes" in section("Snapshots")


def example_of(text: str) -> bytes:
    """The frame that a section works through."""
    (example,) = re.findall(r"^```hex\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    frame = bytes.fromhex(example.replace("\n", " "))
    assert f"frame of {len(frame)} bytes" in text
    return frame


def test_the_worked_example_of_a_snapshot() -> None:
    text = section("Snapshots")
    frame = example_of(text)
    snapshot = decode_server(frame)
    assert isinstance(snapshot, Snapshot)
    assert peek_snapshot(frame) == (snapshot.tick, snapshot.ack) == (402, 7)
    assert "is tick 402" in text
    assert "ack 7" in text
    records = unpack_block(snapshot.block)
    positions = positions_m(records, (-10.0, -5.0))
    turns, speeds = headings_rad(records) / 6.283185307179586, speeds_mps(records)
    heights = heights_m(records)
    shown = [
        [
            *(str(records[name][row]) for name in ("id", "layer", "reason")),
            *(f"{value:.2f}" for value in (*positions[row], heights[row], turns[row], speeds[row])),
        ]
        for row in range(len(records))
    ]
    assert shown == [list(row.values()) for row in tables(text)[2]]


def numbers(values: Floats, digits: int = 2) -> str:
    return ", ".join(f"{value:.{digits}f}" for value in np.atleast_1d(values))


def test_the_worked_example_of_steps() -> None:
    text = section("Layout of steps")
    message = decode_server(example_of(text))
    assert isinstance(message, StepBlock)
    assert message.tick == 402
    steps = unpack_steps(step_records(message.block))
    assert (steps.ids, steps.begin_ticks, steps.durations_ticks) == (12, 402, 11)
    assert not steps.on_right
    told = " ".join(text.split())
    for footprints in (steps.standing, steps.landing):
        assert f"({numbers(footprints.positions_m[0])})" in told
    assert f"{np.degrees(steps.landing.headings_rad[0]):.1f}°" in told
    assert f"for {steps.lifts[0]:.2f} of the step" in told
    for row in tables(text)[6]:
        key = int(row["Key"])
        shown = {
            "root": numbers(steps.keys.roots_m[0, key]),
            "pelvis": numbers(steps.keys.pelvises[0, key], 3),
            "ankle": numbers(steps.keys.ankles_m[0, key]),
            "swing pitch": numbers(steps.keys.swing_pitches_rad[0, key]),
            "standing pitch": numbers(steps.keys.standing_pitches_rad[0, key]),
            "swing heading": numbers(steps.keys.swing_headings_rad[0, key]),
            "chest": numbers(steps.keys.chests[0, key], 3),
            "arms": numbers(steps.keys.arms_rad[0, key]),
        }
        assert row == {"Key": str(key), **shown}
