"""Whole numbers and lists of numbers that the parts of a network are given."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


def whole_numbers(values: ArrayLike, path: str) -> NDArray[np.int64]:
    """Return integers; refuse what an array of integers would cut or take for something else.

    Raises
    ------
    InputError
        For fractions, values that are not finite, masks of true and false, and what is no number.
    """
    try:
        given = np.asarray(values)
    except ValueError:
        raise InputError(f"{path} holds rows of unequal length", parameter=path, allowed="whole numbers") from None
    if given.dtype.kind in "iu" or given.size == 0:
        return given.astype(np.int64)
    if given.dtype.kind == "b":
        raise InputError(
            f"{path} holds true and false",
            parameter=path,
            allowed="whole numbers",
            remedy="numpy.flatnonzero of a mask",
        )
    if given.dtype.kind != "f":
        raise InputError(f"{path} holds what is no number", parameter=path, allowed="whole numbers")
    wrong = ~(np.isfinite(given) & (given == np.floor(given)))
    if wrong.any():
        raise InputError(f"{path} holds {given[wrong].flat[0]:g}", parameter=path, allowed="whole numbers")
    return given.astype(np.int64)


def whole_number(value: float, path: str, *, least: int) -> int:
    """Return one integer, ``least`` or more.

    Raises
    ------
    InputError
        For anything else.
    """
    given = whole_numbers(value, path)
    if given.shape != () or given < least:
        raise InputError(f"{path} is {value!r}", parameter=path, allowed=f"a whole number, {least} or more")
    return int(given)


def numbers_of(values: ArrayLike, path: str) -> NDArray[np.float64]:
    """Return an array of numbers.

    Raises
    ------
    InputError
        For words, and for rows of unequal length.
    """
    try:
        return np.array(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(
            f"{path} holds what is no number, or rows of unequal length", parameter=path, allowed="numbers"
        ) from None


def frozen(values: ArrayLike, dtype: Any, shape: tuple[int, ...], path: str) -> NDArray[Any]:
    """Return an array of this type and shape that nobody writes to.

    Raises
    ------
    InputError
        For another shape, and for values that are not finite or not of the type.
    """
    if dtype is np.int64:
        values = whole_numbers(values, path)
    if dtype is np.bool_ and not np.isin(np.asarray(values), (0, 1)).all():
        raise InputError(f"{path} holds what is neither true nor false", parameter=path, allowed="true or false")
    array = np.array(values, dtype=dtype)
    if array.ndim < len(shape):
        array = np.array(np.broadcast_to(array, shape))
    if array.shape != shape:
        raise InputError(f"{path} has shape {array.shape}", parameter=path, allowed=str(shape))
    if array.dtype.kind == "f" and not np.isfinite(array).all():
        raise InputError(f"{path} holds a value that is not finite", parameter=path, allowed="finite numbers")
    array = np.ascontiguousarray(array)
    array.setflags(write=False)
    return array


def require(ok: bool, message: str, path: str, allowed: str, remedy: str = "") -> None:
    """Raise InputError with this message where something does not hold."""
    if not ok:
        raise InputError(message, parameter=path, allowed=allowed, remedy=remedy)
