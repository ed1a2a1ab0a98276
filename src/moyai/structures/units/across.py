"""Chains and rubber that act along one direction: how far motion across it would stretch them besides.

In time a chain or rubber is drawn from end to end [eq:units-in-space]. The frequency domain, and a ``direction`` of the
case, take the relative motion along one axis alone; sway and heave of the units against each other draw it as well.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array
from moyai.core.validity import Notice
from moyai.structures.units.connectors import Joint

if TYPE_CHECKING:
    import xarray as xr

#: Share of the largest elongation that motion across may add before the force is no more than a bound from below.
COUNTS = 0.1


def stretch_across(joints: Sequence[Joint], motion: Array, highest: Array, *, in_time: bool) -> Array:
    """Return what the largest motion across stretches every connector by besides [m].

    Parameters
    ----------
    joints : sequence of Joint
    motion : ndarray (..., joints, 3)
        Largest relative motion [m].
    highest : ndarray (..., joints)
        Highest elongation [m].
    in_time : bool
        Whether connectors between their ends follow them in space.

    Returns
    -------
    ndarray (..., joints)
        Zero where motion across does not matter, or does not count beside the elongation along the axis.
    """
    span = np.array(
        [j.span if j.connector.kind in ("chain", "rubber") and not (in_time and j.in_space) else 0.0 for j in joints]
    )
    axis = np.array([joint.axis for joint in joints]).reshape(len(joints), 3)
    across = np.sqrt(np.sum(motion**2 * np.maximum(1.0 - axis**2, 0.0), axis=-1))
    stretch = np.where(span > 0.0, np.hypot(span, across) - span, 0.0)
    return np.asarray(np.where(stretch > COUNTS * np.maximum(np.nan_to_num(highest), 0.0), stretch, 0.0))


def across_notices(groups: Mapping[str, xr.Dataset]) -> Iterator[Notice]:
    """Warn of the connector that motion across would stretch most, for every level."""
    worst: dict[str, tuple[float, str, str]] = {}
    for path, sea in groups.items():
        parts = path.strip("/").split("/")
        if "/frequency/" in path and path.replace("/frequency/", "/time/") in groups:
            continue  # what is shown is that of time
        stretch = sea["stretch_across"].values if "stretch_across" in sea else np.zeros(0)
        if stretch.any():
            index = np.unravel_index(int(np.argmax(stretch)), stretch.shape)
            found = float(stretch[index]), f"{parts[2]}, {sea['connector'].values[index[-1]]}", parts[1]
            worst[parts[0]] = max(worst.get(parts[0], (0.0, "", "")), found)
    for level, (most, where, analysis) in worst.items():
        yield Notice(
            "motion-across-connector",
            f"{level}, {where}: the units move against each other across the connector, which would stretch it by "
            f"{most:.3g} m; its curve acts along one direction and does not see it: its force is higher",
            value=most, severity="warning",
            remedy="run the analysis time, where it is drawn from end to end"
            if analysis == "frequency"
            else "leave its direction out, so that it is drawn from end to end",
        )  # fmt: skip
