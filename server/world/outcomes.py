"""Outcomes of operators' commands, as codes with arguments."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from enum import StrEnum
from typing import Any

from esplanade.actors import ParameterError


class FaultCode(StrEnum):
    """Why a command was not carried out."""

    UNKNOWN_ACTOR = "unknown_actor"
    UNKNOWN_PLACE = "unknown_place"
    UNKNOWN_DOOR = "unknown_door"
    TAKEN = "taken"
    VALUES = "values"
    REFUSED = "refused"
    FULL = "full"
    BUSY = "busy"
    SUPERSEDED = "superseded"
    FAILED = "failed"


@dataclass(frozen=True)
class Fault:
    """Why nothing of a command was carried out; `text` says it to people, the rest to programs."""

    code: FaultCode
    text: str
    arguments: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Outcome:
    """The outcome of a command: it was carried out in this tick, or nothing of it was."""

    command: int
    tick: int
    fault: Fault | None = None


class CommandError(Exception):
    """A command cannot be carried out."""

    def __init__(self, code: FaultCode, text: str, **arguments: Any) -> None:
        super().__init__(text)
        self.fault = Fault(code, text, arguments)


def fault_of(error: Exception) -> Fault:
    """The fault that an error stands for; what nobody has foreseen is a failure."""
    match error:
        case CommandError():
            return error.fault
        case ParameterError():
            faults = [asdict(each) for each in error.faults]
            return Fault(FaultCode.VALUES, str(error), {"faults": faults})
        case ValueError():
            return Fault(FaultCode.REFUSED, str(error))
    return Fault(FaultCode.FAILED, f"it failed: {error}")
