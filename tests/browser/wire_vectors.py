"""Frames with their meaning, for the web client's tests to read.

Write them anew with `python -m tests.browser.wire_vectors`.
"""

import json
from enum import Enum
from pathlib import Path
from typing import Any, Final

import numpy as np

from esplanade.protocol import (
    VERSION,
    ByeCode,
    ClientCode,
    CloseCode,
    ErrorCode,
    Gesture,
    Kind,
    NoticeCode,
    Outcome,
    Reason,
    ServerCode,
    encode,
    encode_snapshot,
    encode_steps,
)
from esplanade.protocol.codes import MAX_CHAT_CHARS, MAX_NAME_CHARS
from esplanade.protocol.looks import CHOSEN, MOST, SHORTEST_CM, Look
from esplanade.protocol.messages import (
    Admission,
    Away,
    Blocker,
    Bye,
    Census,
    Chat,
    ChatLine,
    ChooseLook,
    Circle,
    Doors,
    Enter,
    Entity,
    Error,
    FromClient,
    FromServer,
    GestureMade,
    Hello,
    Hide,
    Leave,
    MakeGesture,
    Move,
    MutePerson,
    Notice,
    Ping,
    Plan,
    Point,
    Pong,
    Presence,
    Report,
    Reshape,
    SetDoor,
    Travel,
    WalkTo,
    Watch,
    Welcome,
)
from esplanade.protocol.snapshot import pack_records
from esplanade.protocol.steps import Footprints, Steps, pack_steps, unpack_steps
from tests.protocol.steps import made_up_steps, mixed_block

FIXTURE: Final = Path(__file__).parents[2] / "client_web" / "tests" / "fixtures" / "wire.json"

ORIGIN: Final = (-12.5, 3.25)

FROM_CLIENT: Final[tuple[FromClient, ...]] = (
    Hello(name="Ann", version=VERSION, resume=None, at=None),
    Hello(name="Ann", version=VERSION, admission=Admission(way="invitation", secret="token")),
    Hello(name="Zoë ✿", version=VERSION, resume="token", at=None, operator="key"),
    Move(seq=1, direction=-2.5, speed=1.6),
    WalkTo(seq=4294967295, x=-3.25, y=40.5, z=3.5),
    WalkTo(seq=5, x=-3.25, y=40.5, z=3.5, strict=True),
    ChatLine(text="Good morning!"),
    Ping(nonce=70000),
    Watch(id=17),
    Watch(id=None),
    SetDoor(name="Gate", open=False),
    Report(id=9, line=1764440000123, text="is rude"),
    MutePerson(id=9, muted=True),
    Presence(away=True),
    MakeGesture(gesture=Gesture.CLAP),
    Hello(name="Ann", version=VERSION, look=Look(1, 2, 3, 4, 5, 171)),
    ChooseLook(look=Look(12, 0, 5, 8, 0, 200)),
)

FROM_SERVER: Final[tuple[FromServer, ...]] = (
    Welcome(
        version=VERSION,
        id=7,
        name="Ann",
        resume="token",
        resumed=False,
        scene={"name": "bare", "bounds": [0, 0, 10, 10], "polygons": [], "walls": [], "places": []},
        tick=1200,
        tick_rate=20,
        server_time=60.0,
        resume_seconds=30.0,
        radius=0.25,
        clearance=0.25,
        body_height=1.8,
        step_height=0.6,
        max_speed=2.5,
        walk_speed=1.4,
        origin=ORIGIN,
        doors={"Gate": True},
        operator=False,
    ),
    Enter(
        tick=1201,
        entities=[
            Entity(
                id=8,
                kind=Kind.ACTOR,
                name="A1",
                layer=1,
                x=1.5,
                y=-2.5,
                z=3.5,
                heading=0.5,
                radius=0.25,
                leg_m=0.875,
                stature_m=1.75,
                points_at=(4.5, -2.0, 1.25),
            )
        ],
    ),
    Leave(tick=1202, ids=[8, 9]),
    Chat(id=7, name="Ann", text="Hé!", line=1764440000123),
    Hide(lines=[1764440000123]),
    Notice(text="Welcome"),
    Notice(text="Paused", notice=NoticeCode.PAUSED, arguments={"rate": 0, "server_time": 61.25}),
    Notice(text="Softly", notice=NoticeCode.MUTED, arguments={"seconds": 600.0}),
    Notice(
        text="There is no floor at that place; you walk to the nearest one, 1.5 m from it.",
        notice=NoticeCode.GOAL_MOVED,
        arguments={"seq": 5, "moved": 1.5, "why": "no_ground", "x": -3.25, "y": 39.0, "z": 3.5},
    ),
    Error(error=ErrorCode.NO_PATH, text="no way leads there"),
    Bye(reason=ByeCode.SHUTDOWN, text="the server is shutting down"),
    Pong(nonce=70000, server_time=61.25),
    Plan(
        tick=1203,
        id=8,
        reason=Reason.GIVING_WAY,
        behaviour="wander",
        goal=(4.5, 5.5, 0.0),
        path=[(1.5, -2.5, 3.5, 0.0), (2.5, -1.5, 3.25, 1.25)],
        people=[[Circle(x=2.0, y=3.0, z=3.5, radius=0.75)]],
        since_s=1.5,
        blocker=Blocker(kind="person", id=7, away=0.25),
        outcome=Outcome.NEAR,
        in_the_way=Blocker(kind="actor", id=9),
    ),
    Census(people=3, actors=10),
    Doors(doors={"Gate": False}),
    Point(id=8, target=(4.5, -2.0, 1.25)),
    Point(id=8, target=None),
    Reshape(id=8, radius=0.3, leg_m=0.75, stature_m=1.5),
    Reshape(id=8, radius=0.3, leg_m=0.75, stature_m=1.5, look=Look(1, 2, 3, 4, 5, 150)),
    Travel(zone="hall", portal="to the yard"),
    Away(id=8, away=True),
    GestureMade(id=8, gesture=Gesture.WAVE),
)


def vectors() -> dict[str, Any]:
    """Everything that the fixture holds, as plain JSON values."""
    return {
        "version": VERSION,
        "limits": {"MAX_NAME_CHARS": MAX_NAME_CHARS, "MAX_CHAT_CHARS": MAX_CHAT_CHARS},
        "codes": {
            table.__name__: {member.name: member.value for member in table}
            for table in (ClientCode, ServerCode, Reason, Outcome, Gesture, CloseCode)
        },
        "looks": {"most": list(MOST[: len(CHOSEN)]), "shortest_cm": SHORTEST_CM},
        "kinds": _values(Kind),
        "client": [_vector(message) for message in FROM_CLIENT],
        "server": [_vector(message) for message in FROM_SERVER],
        "snapshot": _snapshot(),
        "steps": _steps(),
    }


def text() -> str:
    """The fixture as it is stored."""
    return json.dumps(vectors(), indent=1, ensure_ascii=False) + "\n"


def _values(table: type[Enum]) -> list[Any]:
    return [member.value for member in table]


def _vector(message: FromClient | FromServer) -> dict[str, Any]:
    return {
        "type": message.code.name.lower(),
        "fields": message.model_dump(mode="json"),
        "frame": encode(message).hex(),
    }


def _snapshot() -> dict[str, Any]:
    records = pack_records(
        ids=np.array([7, 4294967295]),
        layers=np.array([0, 3]),
        reasons=np.array([Reason.NONE, Reason.WAITING]),
        positions_m=np.array([[-12.5, 3.25], [10.01, 20.5]]),
        heights_m=np.array([-0.25, 3.5]),
        headings_rad=np.array([0.0, -np.pi / 2]),
        speeds_mps=np.array([0.0, 1.6]),
        origin_m=ORIGIN,
    )
    return {
        "tick": 4000000000,
        "ack": 12,
        "origin": ORIGIN,
        "frame": encode_snapshot(4000000000, 12, records.tobytes()).hex(),
        "records": [
            {
                "id": 7,
                "layer": 0,
                "reason": 0,
                "x": -12.5,
                "y": 3.25,
                "z": -0.25,
                "heading": 0.0,
                "speed": 0.0,
            },
            {
                "id": 4294967295,
                "layer": 3,
                "reason": 3,
                "x": 10.01,
                "y": 20.5,
                "z": 3.5,
                "heading": 1.5 * np.pi,
                "speed": 1.6,
            },
        ],
    }


def _steps() -> dict[str, Any]:
    records = pack_steps(made_up_steps(5))
    steps = unpack_steps(records)
    return {
        "tick": 4000000000,
        "frame": encode_steps(4000000000, records.tobytes()).hex(),
        "mixed": mixed_block(records).hex(),
        "records": [_step(steps, row) for row in range(len(records))],
    }


def _step(steps: Steps, row: int) -> dict[str, Any]:
    """A step as the client has it: the keys against their footprints, one flat list."""
    keys = steps.keys
    numbers = np.concatenate(
        [
            keys.roots_m[row] - steps.standing.positions_m[row],
            keys.pelvises[row],
            keys.ankles_m[row] - steps.landing.positions_m[row],
            keys.swing_pitches_rad[row, :, None],
            keys.standing_pitches_rad[row, :, None],
            keys.swing_headings_rad[row, :, None] - steps.landing.headings_rad[row],
            keys.chests[row],
            keys.arms_rad[row],
        ],
        axis=1,
    )
    return {
        "id": int(steps.ids[row]),
        "rightStands": bool(steps.on_right[row]),
        "continues": bool(steps.re_aimed[row]),
        "tick": int(steps.begin_ticks[row]),
        "ticks": int(steps.durations_ticks[row]),
        "standing": _footprint(steps.standing, row),
        "landing": _footprint(steps.landing, row),
        "lift": float(steps.lifts[row]),
        "flight": float(steps.flights[row]),
        "keys": np.round(numbers.ravel(), 12).tolist(),
    }


def _footprint(footprints: Footprints, row: int) -> dict[str, float]:
    x, y, z = footprints.positions_m[row].tolist()
    return {"x": x, "y": y, "z": z, "heading": float(footprints.headings_rad[row])}


if __name__ == "__main__":
    FIXTURE.parent.mkdir(parents=True, exist_ok=True)
    FIXTURE.write_text(text(), encoding="utf-8")
