"""Differences in height that decide which bodies meet and which floor is meant."""

from typing import Final

BODIES_OVERLAP_M: Final = 1.8
"""Bodies whose feet are further apart in height than this cannot touch: the height of an adult."""
SAME_FLOOR_M: Final = 1.5
"""Places whose heights differ by less are on one floor, as far as sight and talk go."""
SAME_SURFACE_M: Final = 1.0
"""A height that is given with a place means a surface no further off than this."""
STOREYS_APART_M: Final = BODIES_OVERLAP_M
"""Floors nearer to each other belong to one storey: nobody stands upright between them."""
LEVEL_M: Final = 0.3
"""Floors within this of each other count as one height."""
