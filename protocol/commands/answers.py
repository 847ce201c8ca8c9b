"""Answers to commands, and why one is refused."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import BaseModel, Field

Facts = dict[str, dict[str, Any]]
"""Fields of subjects: `{"world": {"risk_weight": 12}, "door:lobby": {"open": true}}`. None stands
for what is not set, or not there."""


Price = Literal["tick", "prepared"]
"""Whether a command is done in a tick, or something has to be prepared before."""


class CommandFault(BaseModel):
    """Why nothing was done; `text` says it to people, the rest to programs."""

    code: str
    text: str
    path: list[str | int] = Field([], description="Where in the command, or the list of commands.")
    arguments: dict[str, Any] = {}


class Answer(BaseModel):
    """The answer to a command: the change that it made, and its tick."""

    op: str
    command: int | None = Field(
        None, description="Its number, which is that of its row in the audit; None without one."
    )
    tick: int | None = Field(None, description="The tick in which it took effect.")
    revision: int = Field(description="The number of the latest change that was made.")
    before: Facts = {}
    after: Facts = {}
    price: Price = Field(
        "tick", description="Whether it is done in a tick, or something has to be prepared before."
    )
    prepare_s: float | None = Field(
        None, description="About how many seconds the preparation takes, where there is one."
    )
    shadowed: dict[str, int] = Field(
        {}, description="How many narrower scopes have a value of their own, by parameter."
    )
    faults: list[CommandFault] = []
