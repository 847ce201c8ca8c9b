"""Settings as a pydantic class: its fields are made of the table, its faults put into words."""

from collections.abc import Mapping
from typing import Any, TypeVar

from pydantic import BaseModel, Field, ValidationError

from esplanade.commandline.errors import UsageError
from esplanade.commandline.settings import Settings

Model = TypeVar("Model", bound=BaseModel)


def field(settings: Settings, name: str) -> Any:
    """A field with the default, limits and description of this setting."""
    setting = settings.setting(name)
    return Field(
        setting.default,
        description=setting.text,
        json_schema_extra={"group": settings.group_of(name), "unit": setting.unit},
        **getattr(setting.read, "limits", {}),
    )


def made(kind: type[Model], given: Mapping[str, Any]) -> Model:
    """The object with these values.

    Raises
    ------
    UsageError
        A value is not allowed, or two do not fit together.
    """
    try:
        return kind(**given)
    except ValidationError as error:
        raise UsageError(in_words(error)) from None


def in_words(error: ValidationError) -> str:
    """The first fault: where it is, and what is wrong."""
    fault = error.errors(include_url=False, include_input=False)[0]
    where = ".".join(map(str, fault["loc"]))
    text = fault["msg"].removeprefix("Value error, ")
    return f"{where}: {text}" if where else text
