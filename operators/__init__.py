"""Operators from the other side: a Python client for the interface of a server's private port.

Names are imported when they are first asked for: the command explains its options without them.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from esplanade.operators.client import Operator, connect
    from esplanade.operators.errors import OperatorError, RefusedError, UnreachableError

__all__ = ["Operator", "OperatorError", "RefusedError", "UnreachableError", "connect"]

_MODULES = {
    "client": ("Operator", "connect"),
    "errors": ("OperatorError", "RefusedError", "UnreachableError"),
}


def __getattr__(name: str) -> Any:
    for module, names in _MODULES.items():
        if name in names:
            found = getattr(import_module(f"{__name__}.{module}"), name)
            globals()[name] = found
            return found
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
