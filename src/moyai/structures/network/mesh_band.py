"""What mesh and step do to the highest tension of a line or net, and what one that was not checked proves."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.headline import Band, Bound
from moyai.flexible.sensitivity import PeakSensitivity
from moyai.structures.network.refinement import LANDING, band_of
from moyai.structures.network.summary import LOADS_AGAIN

if TYPE_CHECKING:
    import xarray as xr

UNCHECKED = "mesh and step not checked"
#: What is said with it where the number proves no limit kept.
REMEDY = "a sensitivity run checks them"


#: Whole change from a net to one of no mesh over that to twice its knots. The half cell at a held row that no bar
#: carries is an error of first order, which would make it 2; nets of 4 x 5 to 25 x 33 knots came to 2.2.
NET_REACH = 2.5


def mesh_and_step(value: float, finer: list[float], nets: bool = False) -> Band:
    """Return the band of a peak: ``finer`` as in :class:`PeakSensitivity`, without step.

    ``nets`` where the finer mesh has twice the knots of its nets.
    """
    of, half, mesh, damped, finest = finer
    low, high = band_of(PeakSensitivity(of, half, mesh, math.nan, math.nan, math.nan, damped, finest))
    words = "mesh and step: half the step, twice the segments, undamped and damped, and their change extrapolated"
    if nets:
        far = max(of + NET_REACH * (mesh - of), 0.0)
        low, high = min(low, far), max(high, far)
        words = "mesh and step: half the step, twice the knots of the nets, and their change extrapolated"
    return Band(min(low, value), max(high, value), words)


def numerical_band(
    summary: xr.Dataset, run: str, line: str, value: float, averaged: bool
) -> tuple[Band | None, list[str], Bound]:
    """Return what mesh and step do to a tension, what is to be said of it, and what an unchecked one proves.

    A peak whose mesh was not checked may be more: it can break a limit and cannot keep one. That holds of landing
    fronts too: finer segments of a chain under a buoy give less, those of a line with a clump give more.

    Parameters
    ----------
    summary : xarray.Dataset
        Of one run.
    run, line : str
        Its name, and the line or net.
    value : float
        The tension [N].
    averaged : bool
        Whether it is a mean over realisations: what mesh and step change of one, they change of the mean in proportion.
    """
    governing = governing_of(summary, run)
    first, own = _checked(summary, governing), _checked(summary, line)
    nets = bool(summary.attrs.get("finer_nets"))
    if own:
        share = value / own[0] if averaged and own[0] > 0.0 else 1.0
        band = mesh_and_step(value, [share * one for one in own], nets)
        names = ("half_viscosity", "double_viscosity") if governing == line else ()
        viscous = [float(summary[key]) for key in names if key in summary]
        viscous = [one for one in viscous if math.isfinite(one)]
        said = f"half and twice the viscosity: {min(viscous):.4g} to {max(viscous):.4g} N" if viscous else ""
        return band, [said], ""
    why, lands = doubt_of(summary, run, line), LANDING in str(summary.attrs.get(f"doubt {run}", ""))
    unchecked = f"{UNCHECKED}{': ' + why if why else ''}"
    if not first or not first[0] > 0.0 or lands:
        return None, [unchecked, REMEDY], "at least"
    # only the event of the governing line was run again: what the mesh does to it is taken for this one too
    band = mesh_and_step(first[0], first, nets).scaled(value / first[0])
    words = f"mesh and step: in proportion to the tension of {governing}"
    few = f"few {line}" in summary.attrs and "line_tension_of_check" in summary
    return replace(band, of=words), [unchecked, *([REMEDY] if few else [])], "at least" if few else ""


def governing_of(summary: xr.Dataset, run: str) -> str:
    """Return the line or net that governs a run."""
    return str(summary.attrs.get(f"governing {run}", ""))


def doubt_of(summary: xr.Dataset, run: str, line: str) -> str:
    """Say why the peak of a line may hang on its mesh: few bars are its own, snaps and fronts those of every line."""
    governing, doubt = governing_of(summary, run), str(summary.attrs.get(f"doubt {run}", ""))
    if line == governing or doubt != str(summary.attrs.get(f"few {governing}", "")):
        return doubt or str(summary.attrs.get(f"few {line}", ""))
    return str(summary.attrs.get(f"few {line}", ""))


def _checked(summary: xr.Dataset, line: str) -> list[float]:
    """Return the highest tension of a line or net in the run and in those that check its mesh; none without them."""
    for kind in ("line", "part", "net"):
        name = f"{kind}_tension_of_check"
        if name in summary and line in np.atleast_1d(summary[kind].values):
            values = [float(value) for value in summary[name].sel({kind: line}).values]
            if all(map(math.isfinite, values[:3])):
                return values
    if "sensitivity_peak" not in summary or "run" not in summary.coords:
        return []
    values = [float(summary[key]) for key in ("sensitivity_peak", *LOADS_AGAIN.values())]
    return values if math.isfinite(values[0]) and governing_of(summary, str(summary["run"].values)) == line else []
