"""Classes of messages as ROS generates them from its definitions, for machines without ROS."""

from functools import cache
from typing import Any

from esplanade_ros.definitions import DEFINITIONS

_BLANK: dict[str, Any] = {"string": "", "int32": 0, "uint32": 0, "double": 0.0, "float": 0.0}
_WHOLE = ("int32", "uint32")


@cache
def class_of(kind: str) -> type[Any]:
    """A class whose fields take what ROS takes: the right kinds of numbers, text and messages."""
    fields = DEFINITIONS[kind]

    class Message:
        def __init__(self) -> None:
            for name, each in fields.items():
                object.__setattr__(self, name, blank(each))

        @classmethod
        def get_fields_and_field_types(cls) -> dict[str, str]:
            return dict(fields)

        def __setattr__(self, name: str, value: Any) -> None:
            assert name in fields, f"{kind} has no field {name}"
            check(f"{kind}.{name}", fields[name], value)
            object.__setattr__(self, name, value)

    Message.__name__ = kind
    return Message


def blank(kind: str) -> Any:
    if kind in DEFINITIONS:
        return class_of(kind)()
    if kind.startswith("sequence<"):
        return []
    if kind.endswith("]"):
        each, _, count = kind.removesuffix("]").partition("[")
        return [blank(each)] * int(count)
    return _BLANK[kind]


def check(where: str, kind: str, value: Any) -> None:
    """Whether ROS would take a value: its generated setters assert the same."""
    if kind in DEFINITIONS:
        assert type(value) is class_of(kind), where
    elif kind.startswith("sequence<"):
        each = kind.removeprefix("sequence<").removesuffix(">")
        for one in value:
            check(where, each, one)
    elif kind == "string":
        assert isinstance(value, str), where
    elif kind in _WHOLE:
        least, most = (0, 2**32) if kind == "uint32" else (-(2**31), 2**31)
        assert isinstance(value, int), where
        assert least <= value < most, where
    else:
        assert isinstance(value, float), where
