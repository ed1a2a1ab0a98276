"""Numbers that loggers write for 'no value', known by their look and by how far they lie from all others."""

from __future__ import annotations

import numpy as np

from moyai.core.arrays import Array

#: Numbers that loggers write for 'no value', of either sign
_STAND_INS = (
    99.0, 99.9, 99.99, 999.0, 999.9, 999.99, 9999.0, 9999.9, 9999.99, 99999.0, 999999.0, 32767.0, 32768.0, 1e20, 1e30,
)  # fmt: skip


def find_stand_ins(values: Array) -> list[tuple[float, int, int]]:
    """Return numbers that stand for 'no value' by their look: the number, how often, and its first sample.

    Such a number (-99, 9999) lies farther outside of all other values than these span.

    Parameters
    ----------
    values : ndarray, shape (samples,)
        As the file has them, before scale and unit.
    """
    if not (np.abs(values) >= _STAND_INS[0]).any():
        return []
    looks = np.isin(np.abs(values), _STAND_INS)
    others = values[np.isfinite(values) & ~looks]
    if not looks.any() or not others.size:
        return []
    low, high = float(others.min()), float(others.max())
    outside = looks & ((values > high + (high - low)) | (values < low - (high - low)))
    return [
        (float(sign), int(np.count_nonzero(values == sign)), int(np.argmax(values == sign)))
        for sign in np.unique(values[outside])
    ]
