"""Every message, as a pydantic model. Field names are those on the wire.

Messages of clients are checked strictly: unknown fields, wrong types, infinities and
over-long texts are refused. Positions are metres, z being the height of the feet above the
scene's ground; directions are radians, counter-clockwise from +x; speeds are metres a second.
"""

from typing import Annotated, Any, ClassVar, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, StringConstraints

from esplanade.protocol.codes import (
    MAX_CHAT_CHARS,
    MAX_DOOR_CHARS,
    MAX_LINE_NUMBER,
    MAX_NAME_CHARS,
    MAX_SECRET_CHARS,
    MAX_TOKEN_CHARS,
    ByeCode,
    ClientCode,
    ErrorCode,
    Gesture,
    Kind,
    NoticeCode,
    Outcome,
    Reason,
    ServerCode,
)
from esplanade.protocol.lines import plain_line
from esplanade.protocol.looks import NO_LOOK, ChosenLook, KnownLook, Look
from esplanade.protocol.names import plain_name

Metres = Annotated[float, Field(ge=-100_000.0, le=100_000.0, allow_inf_nan=False)]
Place = tuple[float, float, float]
"""x, y, z."""
Layer = Annotated[int, Field(ge=0, le=255)]
Token = Annotated[str, Field(max_length=MAX_TOKEN_CHARS)]
EntityId = Annotated[int, Field(ge=0, le=0xFFFF_FFFF)]
Sequence = Annotated[int, Field(ge=0, le=0xFFFF_FFFF)]
LineNumber = Annotated[int, Field(ge=0, le=MAX_LINE_NUMBER)]
Arguments = dict[str, Any]
"""Numbers and texts for programs, from which they make sentences in any language."""
Name = Annotated[
    str,
    AfterValidator(plain_name),
    Field(description=f"1 to {MAX_NAME_CHARS} visible characters on one line."),
]
Line = Annotated[
    str,
    StringConstraints(strip_whitespace=True, min_length=1, max_length=MAX_CHAT_CHARS),
    AfterValidator(plain_line),
]


def _is_plain(look: Look) -> bool:
    """Whether no part of a look is chosen; it is left out then."""
    return look == NO_LOOK


def _is_unset(value: object) -> bool:
    """Whether an optional field has no value; it is left out then, as before there was such."""
    return not value


class FromClient(BaseModel):
    """Base of what a client sends: strict, frozen, nothing unknown."""

    model_config = ConfigDict(strict=True, frozen=True, extra="forbid")
    code: ClassVar[ClientCode]


class FromServer(BaseModel):
    """Base of what the server sends. Clients outlive additions: unknown fields are ignored, and
    names and numbers of kinds, reasons and faults that are not known are taken as they are."""

    model_config = ConfigDict(frozen=True, extra="ignore")
    code: ClassVar[ServerCode]


# --- client → server --------------------------------------------------------------------------


class Admission(BaseModel):
    """The pass of a client: to a closed world, with an operator's rights, or at a bot's rate."""

    model_config = ConfigDict(strict=True, frozen=True, extra="forbid")
    way: Literal["invitation", "password", "pass", "bot"]
    secret: Annotated[str, Field(min_length=1, max_length=MAX_SECRET_CHARS)]


class Hello(FromClient):
    """First message: who comes in. With a live resume token the same avatar is taken up again."""

    code = ClientCode.HELLO
    name: Name
    version: Annotated[int, Field(ge=0, le=0xFFFF)]
    resume: Token | None = None
    at: Annotated[tuple[Metres, Metres, Metres], Field(strict=False)] | None = None
    """Wished place (x, y, z) of a new avatar. In the world of a recorded crowd, and for operators,
    the server takes the nearest free one; in others the place of arrival that is nearest."""
    operator: Token | None = None
    """The server's operator key; without the right key a client has no operator's rights."""
    admission: Admission | None = None
    """What lets the client in where not everybody comes in."""
    steps: bool = True
    """Whether steps are wanted; who draws no feet gets all places in snapshots instead."""
    look: Annotated[ChosenLook | None, Field(exclude_if=_is_unset)] = None
    """The look of the avatar. Whoever comes back without one keeps that of before."""


class Move(FromClient):
    """Walk in a direction until told otherwise. Speed 0 stands still. The newest wins."""

    code = ClientCode.MOVE
    seq: Sequence
    direction: Annotated[float, Field(ge=-1000.0, le=1000.0, allow_inf_nan=False)]
    speed: Annotated[float, Field(ge=0.0, le=100.0, allow_inf_nan=False)]


class WalkTo(FromClient):
    """Walk to a point around what stands in the way; a later `move` cancels it.

    Of several floors at (x, y) the one nearest in height to z is meant.
    """

    code = ClientCode.WALK_TO
    seq: Sequence
    x: Metres
    y: Metres
    z: Metres = 0.0
    strict: Annotated[bool, Field(exclude_if=_is_unset)] = False
    """Whether to be refused rather than led to another place where the point cannot be stood on."""


class ChatLine(FromClient):
    """Say something to everyone who has the speaker in view."""

    code = ClientCode.CHAT
    text: Line


class Ping(FromClient):
    """Ask for a pong with the same nonce."""

    code = ClientCode.PING
    nonce: Sequence


class Watch(FromClient):
    """Ask for the plans of one actor in view (id), or for none any more (None)."""

    code = ClientCode.WATCH
    id: EntityId | None


class SetDoor(FromClient):
    """Open or close a door of the scene; for operators."""

    code = ClientCode.SET_DOOR
    name: Annotated[str, Field(min_length=1, max_length=MAX_DOOR_CHARS)]
    open: bool


class Report(FromClient):
    """Tell those who look after the world of somebody, or of a line that somebody said."""

    code = ClientCode.REPORT
    id: EntityId
    line: LineNumber | None = None
    """The number of a line of chat."""
    text: Line


class MutePerson(FromClient):
    """Hear a person no more, or hear them again; it holds for this connection."""

    code = ClientCode.MUTE
    id: EntityId
    muted: bool


class Presence(FromClient):
    """Say that the person is away from the screen, or there again."""

    code = ClientCode.PRESENCE
    away: bool


class MakeGesture(FromClient):
    """Let the own avatar make a gesture, one of `Gesture`."""

    code = ClientCode.GESTURE
    gesture: Annotated[int, Field(ge=min(Gesture), le=max(Gesture))]


class ChooseLook(FromClient):
    """Let the own avatar look otherwise."""

    code = ClientCode.LOOK
    look: ChosenLook


ClientMessage = (
    Hello
    | Move
    | WalkTo
    | ChatLine
    | Ping
    | Watch
    | SetDoor
    | Report
    | MutePerson
    | Presence
    | MakeGesture
    | ChooseLook
)

# --- server → client --------------------------------------------------------------------------


class Welcome(FromServer):
    """Answer to hello: the avatar's id, the whole scene, and what a client predicts with."""

    code = ServerCode.WELCOME
    version: int
    """The version that is spoken on this connection: the one that hello asked for."""
    id: EntityId
    name: str
    resume: str
    resumed: bool
    scene: dict[str, Any]
    tick: int
    tick_rate: int
    server_time: float
    resume_seconds: float
    """The time for which an avatar waits for a client whose connection was lost."""
    radius: float
    clearance: float
    """Distance that a person's centre keeps from walls."""
    body_height: float
    """A barrier that hangs lower than this above the feet stops a person."""
    step_height: float
    """Greatest difference in height that a person steps up or down."""
    max_speed: float
    walk_speed: float
    """Speed of a walk to a point, and of a walk in no hurry."""
    origin: tuple[float, float]
    """World position (x, y) of the snapshot's coordinate (0, 0), metres."""
    doors: dict[str, bool]
    """Whether each of the scene's doors stands open now, by name."""
    operator: bool
    """Whether this client may do what only operators may."""


class Entity(BaseModel):
    """One avatar as it comes into view."""

    model_config = ConfigDict(frozen=True, extra="ignore")
    id: EntityId
    kind: Annotated[Kind | str, Field(union_mode="left_to_right")]
    name: str
    layer: Layer
    x: float
    y: float
    z: float
    heading: float
    radius: float
    leg_m: float
    """Length of a leg from hip to ankle."""
    stature_m: float
    points_at: Place | None
    """The place that an actor points at while it explains."""
    look: Annotated[KnownLook, Field(exclude_if=_is_plain)] = NO_LOOK


class Enter(FromServer):
    """Avatars that come into view."""

    code = ServerCode.ENTER
    tick: int
    entities: list[Entity]


class Leave(FromServer):
    """Avatars that go out of view or out of the world."""

    code = ServerCode.LEAVE
    tick: int
    ids: list[EntityId]


class Snapshot(FromServer):
    """Places of everyone in view. `block` holds records of `esplanade.protocol.snapshot`."""

    code = ServerCode.SNAPSHOT
    tick: int
    ack: Sequence
    block: bytes


class Chat(FromServer):
    """A line that somebody in view said."""

    code = ServerCode.CHAT
    id: EntityId
    name: str
    text: str
    line: LineNumber = 0
    """The number of the line, by which it can be hidden and reported; 0 for one without."""


class Hide(FromServer):
    """Lines of chat that are to be shown no more."""

    code = ServerCode.HIDE
    lines: list[LineNumber]


class Notice(FromServer):
    """A sentence from the server for the person to read, and its matter for programs."""

    code = ServerCode.NOTICE
    text: str
    notice: Annotated[NoticeCode | str, Field(union_mode="left_to_right")] = NoticeCode.NONE
    arguments: Arguments = {}


class Error(FromServer):
    """A fault in something that the client sent. `error` is for programs, `text` for people."""

    code = ServerCode.ERROR
    error: Annotated[ErrorCode | str, Field(union_mode="left_to_right")]
    text: str
    arguments: Arguments = {}


class Bye(FromServer):
    """The server ends the connection in good order."""

    code = ServerCode.BYE
    reason: Annotated[ByeCode | str, Field(union_mode="left_to_right")]
    text: str
    arguments: Arguments = {}


class Pong(FromServer):
    """Answer to ping."""

    code = ServerCode.PONG
    nonce: Sequence
    server_time: float


class Circle(BaseModel):
    """Likely places of a person at one predicted time: centre and radius (two sigma)."""

    model_config = ConfigDict(frozen=True, extra="ignore")
    x: float
    y: float
    z: float
    radius: float


class Blocker(BaseModel):
    """The person, actor, door or wall that holds an actor which does not walk on."""

    model_config = ConfigDict(frozen=True, extra="ignore")
    kind: Literal["person", "actor", "door", "wall", "route"] | str
    """A route is one that the server still looks for."""
    id: EntityId | None = None
    """Of the person or the actor."""
    door: str | None = None
    """The name of the door."""
    away: float | None = None
    """Metres between the bodies, or to the door or wall."""


class Tour(BaseModel):
    """The tour on which a guide leads people."""

    model_config = ConfigDict(frozen=True, extra="ignore")
    stops: list[str]
    """Names of places of the scene; an empty one for a stop without a name."""
    next: int
    """The place among them of the stop to which it leads, or where it is."""
    followers: list[EntityId]
    """The people who are being led."""


class Plan(FromServer):
    """Why the watched actor does what it does, about five times a second."""

    code = ServerCode.PLAN
    tick: int
    id: EntityId
    reason: Annotated[Reason | int, Field(union_mode="left_to_right")]
    behaviour: Literal["go_to", "wander", "patrol", "guide", "follow", "idle"] | str
    goal: Place | None
    path: list[tuple[float, float, float, float]]
    """Points (x, y, z, seconds from now)."""
    people: list[list[Circle]]
    """For every person near the actor: the predicted circles, soonest first."""
    since_s: float
    """For how long the reason has been that."""
    blocker: Blocker | None
    """The blocker of an actor that does not walk on, where it can be told."""
    outcome: Annotated[Outcome | int, Field(union_mode="left_to_right")] | None = None
    """How the trip ended; None while it goes on, and without a goal."""
    in_the_way: Blocker | None = None
    """The one for whom the trip did not end at the goal."""
    tour: Annotated[Tour | None, Field(exclude_if=_is_unset)] = None
    """The tour of a guide; left out for all others."""


class Census(FromServer):
    """Numbers of people and actors in the whole world, about once a second."""

    code = ServerCode.CENSUS
    people: int
    actors: int


class Doors(FromServer):
    """Doors that opened (true) or closed (false), by name."""

    code = ServerCode.DOORS
    doors: dict[str, bool]


class StepBlock(FromServer):
    """Steps of those near by. `block` holds packed records, see `esplanade.protocol.steps`."""

    code = ServerCode.STEPS
    tick: int
    block: bytes


class Point(FromServer):
    """An actor in view points at something from now on, or at nothing any more (None)."""

    code = ServerCode.POINT
    id: EntityId
    target: Place | None


class Reshape(FromServer):
    """An avatar in view has another body or look from now on; where it is and walks goes on."""

    code = ServerCode.RESHAPE
    id: EntityId
    radius: float
    leg_m: float
    stature_m: float
    look: Annotated[KnownLook, Field(exclude_if=_is_plain)] = NO_LOOK


class Travel(FromServer):
    """The person has come into another zone; the welcome of there follows, on this connection.

    All that was told of the zone before is void. Name, token and id stay as they were.
    """

    code = ServerCode.TRAVEL
    zone: str
    """The name of the zone."""
    portal: str
    """The name of the portal there that the person has come out of."""


class Away(FromServer):
    """The person of an avatar in view is away from now on, or there again."""

    code = ServerCode.AWAY
    id: EntityId
    away: bool


class GestureMade(FromServer):
    """An avatar in view makes a gesture."""

    code = ServerCode.GESTURE
    id: EntityId
    gesture: Annotated[Gesture | int, Field(union_mode="left_to_right")]


ServerMessage = (
    Welcome
    | Enter
    | Leave
    | Snapshot
    | Chat
    | Hide
    | Notice
    | Error
    | Bye
    | Pong
    | Plan
    | Census
    | Doors
    | StepBlock
    | Point
    | Reshape
    | Travel
    | Away
    | GestureMade
)
