"""Units of length and time by the names that people give them in headers."""

import re
from typing import Final

UNITS: Final = {
    "m": 1.0,
    "dm": 0.1,
    "cm": 0.01,
    "mm": 0.001,
    "km": 1000.0,
    "ft": 0.3048,
    "in": 0.0254,
    "yd": 0.9144,
}
"""Metres in each unit that `--unit` takes."""
PIXELS: Final = "px"
DEGREES: Final = "deg"
"""Of longitude and latitude, which become metres around their middle."""
METRES_A_DEGREE: Final = 111_319.49
MAX_METRES: Final = 100_000.0
"""Coordinates beyond this, either way, are taken for errors of the file."""

_LENGTHS: Final = {
    **{name: name for name in UNITS if name != "in"},
    **dict.fromkeys(("meter", "metre", "meters", "metres"), "m"),
    **dict.fromkeys(("decimeter", "decimetre", "decimeters", "decimetres"), "dm"),
    **dict.fromkeys(("centimeter", "centimetre", "centimeters", "centimetres"), "cm"),
    **dict.fromkeys(("millimeter", "millimetre", "millimeters", "millimetres"), "mm"),
    **dict.fromkeys(("kilometer", "kilometre", "kilometers", "kilometres"), "km"),
    **dict.fromkeys(("foot", "feet"), "ft"),
    **dict.fromkeys(("inch", "inches"), "in"),
    **dict.fromkeys(("yard", "yards"), "yd"),
    **dict.fromkeys(("px", "pix", "pixel", "pixels"), PIXELS),
    **dict.fromkeys(("deg", "degree", "degrees", "°"), DEGREES),
}
FRAMES: Final = 0.0
"""Stands among seconds for a count of frames."""
_TIMES: Final = {
    **dict.fromkeys(("s", "sec", "secs", "second", "seconds"), 1.0),
    **dict.fromkeys(("ms", "msec", "millisecond", "milliseconds"), 1e-3),
    **dict.fromkeys(("us", "µs", "μs", "microsecond", "microseconds"), 1e-6),
    **dict.fromkeys(("ns", "nanosecond", "nanoseconds"), 1e-9),
    **dict.fromkeys(("min", "minute", "minutes"), 60.0),
    **dict.fromkeys(("h", "hour", "hours"), 3600.0),
    **dict.fromkeys(("frame", "frames"), FRAMES),
}
_LENGTH: Final = (
    r"(m|dm|cm|mm|km|ft|yd|(?:deci|centi|milli|kilo)?met(?:er|re)s?|feet|inch(?:es)?|yards?"
    r"|px|pixels?)"
)
_SAID: Final = (
    re.compile(
        rf"\b(?:in|units?(?:\s+of\s+length)?\s*(?:[:=]|is|are)?)\s*[\[(\"']?{_LENGTH}\b",
        re.IGNORECASE,
    ),
    re.compile(rf"[\[(]\s*{_LENGTH}\s*[\])]"),
)
"""Ways in which comments speak of a unit of length, the surer first."""


def length_named(text: str) -> str | None:
    """The unit of length of this name, such as "cm" for centimetres; None if it is none."""
    return _LENGTHS.get(text.strip().lower())


def time_named(text: str) -> float | None:
    """The seconds in the unit of time of this name; `FRAMES` for frames, None if it is none."""
    return _TIMES.get(text.strip().lower())


def length_said(comment: str) -> str | None:
    """The unit of length that a comment speaks of, as in "coordinates in cm"."""
    found = next(filter(None, (form.search(comment) for form in _SAID)), None)
    return length_named(found[1]) if found else None
