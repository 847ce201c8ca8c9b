"""The parameters of an actor that an operator can tune, with units, ranges and effects."""

from __future__ import annotations

from typing import Annotated, Final, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field, model_validator

from esplanade.planning import PARAMETERS, Body

Group = Literal["body", "speed", "comfort", "planning"]
"""A heading under which parameters are shown together."""
_LOG_ABOVE: Final = 50.0
"""A slider is logarithmic where its greatest value is more than so many times its least."""


def _field(group: Group, unit: str, least: float, most: float, description: str) -> object:
    """A field; `applies` in its schema tells when a change takes effect.

    With "tick" that is in the next tick. With "prepared" the ground is derived anew for another
    kind of body, outside of ticks, and the actor goes on as it was until then. How many edges in
    a row a body bears makes it no other kind.
    """
    applies = "prepared" if group == "body" and unit == "m" else "tick"
    logarithmic = least > 0.0 and most > _LOG_ABOVE * least
    return Field(
        ge=least,
        le=most,
        allow_inf_nan=False,
        description=description,
        json_schema_extra={
            "unit": unit,
            "group": group,
            "applies": applies,
            "scale": "log" if logarithmic else "linear",
        },
    )


class ActorParameters(BaseModel):
    """Body and temper of one actor. Every field may be changed while the world runs."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    radius_m: Annotated[
        float, _field("body", "m", 0.15, 0.9, "Radius of the disc that stands for the body.")
    ] = 0.25
    speed_mps: Annotated[
        float,
        _field("speed", "m/s", 0.1, 3.0, "Preferred walking speed; kept wherever nothing hinders."),
    ] = 1.3
    max_speed_mps: Annotated[
        float,
        _field("speed", "m/s", 0.1, 4.0, "Greatest speed, used to get out of somebody's way."),
    ] = 1.7
    max_acceleration_mps2: Annotated[
        float,
        _field(
            "speed", "m/s²", 0.2, 20.0, "Greatest change of velocity; lower is calmer but later."
        ),
    ] = 2.0
    goal_tolerance_m: Annotated[
        float, _field("planning", "m", 0.05, 2.0, "An actor this close to its goal has arrived.")
    ] = 0.2
    person_room_m: Annotated[
        float,
        _field(
            "comfort",
            "m",
            0.0,
            0.75,
            "Room kept to people's bodies at the last check before a step.",
        ),
    ] = 0.15
    contact_closing_s: Annotated[
        float,
        _field(
            "comfort",
            "s",
            0.0,
            5.0,
            "At the last check, when somebody is bound to be touched, each metre a second toward "
            "them counts like this many metres less between the two; an actor with more would "
            "rather be walked into than walk into somebody.",
        ),
    ] = 0.3
    risk_weight: Annotated[
        float,
        _field(
            "comfort",
            "s/s",
            0.0,
            200.0,
            "Seconds of detour that a second of certain contact is worth; higher keeps wider.",
        ),
    ] = 9.5
    foresight_s: Annotated[
        float,
        _field(
            "planning",
            "s",
            0.2,
            60.0,
            "Time over which risk ahead fades to a third: higher turns aside earlier, "
            "lower waits to see what people do.",
        ),
    ] = 3.0
    closing_weight: Annotated[
        float,
        _field(
            "comfort",
            "s/m",
            0.0,
            5.0,
            "Extra risk per metre a second of closing speed; higher avoids who comes nearer.",
        ),
    ] = 0.1
    turn_weight: Annotated[
        float,
        _field(
            "comfort",
            "s²/m",
            0.0,
            2.0,
            "Cost of a change of velocity; higher walks straighter and steadier.",
        ),
    ] = 0.1
    wall_weight: Annotated[
        float,
        _field(
            "comfort", "s/s", 0.0, 10.0, "Cost of brushing along walls within 0.15 m of the body."
        ),
    ] = 0.3
    hurry_weight: Annotated[
        float,
        _field(
            "comfort",
            "s/s",
            0.0,
            20.0,
            "Cost of walking faster than preferred, by the square of how much faster; "
            "lower passes in front where higher waits.",
        ),
    ] = 0.2
    catch_up: Annotated[
        float,
        _field(
            "speed",
            "1",
            0.0,
            1.0,
            "Part of the preferred speed by which the actor walks faster while it makes up time "
            "that it has lost on its way.",
        ),
    ] = 0.3
    hysteresis_s: Annotated[
        float,
        _field(
            "planning",
            "s",
            0.0,
            5.0,
            "How much better a new path must be before it replaces the one followed; "
            "higher flickers less but reacts later.",
        ),
    ] = 0.15
    keep_right_weight: Annotated[
        float,
        _field(
            "comfort",
            "m/m",
            0.0,
            1.0,
            "Metres of detour that a metre nearer to a narrow place is worth wholly on its left, "
            "while many want through from the other side; higher keeps right sooner and more "
            "strictly, 0 never does.",
        ),
    ] = 0.8
    max_expansions: Annotated[
        int,
        _field(
            "planning",
            "nodes",
            10,
            20000,
            "Budget of one search; a smaller one may end before the goal.",
        ),
    ] = 70
    height_m: Annotated[
        float,
        _field(
            "body", "m", 0.8, 2.5, "Height of the body; it passes where there is as much headroom."
        ),
    ] = 1.8
    step_on_m: Annotated[
        float, _field("body", "m", 0.05, 0.8, "Greatest step that the body takes up or down.")
    ] = 0.6
    leg_length_m: Annotated[
        float,
        _field(
            "body", "m", 0.3, 1.3, "Greatest step that is an edge; a higher one is an obstacle."
        ),
    ] = 0.9
    edge_cells: Annotated[
        int,
        _field(
            "body",
            "cells",
            2,
            1000,
            "The body may be at steps and edges for fewer cells in a row than this.",
        ),
    ] = 64

    patience_s: Annotated[
        float,
        _field(
            "planning",
            "s",
            1.0,
            600.0,
            "Time for which the actor puts up with coming no nearer to its goal; then its trip "
            "ends where it is, beside a goal that is taken or before a way that is blocked.",
        ),
    ] = 30.0
    stride: Annotated[
        float,
        _field(
            "speed",
            "1",
            0.5,
            1.25,
            "Length of its steps against those of a free walk at the same speed; with longer steps "
            "it takes fewer.",
        ),
    ] = 1.0

    @model_validator(mode="after")
    def _legs_reach(self) -> Self:
        if self.leg_length_m < self.step_on_m:
            raise ValueError(
                f"leg_length_m ({self.leg_length_m}) must not be below step_on_m ({self.step_on_m})"
            )
        return self

    @property
    def body(self) -> Body:
        """The body, as the ground is seen by it."""
        return Body(
            self.radius_m, self.height_m, self.step_on_m, self.leg_length_m, self.edge_cells
        )

    @model_validator(mode="after")
    def _speeds_in_order(self) -> Self:
        if self.max_speed_mps < self.speed_mps:
            raise ValueError(
                f"max_speed_mps ({self.max_speed_mps}) must not be below speed_mps "
                f"({self.speed_mps})"
            )
        return self

    def row(self) -> NDArray[np.void]:
        """Return the record of `planning.PARAMETERS` that the agents' table holds."""
        values = tuple(getattr(self, name) for name in PARAMETERS.names or ())
        return np.array(values, dtype=PARAMETERS)

    @classmethod
    def of_row(cls, row: NDArray[np.void]) -> Self:
        """The parameters that a record of `planning.PARAMETERS` was made of."""
        values = dict(zip(PARAMETERS.names or (), row.item(), strict=True))
        for name in ("max_expansions", "edge_cells"):
            values[name] = int(values[name])
        return cls(**values)


def body_of(row: NDArray[np.void]) -> Body:
    """The body of an actor with these parameters, as the ground is seen by it."""
    return Body(
        float(row["radius_m"]),
        float(row["height_m"]),
        float(row["step_on_m"]),
        float(row["leg_length_m"]),
        int(row["edge_cells"]),
    )
