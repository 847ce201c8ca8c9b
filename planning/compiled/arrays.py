"""The types of the arrays that kernels, and the modules beside them, take and return.

Docstrings say the shape and the unit of each array: `float64 (N, 3), metres`.
"""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]
