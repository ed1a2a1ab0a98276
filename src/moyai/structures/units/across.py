"""Chains and rubber that act along one direction: how far motion across it would stretch them besides.

A curve takes the relative motion along its axis alone [eq:units-motion]; a chain between two units is drawn from end to
end, and sways and heaves of the units against each other draw it as well.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array
from moyai.core.validity import Notice

if TYPE_CHECKING:
    import xarray as xr

#: Share of the largest elongation that motion across may add before the force is no more than a bound from below.
COUNTS = 0.1


def stretch_across(statics: xr.Dataset, sea: xr.Dataset) -> Array:
    """Return what the largest motion across stretches every connector, with the dimensions of its elongation [m].

    Parameters
    ----------
    statics : xarray.Dataset
        Of the level, with ``connector_span`` and ``connector_axis``.
    sea : xarray.Dataset
        With ``relative_motion_largest``.

    Returns
    -------
    ndarray (..., connectors)
        Zero where motion across does not matter, or does not count beside the elongation along the axis.
    """
    motion = np.asarray(sea["relative_motion_largest"].values)
    if "connector_span" not in statics or not motion.size:
        return np.zeros(motion.shape[:-1])
    span = np.nan_to_num(statics["connector_span"].values)
    across = np.sqrt(np.sum(motion**2 * np.maximum(1.0 - statics["connector_axis"].values ** 2, 0.0), axis=-1))
    stretch = np.where(span > 0.0, np.hypot(span, across) - span, 0.0)
    along = np.maximum(np.nan_to_num(sea["elongation_highest"].values), 0.0)
    return np.asarray(np.where(stretch > COUNTS * along, stretch, 0.0))


def across_notices(groups: Mapping[str, xr.Dataset]) -> Iterator[Notice]:
    """Warn of the connector that motion across would stretch most, for every level."""
    worst: dict[str, tuple[float, str]] = {}
    for path, sea in groups.items():
        parts = path.strip("/").split("/")
        if len(parts) != 3 or parts[1] not in ("frequency", "time") or "relative_motion_largest" not in sea:
            continue
        stretch = stretch_across(groups[f"/{parts[0]}/statics"], sea)
        if stretch.any():
            index = np.unravel_index(int(np.argmax(stretch)), stretch.shape)
            found = float(stretch[index]), f"{parts[2]}, {sea['connector'].values[index[-1]]}"
            worst[parts[0]] = max(worst.get(parts[0], (0.0, "")), found)
    for level, (most, where) in worst.items():
        yield Notice(
            "motion-across-connector",
            f"{level}, {where}: the units move against each other across the connector, which would stretch it by "
            f"{most:.3g} m; its curve acts along one direction and does not see it: its force is higher",
            value=most, severity="warning",
            remedy="hold sway and heave between the units (guide, spring or hinge), or put the connector along them",
        )  # fmt: skip
