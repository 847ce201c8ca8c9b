"""Commands that have others carried out later, and marks of moments."""

from __future__ import annotations

import re
from datetime import datetime
from typing import Annotated, Any, Final, Literal, Self

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, model_validator

from esplanade.protocol.commands.conditions import FigureCondition, GuardCondition
from esplanade.protocol.commands.fields import NO_NUL, BaseCommand

MOST_SCHEDULED: Final = 64
"""A schedule has no more commands than this."""
_OF_DAY: Final = re.compile(r"([01][0-9]|2[0-3]):[0-5][0-9](:[0-5][0-9])?")


def _moment(text: str) -> str:
    if not _OF_DAY.fullmatch(text):
        try:
            moment = datetime.fromisoformat(text)
        except ValueError:
            raise ValueError("give HH:MM, or a moment such as 2026-05-01T18:00:00Z") from None
        if moment.tzinfo is None:
            raise ValueError("give the zone of time, such as a Z at the end for UTC")
    return text


Moment = Annotated[str, Field(max_length=40), AfterValidator(_moment)]
Span = Annotated[float, Field(gt=0.0, le=366 * 86_400.0, allow_inf_nan=False)]


class When(BaseModel):
    """The occasion of a schedule: one of these."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    at_tick: Annotated[int, Field(ge=1, lt=2**53)] | None = None
    after_s: Span | None = None
    at_time: Moment | None = Field(
        None, description="`18:30`, the next one there is, in UTC; or `2026-05-01T18:00:00Z`."
    )
    figure: FigureCondition | None = None

    @model_validator(mode="after")
    def _one_occasion(self) -> Self:
        given = [self.at_tick, self.after_s, self.at_time, self.figure]
        if sum(each is not None for each in given) != 1:
            raise ValueError("give one of at_tick, after_s, at_time and figure")
        return self


class ScheduleCommands(BaseCommand):
    """Have commands carried out later, all in one tick, with the rights of the account then."""

    op: Literal["schedule"]
    commands: Annotated[
        list[dict[str, Any]],
        Field(
            min_length=1,
            max_length=MOST_SCHEDULED,
            description="As they are sent alone; they hold no schedules, take nothing back, "
            "and are about no person.",
        ),
    ]
    when: When
    again_after_s: Span | None = Field(
        None, description="Take the changes back after this time; None lets them stay."
    )
    guard: GuardCondition | None = None


class CancelSchedule(BaseCommand):
    """Let a schedule do nothing any more; what it has done stays."""

    op: Literal["cancel_schedule"]
    id: Annotated[str, Field(pattern=r"^s[1-9][0-9]{0,17}$", description="Such as `s12`.")]


class Mark(BaseCommand):
    """Mark this moment: it is a line on charts, and a row of the audit."""

    op: Literal["mark"]
    text: Annotated[str, Field(min_length=1, max_length=200, pattern=NO_NUL)]
