"""The band of the damping of a row in time: its seas run again with the damping at the ends, where curves carry.

The change that the frequency domain finds is taken elsewhere. Where a connector goes slack or a line comes taut its
stiffness there is that of one mean motion, and says nothing of what more or less motion does to the largest load.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.progress import Progress
from moyai.sea.states import IrregularSea, RegularSea
from moyai.structures.units.assembly import RowAtLevel
from moyai.structures.units.datasets import BANDED
from moyai.structures.units.model import SNAP_RATIO
from moyai.structures.units.seas import SeaAnswer
from moyai.structures.units.time.analysis import SeaInTime, numbers_of, runs_of
from moyai.structures.units.time.datasets import KeptRun
from moyai.structures.units.time.seas import Water3D
from moyai.structures.units.variables import labelled

if TYPE_CHECKING:
    import xarray as xr

_TENSION = "line_tension_maximum"


def curves_matter(at: RowAtLevel, frequency: xr.Dataset, time: xr.Dataset) -> bool:
    """Whether a connector has a curve, or lines at rest are pulled beyond the range of their tangent.

    In the frequency domain with any damping of its band: where it lets lines come taut, its change is none of time.
    """
    if any(joint.connector.curve is not None for joint in at.joints):
        return True
    pulled = [(data, name) for data in (frequency, time) for name in (_TENSION, f"{_TENSION}_high") if name in data]
    return any(bool((data[name] > SNAP_RATIO * data["line_tension_mean"]).any()) for data, name in pulled)


def with_ends_in_time(
    water: Water3D, sea: RegularSea | IrregularSea, found: SeaInTime,
    others: Sequence[tuple[RowAtLevel, list[SeaAnswer]]], progress: Progress,
) -> SeaInTime:  # fmt: skip
    """Return what a sea gave, its numbers with the range that the ends of the damping give in time.

    Lines in motion change as lines at rest do. An end that does not come to its end leaves the range of the frequency
    domain.

    Parameters
    ----------
    water : Water3D
    sea : RegularSea or IrregularSea
    found : SeaInTime
        With the damping as given.
    others : sequence of (RowAtLevel, list of SeaAnswer)
        The row with its damping at the ends, and where its seas rest.
    progress : Progress
    """
    data = found.groups[""]
    still = f"{_TENSION}_lines_at_rest"
    own = {name: data[still if name == _TENSION and still in data else name].values for name in BANDED if name in data}
    ends = []
    for row, answers in others:
        try:
            runs, stopped = runs_of(replace(water, at=row), sea, answers, KeptRun.of, progress)
        except KeyboardInterrupt:
            stopped = True
        if stopped:
            return replace(found, status="interrupted")
        if any(run.status != "converged" for run in runs):
            return found
        ends.append(numbers_of(row, sea, runs))
    ranged = {}
    for name, values in own.items():
        with np.errstate(divide="ignore", invalid="ignore"):
            ratios = np.array([np.where(values > 0.0, end[name].values / values, 1.0) for end in ends])
        for end_name, pick in (("low", np.minimum), ("high", np.maximum)):
            ranged[f"{name}_{end_name}"] = (data[name].dims, data[name].values * pick.reduce(ratios, initial=1.0))
    return replace(found, groups={**found.groups, "": labelled(data.assign(ranged))})
