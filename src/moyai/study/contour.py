"""Sea states round an environmental contour, from a joint distribution or from the pairs that it is fitted to."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.study import schema
from moyai.study.rows_of_files import column_of, read_rows


def contour_seas(given: schema.ContourKeys, folder: Path) -> tuple[Array, Array]:
    """Return significant heights [m] and periods [s] round a contour, calm points left out.

    Parameters
    ----------
    given : Contour
        As read.
    folder : Path
        From which the study file names other files.

    Raises
    ------
    InputError
        For a distribution without sense, pairs that cannot be read, or a contour without points.
    """
    from moyai.design.long_term import JointSea, environmental_contour, fit_joint_sea
    from moyai.series.extremes import ExtremeFit

    if given.joint is not None:
        one = given.joint
        sea = JointSea(
            ExtremeFit("weibull", one.location, one.scale, one.shape, 0, float("nan")), one.mean_log, one.deviation_log
        )
    else:
        assert given.pairs is not None
        height, period = _pairs(given.pairs, folder)
        sea = fit_joint_sea(height, period, lower_end=given.pairs.location)
    heights, periods = environmental_contour(sea, given.years, given.duration, given.count)
    if not (np.isfinite(heights).all() and np.isfinite(periods).all()):
        raise InputError("the joint distribution gives no finite sea states", path="contour.joint")
    kept = heights >= max(given.least_height, 1e-6)
    if not kept.any():
        raise InputError(
            f"no sea state of the contour reaches {given.least_height:g} m",
            path="contour.least_height",
            allowed=f"up to {heights.max():.3g} m",
        )
    return heights[kept], periods[kept]


def _pairs(given: schema.PairsOfSeas, folder: Path) -> tuple[Array, Array]:
    file = folder / given.file
    rows = read_rows(file)
    columns = []
    for column in (given.significant_height, given.period):
        heading, _ = column_of(rows, column, file, "contour.pairs")
        values = []
        for number, row in enumerate(rows, start=2):
            try:
                values.append(float(row[heading]))
            except (TypeError, ValueError):
                message = f"{file.name}, row {number}: '{row[heading]}' is no number"
                raise InputError(message, path="contour.pairs") from None
        columns.append(np.array(values))
    return columns[0], columns[1]
