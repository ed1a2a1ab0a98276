"""Largest motions of a breakwater over the periods of a regular sea, by the model that is in its range at each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.headline import Band, Headline
from moyai.floating.energy import ENERGY_TOLERANCE, SHOWN_LOSS, unexplained_share
from moyai.structures.breakwater.lines.headlines import AT_REST, FIRST_ORDER, IN_MOTION
from moyai.structures.breakwater.responses import SNAP_RATIO

if TYPE_CHECKING:
    import xarray as xr


def beyond_range(data: xr.Dataset, statics: xr.Dataset | None) -> NDArray[np.bool_]:
    """Return the periods (n,) of a sea in time whose numbers decide nothing.

    There a chain at rest at every instant passes five times its mean tension, or the loss of the far field is not the
    work of the damping [eq:breakwater-time-energy], which springs may do: they have no mass of their own.

    Parameters
    ----------
    data : xarray.Dataset
        Regular sea in time.
    statics : xarray.Dataset or None
        Of the same water level; distinguishes chains from springs, which are linear at any tension.
    """
    out = np.zeros(data.sizes["period"], dtype=bool)
    chains = (
        statics is None
        or "unstretched_length" not in statics
        or bool(np.isfinite(statics.variables["unstretched_length"].values).any())
    )
    if chains and "damping_work" in data and "dissipation" in data:
        share = unexplained_share(
            data.variables["dissipation"].values, data.variables["damping_work"].values, SHOWN_LOSS
        )
        out |= share > ENERGY_TOLERANCE
    if "line_tension_maximum" in data and data.sizes.get("line", 0):
        still = np.ones(data["line_tension_maximum"].shape, dtype=bool)
        if "lines_in_motion" in data:
            still = data.variables["lines_in_motion"].values != 1.0
        if statics is not None and "unstretched_length" in statics:
            still = still & np.isfinite(statics.variables["unstretched_length"].values)
        passing = (
            data.variables["line_tension_maximum"].values > SNAP_RATIO * data.variables["line_tension_mean"].values
        )
        out |= np.any(still & passing, axis=1)
    return out


@dataclass(frozen=True)
class LargestOfPeriods:
    """The largest motions of a regular sea."""

    #: That governs the sea; one of "time", "frequency".
    domain: str
    #: Of that domain.
    data: xr.Dataset
    #: The same sea in the frequency domain, which stands in where the time domain is out of its range.
    frequency: xr.Dataset | None
    #: The unit at rest.
    statics: xr.Dataset | None
    #: Level and sea.
    where: str

    def offset(self) -> list[Headline]:
        """Return the offset in sway of every period: mean and motion together."""
        return self._headlines("offset", "Largest offset in sway", "m", 0)

    def roll(self) -> list[Headline]:
        """Return the amplitude of roll of every period."""
        return self._headlines("roll", "Largest roll", "rad", 2)

    def _of(self, data: xr.Dataset, domain: str, mode: int) -> Array:
        if mode == 0 and domain == "time" and "maximum_motion" in data:
            return np.array(data.variables["maximum_motion"].values[:, 0], dtype=float)
        found = np.array(data.variables["motion_amplitude"].values[:, mode], dtype=float)
        if mode == 0 and "mean_offset" in data:
            found += np.abs(data.variables["mean_offset"].values[:, 0])
        return found

    def _headlines(self, name: str, label: str, unit: str, mode: int) -> list[Headline]:
        if "motion_amplitude" not in self.data:
            return []
        periods, table = self.data.variables["period"].values, self._of(self.data, self.domain, mode)
        out = beyond_range(self.data, self.statics) if self.domain == "time" else np.zeros(periods.size, dtype=bool)
        table[out] = np.nan
        if self.frequency is not None and out.any():
            known = self.frequency.sel(period=periods[out])
            table[out] = self._of(known, "frequency", mode)
        said = ""
        if out.any():
            names = ", ".join(f"{period:.3g} s" for period in periods[out])
            said = (
                f"at T = {names} the time domain is out of its range (chains at rest at every instant, or energy that "
                "damping does not explain) and the frequency domain is used"
            )
        found = []
        for row in np.flatnonzero(np.isfinite(table)):
            model, value, mean = FIRST_ORDER, float(table[row]), 0.0
            if self.domain == "time" and not out[row]:
                moving = "lines_in_motion" in self.data and bool(
                    (self.data.variables["lines_in_motion"].values[row] == 1.0).any()
                )
                model = IN_MOTION if moving else AT_REST
            detail = []
            if mode == 0 and "mean_offset" in self.data:
                source = self.frequency.sel(period=periods[row]) if out[row] and self.frequency is not None else None
                mean = float(
                    self.data.variables["mean_offset"].values[row, 0]
                    if source is None
                    else source.variables["mean_offset"].values[0]
                )
                detail.append(f"mean {mean:.3g} m")
            words = "; ".join(filter(None, (*detail, said)))
            place = f"{self.where}, T = {periods[row]:.3g} s"
            band = self._damping_band(periods[row], mode, value, abs(mean))
            found.append(Headline(name, label, value, unit, place, model, band, detail=words))
        return found

    def _damping_band(self, period: float, mode: int, value: float, mean: float) -> Band | None:
        """Return how far a motion moves over what is uncertain in damping, by its change in the frequency domain."""
        if self.frequency is None or "motion_amplitude_low" not in self.frequency:
            return None
        row = int(np.flatnonzero(self.frequency.variables["period"].values == period)[0])
        names = (f"motion_amplitude{end}" for end in ("", "_low", "_high"))
        own, low, high = (float(self.frequency.variables[name].values[row, mode]) for name in names)
        if not (own > 0.0 and np.isfinite(low + high)):
            return None
        least, most = (mean + (value - mean) * end / own for end in (low, high))
        return Band(least, most, str(self.frequency.attrs.get("damping_band", "damping")))
