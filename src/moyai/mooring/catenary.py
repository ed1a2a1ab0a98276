"""Exact elastic catenary of uniform lines: arrays in, arrays out (theory: docs/theory/mooring.md)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array, IntArray
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.single import plain
from moyai.mooring import kernels


@dataclass(frozen=True)
class CatenarySolution:
    """Forces and stiffness of one or many uniform lines at rest; every array has the broadcast shape of the inputs,
    floats for a single line.

    Forces are those of the fairlead on the line: H away from the anchor, V upwards. The line pulls the anchor with
    ``horizontal_tension_anchor`` towards the fairlead and ``vertical_tension_anchor`` upwards.
    """

    #: Horizontal tension at the fairlead [N]; constant along the part that is clear of the bed.
    horizontal_tension: Array
    #: Vertical tension at the fairlead [N], positive where the line rises towards the fairlead.
    vertical_tension_fairlead: Array
    #: Vertical tension at the anchor [N], positive where the line rises towards the fairlead.
    vertical_tension_anchor: Array
    #: Horizontal tension at the anchor [N], lowered by bed friction.
    horizontal_tension_anchor: Array
    #: Unstretched length on the bed [m].
    grounded_length: Array
    #: ``[[dH/dX, dH/dZ], [dV/dX, dV/dZ]]`` of the fairlead [N/m], last two axes; not symmetric with bed friction.
    stiffness: Array
    #: Largest error of the end position that the forces give back, over the line length.
    residual: Array
    #: Codes of :mod:`moyai.mooring.kernels`, in words from :attr:`regime_names`.
    regime: IntArray | int

    @property
    def tension_fairlead(self) -> Any:
        """Tension at the fairlead [N]."""
        return plain(np.hypot(self.horizontal_tension, self.vertical_tension_fairlead))

    @property
    def tension_anchor(self) -> Any:
        """Tension at the anchor [N]."""
        return plain(np.hypot(self.horizontal_tension_anchor, self.vertical_tension_anchor))

    @property
    def anchor_uplift_angle(self) -> Any:
        """Angle of the line at the anchor above the horizontal [rad]; 0 while it leaves the anchor on the bed."""
        return plain(np.arctan2(self.vertical_tension_anchor, self.horizontal_tension_anchor))

    @property
    def regime_names(self) -> Any:
        """The regime in words, one string per line (a single string for scalar input)."""
        names = np.array(kernels.REGIME_NAMES)[self.regime]
        return str(names) if names.ndim == 0 else names


def _require(condition: NDArray[np.bool_], values: Array, path: str, allowed: str, remedy: str = "") -> None:
    if not np.all(condition):
        worst = np.extract(~condition, values)[0]
        raise InputError(f"{path.replace('_', ' ')} is {worst:g}", parameter=path, allowed=allowed, remedy=remedy)


@checks_words
def solve_catenary(
    horizontal_distance: ArrayLike,
    vertical_distance: ArrayLike,
    unstretched_length: ArrayLike,
    axial_stiffness: ArrayLike,
    submerged_weight: ArrayLike,
    *,
    bed: bool = True,
    bed_friction: ArrayLike = 0.0,
    bed_clearance: ArrayLike = 0.0,
) -> CatenarySolution:
    """Solve uniform elastic lines exactly, whatever their regime.

    Equations ``[eq:mooring-suspended]`` and ``[eq:mooring-grounded]``: the stretched catenary of Irvine (1981),
    Cable Structures, ch. 2, each reduced to one scalar equation with one root.

    Parameters
    ----------
    horizontal_distance, vertical_distance : array_like
        From anchor to fairlead [m]; horizontal not negative, vertical of any sign (with a bed the fairlead must not lie
        under it).
    unstretched_length : array_like
        [m]; may be shorter than the chord.
    axial_stiffness : array_like
        EA [N]; ``inf`` for an inextensible line.
    submerged_weight : array_like
        Weight in water per unstretched metre [N/m]; 0 or negative (buoyant) allowed.
    bed : bool
        Whether a horizontal bed carries the line.
    bed_friction : array_like
        Coulomb coefficient mu [-]; tension falls by mu w per grounded metre from the touchdown towards the anchor, not
        below 0. It is left out where the anchor is above the bed.
    bed_clearance : array_like
        Height of the anchor over the bed [m], 0 for an anchor on the bed.

    Returns
    -------
    CatenarySolution
        Forces [N] at both ends, the length on the bed [m] and the regime, in the shape of the arguments together.

    Raises
    ------
    InputError
        NaN, negative distance or friction, length or EA not positive, fairlead or anchor under the bed.

    Examples
    --------
    >>> from moyai.mooring import solve_catenary
    >>> line = solve_catenary(50.0, 10.0, 55.0, axial_stiffness=5e8, submerged_weight=1000.0)
    >>> line.regime_names, round(line.grounded_length, 1)            # [m] on the bed
    ('grounded', 40.1)
    >>> round(line.tension_fairlead - line.horizontal_tension)       # w times the height above the bed [N]
    10000
    """
    arrays = np.broadcast_arrays(
        *(
            np.asarray(value, dtype=float)
            for value in (
                horizontal_distance,
                vertical_distance,
                unstretched_length,
                axial_stiffness,
                submerged_weight,
                bed_clearance,
                bed_friction,
            )
        )
    )
    x, z, length, axial, weight, clearance, friction = arrays
    _require(np.isfinite(x) & (x >= 0.0), x, "horizontal_distance", "0 or more, finite")
    _require(np.isfinite(z), z, "vertical_distance", "a finite number")
    _require(np.isfinite(length) & (length > 0.0), length, "unstretched_length", "greater than 0")
    _require(axial > 0.0, axial, "axial_stiffness", "greater than 0")
    _require(np.isfinite(weight), weight, "submerged_weight", "a finite number")
    _require(np.isfinite(friction) & (friction >= 0.0), friction, "bed_friction", "0 or more")
    if bed:
        _require(clearance >= 0.0, clearance, "bed_clearance", "0 or more", "an anchor under the bed: raise it")
        _require(
            z + clearance >= -1e-9 * length,
            z,
            "vertical_distance",
            "fairlead not under the bed",
            "raise the fairlead or pass bed=False",
        )
    else:
        clearance = np.full_like(clearance, kernels.NO_BED)
    shape = x.shape
    out = np.empty((x.size, 10))
    regime = np.empty(x.size, dtype=np.int64)
    flat = [np.ascontiguousarray(value).reshape(-1) for value in (x, z, length, axial, weight, clearance, friction)]
    kernels.solve_batch(*flat, out, regime)
    columns = [plain(out[:, i].reshape(shape)) for i in range(10)]
    return CatenarySolution(
        horizontal_tension=columns[0],
        vertical_tension_fairlead=columns[1],
        vertical_tension_anchor=columns[3],
        horizontal_tension_anchor=columns[2],
        grounded_length=columns[4],
        stiffness=out[:, 5:9].reshape(*shape, 2, 2),
        residual=columns[9],
        regime=regime.reshape(shape) if shape else int(regime[0]),
    )
