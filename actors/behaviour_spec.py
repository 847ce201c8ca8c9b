"""Behaviours as data: what a file or an operator says, from which a behaviour is made."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, model_validator

from esplanade.actors.behaviour import Behaviour, GoTo, Guide, Idle, Patrol, Wander
from esplanade.actors.following import Follow

ActorId = Annotated[
    str,
    Field(
        pattern=r"^[a-z0-9][a-z0-9-]{0,31}/[a-z0-9][a-z0-9._-]{0,47}$",
        description="The zone that the actor came into first, a slash, and a name in it.",
    ),
]
"""One text, since it is a key in many places: tables, paths of an interface, what is stored."""

Metres = Annotated[float, Field(allow_inf_nan=False, ge=-100_000.0, le=100_000.0)]
Place = Annotated[str, Field(min_length=1, max_length=64, description="A place of the scene.")]
Point = Annotated[
    tuple[Metres, Metres, Metres], Field(description="x, y and the height of the floor, metres.")
]
Target = Place | Point
Targets = Annotated[list[Target], Field(min_length=1, max_length=64)]
Seconds = Annotated[float, Field(ge=0.0, le=3600.0, allow_inf_nan=False)]


Strict = Annotated[
    bool,
    Field(description="Whether a goal where the body does not fit is refused rather than moved."),
]


class _Spec(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class IdleSpec(_Spec):
    """Stand, and make way when somebody comes too close."""

    kind: Literal["idle"] = "idle"

    def make(self) -> Behaviour:
        return Idle()


class GoToSpec(_Spec):
    """Go to one place or point and stay there."""

    kind: Literal["go_to"] = "go_to"
    target: Target
    strict: Strict = False

    def make(self) -> Behaviour:
        return GoTo(self.target, strict=self.strict)


class WanderSpec(_Spec):
    """Walk from place to place at random, resting at each."""

    kind: Literal["wander"] = "wander"
    least_pause_s: Seconds = 1.0
    most_pause_s: Seconds = 4.0

    @model_validator(mode="after")
    def _in_order(self) -> WanderSpec:
        if self.most_pause_s < self.least_pause_s:
            raise ValueError("most_pause_s must not be below least_pause_s")
        return self

    def make(self) -> Behaviour:
        return Wander((self.least_pause_s, self.most_pause_s))


class PatrolSpec(_Spec):
    """Walk a list of places round and round, resting at each."""

    kind: Literal["patrol"] = "patrol"
    stops: Targets
    pause_s: Seconds = 2.0
    strict: Strict = False

    def make(self) -> Behaviour:
        return Patrol(self.stops, self.pause_s, strict=self.strict)


class GuideSpec(_Spec):
    """Lead people along a tour; wait for followers who fall behind."""

    kind: Literal["guide"] = "guide"
    tour: Targets
    pause_s: Seconds = 5.0
    join_m: Annotated[float, Field(gt=0.0, le=20.0, description="Who stays this near follows.")] = (
        3.0
    )
    lag_m: Annotated[
        float, Field(gt=0.0, le=50.0, description="The guide waits for followers further off.")
    ] = 6.0
    join_after_s: Seconds = 2.0
    patience_s: Seconds = 15.0
    strict: Strict = False

    @model_validator(mode="after")
    def _joins_before_it_lags(self) -> GuideSpec:
        if self.join_m >= self.lag_m:
            raise ValueError(f"join_m ({self.join_m}) must lie below lag_m ({self.lag_m})")
        return self

    def make(self) -> Behaviour:
        return Guide(
            self.tour,
            self.pause_s,
            self.join_m,
            self.lag_m,
            self.join_after_s,
            self.patience_s,
            strict=self.strict,
        )


class FollowSpec(_Spec):
    """Walk after an actor or a person, and stay at a distance."""

    kind: Literal["follow"] = "follow"
    actor: ActorId | None = None
    person: Annotated[int, Field(ge=0, description="The id of a person's avatar.")] | None = None
    distance_m: Annotated[float, Field(ge=0.8, le=20.0, allow_inf_nan=False)] = 2.0

    @model_validator(mode="after")
    def _one_of_them(self) -> FollowSpec:
        if (self.actor is None) == (self.person is None):
            raise ValueError("follow an actor or a person: give one of them")
        return self

    def make(self) -> Behaviour:
        return Follow(actor=self.actor, person=self.person, distance_m=self.distance_m)


BehaviourSpec = Annotated[
    IdleSpec | GoToSpec | WanderSpec | PatrolSpec | GuideSpec | FollowSpec,
    Field(discriminator="kind"),
]
BEHAVIOUR_SPEC: TypeAdapter[BehaviourSpec] = TypeAdapter(BehaviourSpec)
"""Reads and checks one; its `json_schema` is a form."""
