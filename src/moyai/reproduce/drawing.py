"""Short ways to the figures of a paper: curves and points over one or two abscissae, and drawings of a run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Literal

import numpy as np

from moyai.core.arrays import Array
from moyai.core.options import checks_words
from moyai.report.document import Abscissa, Drawing, Figure, Panel, Series

if TYPE_CHECKING:
    from moyai.core.results import Result


@checks_words
def curve(
    label: str,
    x: Mapping[str, Array],
    y: Array,
    tone: int = 0,
    *,
    dash: Literal["solid", "dash", "dot", "dashdot"] = "solid",
    points: bool = False,
    faint: bool = False,
) -> Series:
    """Return a curve, or points joined by nothing."""
    arrays = {key: np.asarray(value, dtype=float) for key, value in x.items()}
    return Series(
        label, arrays, np.asarray(y, dtype=float), 0, tone, "points" if points else "line", dash=dash, faint=faint
    )


def figure(
    number: str,
    title: str,
    axes: Sequence[Abscissa],
    ordinate: Panel,
    series: Sequence[Series],
    caption: str = "",
    height: int = 330,
) -> Figure:
    """Return a figure with one panel, named by its number in the paper.

    Parameters
    ----------
    number, title : str
    axes : sequence of Abscissa
    ordinate : Panel
    series : sequence of Series
    caption : str
    height : int
        [px].
    """
    return Figure(
        f"figure-{number}",
        f"Figure {number}: {title}",
        tuple(axes),
        (ordinate,),
        tuple(series),
        caption,
        height=height,
    )


def drawing_of(result: Result, number: str, title: str, key: str) -> Drawing | None:
    """Return a drawing of the report of a run under the number of the paper; ``None`` where the report has none.

    Parameters
    ----------
    result : Result
    number, title : str
    key : str
        End of the drawing's own key in the report.
    """
    from moyai.core.kinds import kind_of_result

    kind = kind_of_result(str(result.tree.attrs["structure"]))
    assert kind is not None
    for block in kind.compose(result).blocks():
        if isinstance(block, Drawing) and block.key.endswith(key):
            return Drawing(f"figure-{number}", f"Figure {number}: {title}", block.svg, block.fixed_svg, block.caption)
    return None
