"""Connectors that act along one direction: how far motion across it would stretch them besides.

In time a chain or rubber is drawn from end to end [eq:units-in-space]. The frequency domain, a ``direction`` of the
case and a spring with little stiffness across take the relative motion along one axis alone; sway and heave of the
units against each other draw it as well.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array
from moyai.core.validity import Notice
from moyai.structures.units.connectors import UnitJoint

if TYPE_CHECKING:
    import xarray as xr

#: Share of the largest elongation that motion across may add before the force is no more than a bound from below.
COUNTS = 0.1
#: Stiffness across over that along, below which a spring is a line from end to end without it.
SLENDER = 0.1


def stretch_across(joints: Sequence[UnitJoint], motion: Array, highest: Array, *, in_time: bool) -> Array:
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
        Zero where motion across does not matter, or does not count against the elongation along the axis.
    """
    span = np.array([joint.span if _on_one_axis(joint, in_time) else 0.0 for joint in joints])
    axis = np.array([j.axis if j.connector.stiffness is None else j.from_end_to_end for j in joints])
    axis = axis.reshape(len(joints), 3)
    across = np.sqrt(np.sum(motion**2 * np.maximum(1.0 - axis**2, 0.0), axis=-1))
    along = np.where(np.isnan(highest), np.sum(motion * np.abs(axis), axis=-1), highest)
    stretch = np.where(span > 0.0, np.hypot(span, across) - span, 0.0)
    return np.asarray(np.where(stretch > COUNTS * np.maximum(along, 0.0), stretch, 0.0))


def _on_one_axis(joint: UnitJoint, in_time: bool) -> bool:
    """Whether a connector carries along one axis alone that would carry from end to end."""
    if joint.connector.kind in ("chain", "rubber"):
        return not (in_time and joint.in_space)
    if joint.connector.stiffness is None or joint.span == 0.0:
        return False
    axis, stiffness = joint.from_end_to_end, joint.connector.stiffness[:3, :3]
    aside = np.eye(3) - np.outer(axis, axis)
    own = float(axis @ stiffness @ axis)
    return own > 0.0 and float(np.linalg.norm(aside @ stiffness @ aside, 2)) < SLENDER * own


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
            f"{most:.3g} m; it acts along one direction and does not resist it: its force is higher",
            value=most, severity="warning",
            remedy="run the analysis time, where chain and rubber are drawn from end to end"
            if analysis == "frequency"
            else "give chain or rubber without a direction, which is drawn from end to end",
        )  # fmt: skip
