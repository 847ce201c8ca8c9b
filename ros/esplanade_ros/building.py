"""Messages of ROS from plain data: dicts by the names of fields, lists, numbers and text."""

import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

_SEQUENCE = re.compile(r"sequence<(.+?)(, \d+)?>|(.+)\[\d+\]")


class MessageError(ValueError):
    """Plain data does not fit a message; the text names the field."""


def built(kind: str, plain: Mapping[str, Any], class_of: Callable[[str], type[Any]]) -> Any:
    """The message of a kind, such as `geometry_msgs/Pose`, with these fields.

    `class_of` gives the class of a kind; fields that are not named are as in a new message.

    Raises
    ------
    MessageError
        The message has no such field.
    """
    made = class_of(kind)()
    types: Mapping[str, str] = made.get_fields_and_field_types()
    for name, value in plain.items():
        if name not in types:
            raise MessageError(f"{kind} has no field {name}; it has {', '.join(types)}")
        setattr(made, name, _value(types[name], value, class_of))
    return made


def _value(kind: str, value: Any, class_of: Callable[[str], type[Any]]) -> Any:
    if isinstance(value, Mapping):
        return built(kind, value, class_of)
    if isinstance(value, Sequence) and not isinstance(value, str):
        found = _SEQUENCE.fullmatch(kind)
        if found is None:
            raise MessageError(f"{kind} is no sequence")
        each = found[1] or found[3]
        return [_value(each, one, class_of) for one in value]
    return value
