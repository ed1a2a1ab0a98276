"""Mean drift as loads on the units: by pressures on each hull, the far field keeps the sum [eq:units-shared-drift]."""

from __future__ import annotations

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.structures.units.assembly import RowAtLevel
from moyai.structures.units.near_field import NearField
from moyai.structures.units.response import RowModel, RowResponse


def share_drift(at: RowAtLevel, drift: Array) -> Array:
    """Return a drift force (3,) of the whole row as loads (m,), where nothing tells the units apart.

    Every unit bears the same force, and a couple of forces makes up the moment; of a single unit its yaw moment.
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


def drift_of_units(
    model: RowModel, response: RowResponse, whole: Array, rows: IntArray | None = None, columns: Array | None = None
) -> Array:
    """Return the mean drift of every unit as loads (r, c, m) per amplitude squared.

    Parameters
    ----------
    model : RowModel
    response : RowResponse
        At the frequencies of the coefficients.
    whole : ndarray (f, h, 3)
        Of the row by its far waves.
    rows, columns : ndarray of int, optional
        Frequencies and headings asked for; all when left out.
    """
    at, hydro = model.at, model.hydro
    chosen: IntArray = np.arange(len(whole)) if rows is None else rows
    headings: IntArray = np.arange(whole.shape[1]) if columns is None else columns.astype(np.int64)
    asked = whole[chosen][:, headings]
    if hydro.panels is None or at.row.count == 1:
        shared = np.array([share_drift(at, one) for one in np.eye(3)])
        return np.asarray(asked @ shared)
    field = NearField(at, hydro.panels)
    near = [
        field.drift(hydro.solutions[row].among(headings), hydro.headings[headings], response.motion[row, headings])
        for row in chosen
    ]
    return reconciled(at, np.array(near), asked)


def reconciled(at: RowAtLevel, near: Array, whole: Array) -> Array:
    """Return loads (..., m) of units by pressures (..., u, 3), changed so that their sum is that of the far field.

    What is left of a force goes to the units as the size of their own, what is left of the moment to all alike.
    """
    near = near.copy()
    for part in range(2):
        size = np.abs(near[..., part])
        size += 1e-9 * size.max(axis=-1, keepdims=True) + 1e-300
        left = whole[..., part] - near[..., part].sum(axis=-1)
        near[..., part] += left[..., None] * size / size.sum(axis=-1, keepdims=True)
    plan = at.centres[:, :2]
    moment = near[..., 2] + plan[:, 0] * near[..., 1] - plan[:, 1] * near[..., 0]
    near[..., 2] += ((whole[..., 2] - moment.sum(axis=-1)) / at.row.count)[..., None]
    out = np.zeros((*near.shape[:-2], at.size))
    out[..., 0::6], out[..., 1::6], out[..., 5::6] = near[..., 0], near[..., 1], near[..., 2]
    return out


__all__ = ["drift_of_units", "reconciled", "share_drift"]
