"""Kernels that make no array are compiled without counts of who holds one, all others with them."""

import sys
from pathlib import Path

import numpy as np
import pytest
from numba.typed import List

from moyai.core import compiled, uncounted
from moyai.core.compiled import njit

pytestmark = pytest.mark.skipif(not compiled._KNOWN, reason="another version of numba compiles as it does by itself")


@njit(error_model="numpy")
def rows_weighed(table, weights, pair):
    first, second = pair
    total = 0.0
    for i in range(table.shape[0]):
        row = table[i, 1:]
        for j in range(row.size):
            total += row[j] * weights[j] + first[i] - second[0]
        first[i] = table.T[0, i]
    return total


@njit(error_model="numpy")
def own_array(table):
    inner = np.ones(table.shape[1])
    return rows_weighed(table, inner, (inner, table[0]))


@njit(error_model="numpy")
def handed_back(table):
    return table[1]


@njit(error_model="numpy")
def chosen(table, rows, out):
    out[:] = table[rows].sum()
    return out[0]


@njit(error_model="numpy")
def copied(table, out):
    out[1:] = table[0, 1:]
    return out[1]


@njit(error_model="numpy")
def added_up(table, out):
    for i in range(out.size):
        out[i] = np.sum(table[i] * table[i])
    return out[0]


ROWS = np.array([0, 2])


@njit(error_model="numpy")
def rows_of_a_constant(table):
    return table[ROWS].sum()


@njit(error_model="numpy")
def doubled(table):
    for value in table:
        yield 2.0 * value


@njit(error_model="numpy")
def size_of(text, table):
    return len(text) + table.size


@njit(error_model="numpy")
def drawn(generator, table):
    table[0] = generator.random()
    return table[0]


@njit(error_model="numpy")
def longer(items):
    items.append(2.0)
    return len(items)


def _is_counted(kernel) -> bool:
    (signature,) = kernel.overloads
    return "NRT_incref" in kernel.inspect_llvm(signature) or "NRT_MemInfo" in kernel.inspect_llvm(signature)


def test_what_makes_no_array_is_not_counted() -> None:
    table = np.arange(12.0).reshape(3, 4)
    expected = sum(table[i, 1:] @ np.ones(3) + 3.0 * (1.0 - 2.0) for i in range(3))
    assert rows_weighed(table, np.ones(3), (np.ones(3), np.full(2, 2.0))) == pytest.approx(expected)
    assert not _is_counted(rows_weighed)


def test_what_makes_or_returns_one_is() -> None:
    table, out = np.arange(12.0).reshape(3, 4), np.zeros(3)
    ones = np.ones(4)
    assert own_array(table) == pytest.approx(rows_weighed.py_func(table, ones, (ones, table[0])))
    assert handed_back(table).tolist() == [4.0, 5.0, 6.0, 7.0]
    assert chosen(table, np.array([0, 2]), out) == 44.0
    assert copied(table, np.zeros(4)) == 1.0
    assert added_up(table, out) == 14.0
    for kernel in (own_array, handed_back, chosen, copied, added_up):
        assert _is_counted(kernel), kernel.py_func.__name__


def test_texts_generators_and_lists_are_counted() -> None:
    table = np.arange(12.0).reshape(3, 4)
    assert rows_of_a_constant(table) == 44.0
    values = doubled(table[0].copy())
    for _ in range(50):
        np.full(4, -7.0)
    assert list(values) == [0.0, 2.0, 4.0, 6.0]
    text, generator = "".join(["ab", "c"]), np.random.default_rng(1)
    held = sys.getrefcount(text), sys.getrefcount(generator.bit_generator)
    for _ in range(100):
        size_of(text, table)
        drawn(generator, table[0])
    assert (sys.getrefcount(text), sys.getrefcount(generator.bit_generator)) == held
    assert longer(List([1.0])) == 2
    for kernel in (rows_of_a_constant, size_of, drawn, longer):
        assert _is_counted(kernel), kernel.py_func.__name__


def test_what_chooses_them_belongs_to_the_key() -> None:
    source = compiled._source.__wrapped__
    assert Path(uncounted.__file__) in source(Path(compiled.__file__))[1]


def test_an_array_that_is_handed_back_outlives_the_kernel() -> None:
    table = np.arange(12.0).reshape(3, 4)
    before = sys.getrefcount(table)
    row = handed_back(table)
    del table
    for _ in range(100):
        own_array(np.zeros((3, 4)))
    assert row.tolist() == [4.0, 5.0, 6.0, 7.0]
    table = np.arange(12.0).reshape(3, 4)
    for _ in range(100):
        rows_weighed(table, np.ones(3), (np.ones(3), table[0].copy()))
    assert sys.getrefcount(table) == before
