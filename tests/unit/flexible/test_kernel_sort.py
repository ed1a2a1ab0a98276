"""The sort of the compiled solver against numpy's."""

import numpy as np
import pytest

from moyai.flexible.sparse import _sort


@pytest.mark.parametrize("kind", [np.int64, np.float64])
def test_a_stretch_is_sorted_and_the_rest_left(kind: type) -> None:
    random = np.random.default_rng(4)
    for size in (0, 1, 2, 3, 7, 40, 331):
        values = random.integers(-9, 30, size + 4).astype(kind)
        expected = values.copy()
        expected[2 : 2 + size].sort()
        _sort(values, 2, 2 + size)
        np.testing.assert_array_equal(values, expected)
