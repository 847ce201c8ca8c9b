"""The ways in which a request of an operator fails."""

from collections.abc import Mapping, Sequence
from typing import Any


class OperatorError(Exception):
    """A request was not fulfilled."""


class UnreachableError(OperatorError):
    """Nobody answers at that address, or not in the way that a server does."""


class RefusedError(OperatorError):
    """The server has changed nothing, and says why."""

    def __init__(self, status: int, faults: Sequence[Mapping[str, Any]]) -> None:
        self.status = status
        """401, 403, 404, 409, 422 or 503."""
        self.faults = list(faults)
        """Each with `code`, `text`, `path` and `arguments`."""
        super().__init__("\n".join(_told(fault) for fault in faults))


def _told(fault: Mapping[str, Any]) -> str:
    text = str(fault.get("text", "it was refused"))
    lines = [f"{'.'.join(map(str, fault.get('path', ())))}: {text}".removeprefix(": ")]
    lines += [
        f"  {each['field']} of {each['subject']}: now {_value(each['now'])}, "
        + ", ".join(f"{name} {_value(each[name])}" for name in _SIDES if name in each)
        for each in fault.get("arguments", {}).get("differences", ())
    ]
    return "\n".join(lines)


_SIDES = ("yours", "before", "after")


def _value(value: Any) -> str:
    return "not set" if value is None else f"{value}"
