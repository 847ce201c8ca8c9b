"""The look of an avatar: clothes, hair, skin, stature and a sign, as small whole numbers."""

from typing import Annotated, Any, Final, NamedTuple

from pydantic import PlainSerializer, PlainValidator, WithJsonSchema


class Look(NamedTuple):
    """The parts of a look. A part that is 0 is not chosen: it follows from the avatar's id."""

    shirt: int = 0
    trousers: int = 0
    hair: int = 0
    """The fashion of the hair."""
    hair_colour: int = 0
    skin: int = 0
    stature_cm: int = 0
    """From the ground to the top of the head."""
    sign: int = 0
    """1 for a sign above the head, by which guides are found. Nobody can choose one."""


NO_LOOK: Final = Look()

MOST: Final = Look(shirt=12, trousers=8, hair=5, hair_colour=8, skin=8, stature_cm=200, sign=1)
"""The greatest number of each part."""
SHORTEST_CM: Final = 150
"""The least stature that can be chosen."""
CHOSEN: Final = Look._fields[:-1]
"""The parts that a person chooses."""


def checked_look(value: Any) -> Look:
    """The look that a client asks for.

    Raises
    ------
    ValueError
        It is not a whole number for each part that can be chosen, or a part has a number that
        does not exist; the message names the part.
    """
    told = parts_of(value) if isinstance(value, Look) else value
    parts = list(told) if isinstance(told, list | tuple) else []
    if len(parts) != len(CHOSEN):
        raise ValueError(f"a look is the array [{', '.join(CHOSEN)}]")
    for name, part in zip(CHOSEN, parts, strict=True):
        if type(part) is not int:
            raise ValueError(f"{name} is {part!r:.20}, and no whole number")
        if not _exists(name, part):
            raise ValueError(f"{name} is {part}; it can be 0 or {_range_of(name)}")
    return Look(*parts)


def known_look(value: Any) -> Look:
    """The look that another program tells of; parts that this one does not know are not chosen."""
    parts = list(value) if isinstance(value, list | tuple) else []
    known = zip(Look._fields, parts, strict=False)
    return Look(**{name: part for name, part in known if type(part) is int and _exists(name, part)})


def parts_of(look: Look) -> list[int]:
    """The look as it is told; a sign is left out where there is none."""
    return list(look if look.sign else look[:-1])


def _exists(name: str, part: int) -> bool:
    return part == 0 or _least(name) <= part <= getattr(MOST, name)


def _least(name: str) -> int:
    return SHORTEST_CM if name == "stature_cm" else 1


def _range_of(name: str) -> str:
    return f"{_least(name)} to {getattr(MOST, name)}"


_AS_LIST: Final = PlainSerializer(parts_of, return_type=list[int])
_CHOSEN_SCHEMA: Final[dict[str, Any]] = {
    "type": "array",
    "items": [
        {"title": name, "type": "integer", "minimum": 0, "maximum": getattr(MOST, name)}
        for name in CHOSEN
    ],
    "minItems": len(CHOSEN),
    "maxItems": len(CHOSEN),
}
_KNOWN_SCHEMA: Final[dict[str, Any]] = {"type": "array", "items": {"type": "integer"}}
ChosenLook = Annotated[Look, PlainValidator(checked_look), _AS_LIST, WithJsonSchema(_CHOSEN_SCHEMA)]
"""A look as clients send it."""
KnownLook = Annotated[Look, PlainValidator(known_look), _AS_LIST, WithJsonSchema(_KNOWN_SCHEMA)]
"""A look as other programs of the server, and servers, tell it."""
