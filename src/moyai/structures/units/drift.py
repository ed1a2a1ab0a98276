"""Mean drift as loads on the units: by pressures on each hull, the far field keeps the sum [eq:units-shared-drift]."""

from __future__ import annotations

import numpy as np

from moyai.core.arrays import Array, ComplexArray, IntArray
from moyai.structures.units.assembly import RowAtLevel
from moyai.structures.units.near_field import NearField
from moyai.structures.units.response import RowModel


def share_drift(at: RowAtLevel, drift: Array) -> Array:
    """Return a drift force (3,) of the whole row as loads (m,), where nothing separates the units.

    Every unit carries the same force, and a couple of forces makes up the moment; of a single unit its yaw moment.
    """
    out = np.zeros(at.size)
    count = at.row.count
    plan = at.centres[:, :2]
    middle = plan.mean(axis=0)
    out[0::6], out[1::6] = drift[0] / count, drift[1] / count
    left = drift[2] - (middle[0] * drift[1] - middle[1] * drift[0])
    arm = plan - middle
    square = float((arm**2).sum())
    if square == 0.0:
        out[5] = left
    else:
        out[0::6] -= left * arm[:, 1] / square
        out[1::6] += left * arm[:, 0] / square
    return out


def near_drift(
    model: RowModel, motion: ComplexArray, rows: IntArray | None = None, columns: IntArray | None = None
) -> Array | None:
    """Return what pressures on the hulls give every unit (r, c, u, 3) per amplitude squared.

    Parameters
    ----------
    model : RowModel
    motion : ndarray (f, h, m)
        At the frequencies and headings of the coefficients.
    rows, columns : ndarray of int, optional
        Frequencies and headings asked for; all when left out.

    Returns
    -------
    ndarray or None
        None of a single unit, and of coefficients from a file, which has no pressures.
    """
    at, hydro = model.at, model.hydro
    if hydro.panels is None or at.row.count == 1:
        return None
    chosen: IntArray = np.arange(len(hydro.omega)) if rows is None else rows
    headings: IntArray = np.arange(len(hydro.headings)) if columns is None else columns
    field = NearField.of(at, hydro.panels)
    return np.array(
        [
            field.drift(hydro.solutions[row].among(headings), hydro.headings[headings], motion[row, headings])
            for row in chosen
        ]
    )


def reconciled(at: RowAtLevel, near: Array | None, whole: Array) -> Array:
    """Return loads (..., m) of units by pressures (..., u, 3), changed so that their sum is that of the far field.

    What is left of a force goes to the units as the size of their own, what is left of the moment to all alike. Without
    pressures the whole is shared alike.
    """
    if near is None:
        return np.asarray(whole @ np.array([share_drift(at, one) for one in np.eye(3)]))
    near = near.copy()
    # by the size of the vector: the shares do not depend on how the axes of the row lie
    size = np.linalg.norm(near[..., :2], axis=-1)
    size += 1e-9 * size.max(axis=-1, keepdims=True) + 1e-300
    left = whole[..., :2] - near[..., :2].sum(axis=-2)
    near[..., :2] += left[..., None, :] * (size / size.sum(axis=-1, keepdims=True))[..., None]
    plan = at.centres[:, :2]
    moment = near[..., 2] + plan[:, 0] * near[..., 1] - plan[:, 1] * near[..., 0]
    near[..., 2] += ((whole[..., 2] - moment.sum(axis=-1)) / at.row.count)[..., None]
    out = np.zeros((*near.shape[:-2], at.size))
    out[..., 0::6], out[..., 1::6], out[..., 5::6] = near[..., 0], near[..., 1], near[..., 2]
    return out


__all__ = ["near_drift", "reconciled", "share_drift"]
