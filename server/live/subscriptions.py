"""The subscriptions that a console may have on its live socket, and their arguments."""

import json
from typing import Annotated, Any, Final, Literal

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

MOST_SUBSCRIPTIONS: Final = 16
"""Subscriptions of one socket at once; more are refused."""
ACTOR: Final = "actor:"
EVENT_KINDS: Final = (
    *("join", "leave", "contact", "stop", "no_path", "door", "plan_failure", "late_tick"),
    *("chat", "command", "mark", "report", "pace", "schedule", "trajectories"),
    "recording",
)
BEATS_A_SECOND: Final = 10
"""So often a second are subscribers told what is new."""
Words = Annotated[list[Annotated[str, Field(max_length=200)]], Field(max_length=100)]


class _Wish(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")

    def period(self) -> int:
        """Beats from one message to the next."""
        return max(1, round(BEATS_A_SECOND / getattr(self, "hz", BEATS_A_SECOND)))


class MapWish(_Wish):
    """Where everybody is."""

    subscribe: Literal["map"]
    hz: Annotated[float, Field(ge=1.0, le=10.0)] = 10.0


class LayersWish(_Wish):
    """Planned ways, goals, and the circles in which people are expected."""

    subscribe: Literal["map.layers"]
    ways: bool = False
    goals: bool = False
    circles: bool = False
    hz: Annotated[float, Field(ge=0.1, le=2.0)] = 2.0
    actors: Words | None = None
    """Ids of the actors that are meant; None for all."""


class PlainWish(_Wish):
    """Contacts, figures, or changes."""

    subscribe: Literal["contacts", "series", "changes"]


class EventsWish(_Wish):
    """Events, of some kinds or of all."""

    subscribe: Literal["events"]
    kinds: Annotated[list[str], Field(max_length=len(EVENT_KINDS))] | None = None


class ActorWish(_Wish):
    """One actor, and why it does what it does."""

    subscribe: Annotated[str, Field(pattern=r"^actor:[^\x00]+$", max_length=200)]
    hz: Annotated[float, Field(ge=0.5, le=10.0)] = 5.0


class Unsubscribe(BaseModel):
    """An end of a subscription."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    unsubscribe: Annotated[str, Field(max_length=200)]


Wish = MapWish | LayersWish | PlainWish | EventsWish | ActorWish
_WISH: Final[TypeAdapter[Wish | Unsubscribe]] = TypeAdapter(
    Annotated[Wish | Unsubscribe, Field(union_mode="left_to_right")]
)


class WishError(ValueError):
    """A message of a client that means nothing here, and of which channel it speaks."""

    def __init__(self, channel: str, code: str, text: str) -> None:
        super().__init__(text)
        self.told = {
            "channel": channel,
            "faults": [{"code": code, "text": text, "path": [], "arguments": {}}],
        }


def read_wish(text: str) -> Wish | Unsubscribe:
    """Read a message of a client.

    Raises
    ------
    WishError
        It is none.
    """
    try:
        body = json.loads(text)
    except (ValueError, RecursionError):
        raise WishError("", "invalid", "this is no JSON") from None
    channel = _channel_of(body)
    try:
        return _WISH.validate_python(body)
    except ValidationError as error:
        faults = [each for each in error.errors() if each["type"] != "literal_error"]
        first = (faults or error.errors())[0]
        where = ".".join(str(each) for each in first["loc"][1:])
        raise WishError(channel, "invalid", f"{where}: {first['msg']}") from None


def _channel_of(body: Any) -> str:
    named = body.get("subscribe", "") if isinstance(body, dict) else ""
    return named if isinstance(named, str) else ""
