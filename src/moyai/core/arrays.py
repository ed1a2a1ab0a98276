"""Types of arrays."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

#: Bits of an index. ``index & PLAIN`` is not negative, at which the compiler would look before every access with an
#: index out of an array.
PLAIN = 0xFFFFFFF
