"""Refusals of what operators ask for, as codes with the place in what was sent."""

from collections.abc import Mapping, Sequence
from typing import Any

from esplanade.protocol.commands import CommandFault
from esplanade.server.world.outcomes import Fault, FaultCode


class RefusedError(Exception):
    """Nothing was changed; each fault says why."""

    def __init__(self, faults: Sequence[CommandFault]) -> None:
        super().__init__("; ".join(fault.text for fault in faults))
        self.faults = list(faults)

    @classmethod
    def of(cls, code: str, text: str, *path: str | int, **arguments: Any) -> "RefusedError":
        """A refusal for one reason."""
        return cls([CommandFault(code=code, text=text, path=list(path), arguments=arguments)])

    def within(self, *path: str | int) -> "RefusedError":
        """The same, of a part of something larger."""
        return RefusedError(
            [fault.model_copy(update={"path": [*path, *fault.path]}) for fault in self.faults]
        )


def unwritable(error: Exception) -> CommandFault:
    """The fault of what cannot be done because the store cannot be written."""
    return CommandFault(code="unwritable", text=f"it cannot be written: {error}")


def failed(error: Exception) -> CommandFault:
    """The fault of what ends by an error that nobody has foreseen."""
    return CommandFault(code="failed", text=f"it has failed: {error}")


def of_world(fault: Fault) -> list[CommandFault]:
    """A fault that the world has found; those of values one by one, each with its field."""
    if fault.code is FaultCode.VALUES:
        return [_of_value(each) for each in fault.arguments.get("faults", ())]
    return [CommandFault(code=fault.code.value, text=fault.text, arguments=dict(fault.arguments))]


def _of_value(fault: Mapping[str, Any]) -> CommandFault:
    field, value, limit = fault["field"], fault["value"], fault["limit"]
    of_actor = f"{field} of {fault['actor']}"
    match fault["code"]:
        case "order":
            text = f"{of_actor} ({value:g}) must not be above {fault['other']} ({limit:g})"
        case "below" | "above":
            text = f"{of_actor} must not be {fault['code']} {limit:g}, got {value:g}"
        case "not_whole":
            text = f"{of_actor} must be a whole number, got {value}"
        case code:
            text = f"{of_actor}: {code}"
    return CommandFault(code="values", text=text, path=["values", field], arguments=dict(fault))
