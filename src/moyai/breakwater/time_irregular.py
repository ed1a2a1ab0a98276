"""Irregular seas in time: slow drift, nonlinear lines, statistics."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from moyai.breakwater.assembly import FloatingUnit
from moyai.breakwater.frequency_model import FrequencyModel
from moyai.breakwater.hydrodynamics import SECTOR
from moyai.breakwater.memory_model import UnitMemory
from moyai.breakwater.model import MODES, IrregularSea, TimeSettings
from moyai.breakwater.responses import (
    anchor_uplift,
    snap_notices,
)
from moyai.breakwater.time_lines import lines_at_rest, motion_summary
from moyai.breakwater.time_model import SeaOfRun, TimeResult, TimeRun, linear_damping, run_with_lines
from moyai.breakwater.variables import labelled
from moyai.breakwater.viscous_damping import about_rest_in_sea, natural_added_mass, own_water_motion
from moyai.core.progress import Progress, silent
from moyai.core.validity import Notice
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.far_field import drift_force_per_amplitude_squared, far_field
from moyai.floating.forcing import Forcing, IrregularForcing
from moyai.floating.frequency import solve_motions
from moyai.floating.moving_water import MovingWater
from moyai.floating.time import Simulation
from moyai.sea.irregular import synthesise
from moyai.sea.statistics import zero_crossing

if TYPE_CHECKING:
    import xarray as xr

    from moyai.flexible.flow import Current

Array = NDArray[np.float64]


def irregular_sea(
    model: FrequencyModel,
    memory: UnitMemory,
    sea: IrregularSea,
    frequency: xr.Dataset,
    settings: TimeSettings,
    progress: Progress = silent,
    current: Current | None = None,
) -> TimeResult:
    """Simulate an irregular sea with slow drift and nonlinear lines, and take its statistics.

    Parameters
    ----------
    model : FrequencyModel
    memory : UnitMemory
    sea : IrregularSea
    frequency : xarray.Dataset
        The same sea in the frequency domain, for the expected motions and the transmission.
    settings : TimeSettings
    progress : Progress
    current : profile or None
        Around lines in motion.
    """

    unit = model.unit
    ramp = settings.ramp if settings.ramp is not None else 10.0 * 2.0 * math.pi / float(sea.spectrum.peak_omega)
    components = synthesise(
        sea.spectrum,
        unit.water,
        duration=sea.duration + ramp,
        seed=sea.seed,
        heading=sea.heading,
        spreading=sea.spreading,
    )
    amplitude = components.complex_amplitude
    if sea.spreading is None:
        excitation = model.hydro.whole(sea.heading).excitation_at(components.omega)
    else:
        # What travels outside of the computed sector meets the ends of the unit and is left out, as in frequency
        joined = _excitation_of_headings(model)
        low, high = float(joined.heading[0]), float(joined.heading[-1])
        amplitude = np.where(np.abs(components.heading) <= SECTOR, amplitude, 0.0)
        excitation = joined.excitation_at(components.omega, np.clip(components.heading, low, high))
    drift = _drift_of_components(model, components.omega, components.heading, sea)
    law = {"ramped": "ramped", "newman": "newman", "pulsating": "newman", "none": "none"}[settings.drift]
    if not model.with_drift or drift is None:
        law = "none"
    forcing = IrregularForcing(
        omega=components.omega,
        amplitude=amplitude,
        excitation=excitation,
        drift=drift,
        steady=model.steady,
        drift_law=law,  # type: ignore[arg-type]
        ramp=ramp,
    )
    added = natural_added_mass(model, memory.beam_sea)
    offset = np.asarray(frequency.mean_offset.values)
    stiffness = unit.statics.stiffness + unit.mooring.stiffness(offset)
    cummins = memory.model(model, linear_damping(model, added, stiffness))
    expected = np.asarray(frequency.most_probable_maximum_motion.values) + np.abs(offset)
    attributes = {"kind": "irregular", "seed": sea.seed, "ramp": ramp, "analysis_start": ramp}
    around = SeaOfRun(components, current, ramp, ramp, 2.0 * math.pi / float(sea.spectrum.peak_omega))
    waves: Forcing = forcing
    if unit.breakwater.damping.viscous:
        moving = own_water_motion(unit, components.omega, components.heading)
        waves = MovingWater(forcing, components.omega, amplitude, moving, ramp)
    run = run_with_lines(
        "realisation", attributes, model, cummins, waves, expected, settings, around, sea.duration + ramp, progress
    )
    simulation = run.simulation
    status = {"converged": "converged", "diverged": "not_converged", "interrupted": "interrupted"}[simulation.status]
    notices = list(simulation.notices)
    if simulation.status == "diverged":
        notices.append(Notice("diverged", f"{unit.name}, {sea.name}: {simulation.message}", severity="error"))
    applied = float(forcing.mean_drift()[0])
    data = _irregular_summary(unit, run, sea, applied, ramp)
    # In oblique waves the memory is that of another problem than the operators: no transmission is combined from them
    if sea.spreading is None and sea.heading == 0.0 and "mean_offset" in data:
        data = data.assign(_transmission(model, simulation, sea, ramp))
    if "maximum_tension" in data:
        names = [line.name for line in unit.lines]
        where = f"{unit.name}, {sea.name}, time domain"
        kept = lines_at_rest(unit)
        names = [name for name, rests in zip(names, kept, strict=True) if rests]
        notices.extend(snap_notices(where, names, data.maximum_tension.values[kept], data.mean_tension.values[kept]))
    data.attrs |= {
        "kind": "irregular",
        "heading": sea.heading,
        "duration": sea.duration,
        "seed": sea.seed,
        "status": status,
    }
    return TimeResult(labelled(data), (run,), tuple(notices), status)


def _excitation_of_headings(model: FrequencyModel) -> Hydrodynamics:
    """Put the wave loads of all headings side by side on the frequencies that all have."""
    every = model.hydro.by_heading
    low = max(float(item.omega[0]) for item in every)
    high = min(float(item.omega[-1]) for item in every)
    shortest = min(every, key=lambda item: len(item.omega))
    omega = shortest.omega[(shortest.omega >= low) & (shortest.omega <= high)]
    loads = np.concatenate([item.at(omega).excitation for item in every], axis=1)
    first = every[0].at(omega)
    heading = np.array([float(item.heading[0]) for item in every])
    return replace(first, heading=heading, excitation=loads, reflection=None, transmission=None, radiated_wave=None)


def _drift_of_components(model: FrequencyModel, omega: Array, heading: Array, sea: IrregularSea) -> Array | None:
    """Mean drift over amplitude squared at the wave components, from the linear motions about rest."""
    every = model.hydro.by_heading if sea.spreading is not None else (model.hydro.whole(sea.heading),)
    if not every[0].has_far_field:
        return None
    rows = []
    for hydro in every:
        # Undamped resonances would drift without bound: quadratic damping counts as in this sea
        if model.unit.breakwater.damping.viscous:
            motions = about_rest_in_sea(model, hydro, sea)
        else:
            motions = solve_motions(hydro, model.unit.inertia, model.stiffness, damping=model.damping)
        far = far_field(hydro, motions.displacement)
        square = drift_force_per_amplitude_squared(far, hydro.omega, hydro.heading, model.unit.water, hydro.length)
        rows.append(np.interp(omega, hydro.omega, square[:, 0]))
    table, known = np.array(rows), np.array([float(hydro.heading[0]) for hydro in every])
    out = np.zeros((len(omega), 3))
    if len(known) == 1:
        out[:, 0] = table[0]
        return out
    right = np.clip(np.searchsorted(known, heading), 1, len(known) - 1)
    weight = np.clip((heading - known[right - 1]) / (known[right] - known[right - 1]), 0.0, 1.0)
    columns = np.arange(len(omega))
    out[:, 0] = (1.0 - weight) * table[right - 1, columns] + weight * table[right, columns]
    return out


def _irregular_summary(
    unit: FloatingUnit, whole: TimeRun, sea: IrregularSea, drift_force: float, ramp: float
) -> xr.Dataset:
    import xarray as xr

    run = whole.simulation
    keep = run.time >= ramp
    position, tension = run.position[keep], run.tension[keep]
    out: dict = {}
    if keep.sum() > 100:
        mean = position.mean(axis=0)
        out = {
            "mean_offset": ("dof", mean),
            "maximum_motion": ("dof", np.max(np.abs(position - mean), axis=0)),
            "maximum_excursion": ("dof", np.max(np.abs(position), axis=0)),
            "significant_motion": ("dof", _significant(run.time[keep], position)),
            "mean_tension": ("line", tension.mean(axis=0)),
            "maximum_tension": ("line", whole.peaks[keep].max(axis=0) if len(unit.lines) else np.zeros(0)),
            "significant_tension": ("line", _significant(run.time[keep], tension)),
            "maximum_anchor_vertical_tension": ("line", anchor_uplift(unit, position, tension)),
            "mean_drift_force": ((), float(drift_force)),
            "significant_height": ((), 4.0 * float(np.std(run.elevation[keep]))),
        }
        if whole.lines is not None:
            found = motion_summary(unit, whole, keep, ramp)
            uplift = np.where(lines_at_rest(unit), out["maximum_anchor_vertical_tension"][1], found["maximum_uplift"])
            out |= {name: ("line", values) for name, values in found.items()}
            out["maximum_anchor_vertical_tension"] = ("line", uplift)
        load = np.array([line.breaking_load for line in unit.lines])
        out["maximum_utilisation"] = ("line", np.where(np.isfinite(load), out["maximum_tension"][1] / load, np.nan))
    return xr.Dataset(out, coords={"dof": list(MODES), "line": [line.name for line in unit.lines]})


def _transmission(model: FrequencyModel, run: Simulation, sea: IrregularSea, ramp: float) -> dict[str, Any]:
    """Return transmission and reflection of the sea with the motions of the time domain.

    The combined method of P3 carried over to spectra: the wave that passes the body held fixed plus the waves that the
    simulated motions radiate, frequency by frequency of the record [eq:breakwater-combined]. Slow drift radiates
    nothing and is left out with everything outside the band of the waves. Long-crested seas only.
    """
    hydro = model.hydro.whole(sea.heading)
    if hydro.reflection is None or hydro.transmission is None or hydro.radiated_wave is None:
        return {}
    keep = run.time >= ramp
    window = np.hanning(int(keep.sum()))
    step = float(run.time[1] - run.time[0])
    omega = 2.0 * math.pi * np.fft.rfftfreq(len(window), step)
    low, high = (float(item) for item in sea.spectrum.quantile(np.array([1e-4, 1.0 - 1e-3])))
    band = (omega >= max(low, hydro.omega[0])) & (omega <= min(high, hydro.omega[-1]))

    def spectrum(series: Array) -> NDArray[np.complex128]:
        # The convention is exp(-i omega t): the conjugate of the transform
        return np.asarray(np.conj(np.fft.rfft(series * window)))[band]

    wave = spectrum(run.elevation[keep])
    at = hydro.at(omega[band])
    if at.reflection is None or at.transmission is None or at.radiated_wave is None:
        return {}
    position = run.position[keep] - run.position[keep].mean(axis=0)
    velocity = -1j * omega[band][:, None] * np.stack([spectrum(column) for column in position.T], axis=1)
    radiated = np.einsum("nm,nms->ns", velocity, at.radiated_wave)
    incident = float(np.sum(np.abs(wave) ** 2))
    if incident == 0.0:
        return {}
    reflected = math.sqrt(float(np.sum(np.abs(at.reflection[:, 0] * wave + radiated[:, 0]) ** 2)) / incident)
    passed = math.sqrt(float(np.sum(np.abs(at.transmission[:, 0] * wave + radiated[:, 1]) ** 2)) / incident)
    height = 4.0 * float(np.std(run.elevation[keep]))
    return {
        "transmission_coefficient": ((), passed),
        "reflection_coefficient": ((), reflected),
        "transmitted_significant_height": ((), passed * height),
    }


def _significant(time: Array, series: Array) -> Array:
    """Return the mean of the highest third of the zero-up-crossing double amplitudes of each column."""
    return np.array([zero_crossing(time, column).significant_height() for column in series.T])
