"""What realisations of a sea give, as a table and as a figure."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from moyai.core.arrays import Array
from moyai.report.document import Abscissa, Column, Figure, Panel, Series, Table
from moyai.report.reading import common_scale
from moyai.series.intervals import reach_of_mean

#: Realisations from which their exceedance is drawn, and lines in it.
LEAST_REALISATIONS, MOST_LINES = 4, 6


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
    found = _complete(tension)
    if found is None or found.shape[0] < 2:
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


def realisations_figure(key: str, sea: str, lines: Sequence[str], tension: Array | None) -> Figure | None:
    """Return the share of the realisations whose highest tension passes a value, with the interval of chance.

    Parameters
    ----------
    key, sea, lines, tension
        As of :func:`realisations_table`; ``None`` of fewer than ``LEAST_REALISATIONS``.
    """
    from scipy.special import betaincinv

    given = _complete(tension)
    if given is None or given.shape[0] < LEAST_REALISATIONS:
        return None
    found = np.sort(given, axis=0)[::-1]
    count = found.shape[0]
    order = np.argsort(found.mean(axis=0))[::-1][:MOST_LINES]
    factor, unit = common_scale("N", found[:, order])
    rank = np.arange(1, count + 1)
    series = [
        Series(lines[k], {"tension": factor * found[:, k]}, rank / (count + 1.0), 0, tone, style="line+points")
        for tone, k in enumerate(order)
    ]
    for share in (0.05, 0.95):
        # the share of all realisations beyond the r-th of n follows a beta law
        ends = betaincinv(rank, count + 1 - rank, share)
        label = f"{100.0 * share:g} % end of chance"
        series.append(
            Series(label, {"tension": factor * found[:, order[0]]}, ends, 0, 0, dash="dash", faint=True,
                   belongs_to=lines[order[0]])
        )  # fmt: skip
    return Figure(
        key,
        f"Realisations that pass a highest tension: {sea}",
        (Abscissa("tension", "highest tension of the run", unit),),
        (Panel("part of the realisations", limits=(0.0, 1.0)),),
        tuple(series),
        "Weibull positions r / (n + 1); dashed: where 90 of 100 sets of as many realisations put the first line.",
    )


def _complete(tension: Array | None) -> Array | None:
    """Return the realisations that ended, ``None`` where there are no lines."""
    if tension is None or not tension.shape[1]:
        return None
    return np.asarray(tension[np.isfinite(tension).all(axis=1)])
