"""What is done once while kernels are compiled leaves types, flags and results as numba has them."""

import math
import operator
import subprocess
import sys
from itertools import product

import numpy as np
import pytest
from numba import types
from numba.core.compiler import Flags
from numba.core.registry import cpu_target
from numba.core.types.functions import BaseFunction

from moyai.core.compiled import _KNOWN, njit

pytestmark = pytest.mark.skipif(not _KNOWN, reason="kernels are compiled as numba does it by itself")

NUMBERS = (types.int64, types.float64, types.complex128, types.boolean, types.literal(3))
CALLS = (operator.add, operator.truediv, operator.pow, operator.lt, operator.mod, operator.and_, max, math.atan2)


@pytest.mark.slow
def test_signatures_are_those_of_numba() -> None:
    context = cpu_target.typing_context
    context.refresh()
    for call, pair in product(CALLS, product(NUMBERS, NUMBERS)):
        function = context.resolve_value_type(call)
        try:
            expected = BaseFunction.get_call_type(function, context, pair, {})
        except Exception as error:
            with pytest.raises(type(error)):
                function.get_call_type(context, pair, {})
            continue
        for _ in range(2):
            assert function.get_call_type(context, pair, {}) == expected
            assert function.get_impl_key(expected) is not None


def test_flags_are_equal_where_all_their_values_are() -> None:
    kinds = []
    for nrt, wrapper, model in product((None, False, True), (None, False, True), (None, "numpy", "python")):
        flags = Flags()
        for name, value in (("nrt", nrt), ("no_cpython_wrapper", wrapper), ("error_model", model)):
            if value is not None:
                setattr(flags, name, value)
        kinds.append(flags)
    for one, other in product(kinds, kinds):
        assert (one == other) == (one.values() == other.values())
    assert kinds[0] != "flags"


def test_an_array_that_does_not_fit_a_slice_is_refused() -> None:
    @njit()
    def put(target, values):
        target[1:4] = values

    out = np.zeros(5)
    put(out, np.arange(3.0))
    assert out.tolist() == [0.0, 0.0, 1.0, 2.0, 0.0]
    with pytest.raises(ValueError, match="shapes of the array and of the slice differ"):
        put(out, np.arange(2.0))


@pytest.mark.slow
def test_numbers_of_other_types_between_give_their_own_code() -> None:
    @njit()
    def halves(x, y):
        return x / y, x + y, x * y

    assert halves(1, 2) == (0.5, 3, 2)
    assert halves(1.0, 2) == (0.5, 3.0, 2.0)
    assert halves(1j, 2.0) == (0.5j, 2.0 + 1j, 2j)
    assert halves(True, 2) == (0.5, 3, 2)


@pytest.mark.slow
def test_numba_of_another_version_is_left_as_it_is() -> None:
    script = (
        "import numba; numba.__version__ = '0.99.0'\n"
        "from numba.core.types import Function; before = Function.get_call_type\n"
        "import moyai.core.compiled; print(Function.get_call_type is before)"
    )
    done = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True)
    assert done.stdout.strip() == "True"
