"""Tables of what realisations of a sea give."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from moyai.core.arrays import Array
from moyai.report.document import Column, Table
from moyai.series.intervals import reach_of_mean


def realisations_table(key: str, sea: str, lines: Sequence[str], tension: Array | None) -> Table | None:
    """Return the largest tensions of the realisations of a sea, ``None`` of fewer than two.

    Parameters
    ----------
    key : str
        Of the table.
    sea : str
        Its name.
    lines : sequence of str
        Their names.
    tension : ndarray, shape (realisations, lines), or None
        Highest of each line in each [N]; rows with a number that is not finite are left out.
    """
    if tension is None or not tension.shape[1]:
        return None
    found = tension[np.isfinite(tension).all(axis=1)]
    if found.shape[0] < 2:
        return None
    mean = found.mean(axis=0)
    reach = np.array([reach_of_mean(column) for column in found.T])
    columns = {
        "Mean": mean,
        "its 95 % end": mean + reach,
        "Standard deviation": found.std(axis=0, ddof=1),
        "Smallest": found.min(axis=0),
        "Largest": found.max(axis=0),
    }
    return Table(
        key,
        f"Highest tension in {found.shape[0]} realisations: {sea}",
        (Column("Line", list(lines)), *(Column(name, list(values), "N") for name, values in columns.items())),
        note="Each realisation has other phases of the same waves; the other tables and figures show the first. "
        "95 % end: of the one-sided interval of the mean.",
    )
