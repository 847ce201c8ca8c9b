"""Units of length by the names that files of meshes give them."""

from typing import Final

_METRES: Final = {
    **dict.fromkeys(("mm", "millimeter", "millimetre"), 1e-3),
    **dict.fromkeys(("cm", "centimeter", "centimetre"), 1e-2),
    **dict.fromkeys(("dm", "decimeter", "decimetre"), 0.1),
    **dict.fromkeys(("m", "meter", "metre"), 1.0),
    **dict.fromkeys(("km", "kilometer", "kilometre"), 1e3),
    **dict.fromkeys(("in", "inch", "inche"), 0.0254),
    **dict.fromkeys(("ft", "foot", "feet"), 0.3048),
    **dict.fromkeys(("yd", "yard"), 0.9144),
}


def metres_in(unit: str) -> float | None:
    """The metres in a unit, of one or of many; None for a name that is not known."""
    name = unit.lower()
    return _METRES.get(name, _METRES.get(name.removesuffix("s")))
