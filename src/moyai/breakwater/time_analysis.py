"""The breakwater in time: memory, tabulated nonlinear lines, drift; regular waves and irregular seas."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from moyai.breakwater.assembly import FloatingUnit
from moyai.breakwater.frequency_analysis import FrequencyModel, motion_ratio
from moyai.breakwater.hydrodynamics import wavelengths
from moyai.breakwater.memory_model import UnitMemory
from moyai.breakwater.model import MODES, IrregularSea, RegularSea, TimeSettings
from moyai.breakwater.variables import labelled
from moyai.core.progress import Progress, silent
from moyai.core.validity import Notice
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.far_field import drift_force_per_amplitude_squared, far_field
from moyai.floating.forcing import Forcing, IrregularForcing, RegularForcing
from moyai.floating.frequency import Motions, solve_motions
from moyai.floating.harmonics import Harmonics, fit_harmonics
from moyai.floating.lines import PlanarMooring
from moyai.floating.modes import natural_modes
from moyai.floating.time import CumminsModel, Simulation, simulate
from moyai.sea.irregular import synthesise
from moyai.sea.statistics import zero_crossing

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]

RAMP_PERIODS = 6.0  # P3: cosine ramp of six periods
LEAST_SETTLING_PERIODS = 20.0
MOST_SETTLING_PERIODS = 300.0
SETTLED = math.log(1e3)  # transients die to a thousandth
STEADY_LIMIT = 0.01  # change of the first harmonic from one window to the next
PEAKS_LOOKED_UP = 50
MOST_ROWS = 120_000  # rows of a stored time series


@dataclass(frozen=True)
class TimeRun:
    """One simulation with what it was made for.

    Parameters
    ----------
    name : str
        Name of its group in the result.
    simulation : Simulation
    attributes : dict
    """

    name: str
    simulation: Simulation
    attributes: dict

    def dataset(self, unit: FloatingUnit) -> xr.Dataset:
        """Return the time series, thinned to at most :data:`MOST_ROWS` rows."""
        import xarray as xr

        run = self.simulation
        every = max(1, math.ceil(len(run.time) / MOST_ROWS))
        data = xr.Dataset(
            {
                "position": (("time", "dof"), run.position[::every]),
                "tension": (("time", "line"), run.tension[::every]),
                "surface_elevation": ("time", run.elevation[::every]),
            },
            coords={"time": run.time[::every], "dof": list(MODES), "line": [line.name for line in unit.lines]},
            attrs={**self.attributes, "time_step": run.time_step, "status": run.status, "message": run.message},
        )
        return labelled(data)


@dataclass(frozen=True)
class TimeResult:
    """Summary of a sea in time, its runs, and what they have to say."""

    dataset: xr.Dataset
    runs: tuple[TimeRun, ...]
    notices: tuple[Notice, ...] = ()
    status: str = "converged"


def compiled_lines(unit: FloatingUnit, reach: Array) -> PlanarMooring | None:
    """Prepare the lines of the unit for the time domain.

    Tables serve within motions of ``reach`` [m, m, rad] about rest, the exact solver beyond.
    """
    if not unit.lines:
        return None
    return PlanarMooring.of(unit.mooring.planar.system, rest=(0.0, 0.0, 0.0), centre=(0.0, 0.0), motion_range=reach)


def _linear_damping(model: FrequencyModel, added_mass: Array, stiffness: Array) -> Array:
    return np.asarray(model.damping.at(model.unit.inertia, added_mass, stiffness), dtype=float)


def _natural_added_mass(model: FrequencyModel, hydro: Hydrodynamics) -> Array:
    """Added mass with the diagonal of each mode at that mode's own natural frequency, for the fraction of critical."""
    modes = natural_modes(hydro, model.unit.inertia, model.stiffness)
    omega = np.clip(np.nan_to_num(modes.omega), hydro.omega[0], hydro.omega[-1])
    out = np.zeros((3, 3))
    for index in range(3):
        out[index, index] = hydro.at(np.array([omega[index]])).added_mass[0, index, index]
    return out


def _settling_time(model: FrequencyModel, cummins: CumminsModel, hydro: Hydrodynamics, period: float) -> float:
    """Time in which transients die to a thousandth, from the damping of the natural modes [s]."""
    modes = natural_modes(hydro, model.unit.inertia, model.stiffness, damping=cummins.linear_damping)
    longest = LEAST_SETTLING_PERIODS * period
    for omega, ratio in zip(modes.omega, modes.damping_ratio):
        if np.isfinite(omega) and omega > 0.0:
            longest = max(longest, SETTLED / (max(float(ratio), 0.005) * float(omega)))
    return min(longest, MOST_SETTLING_PERIODS * period)


def _run(model: FrequencyModel, cummins: CumminsModel, forcing: Forcing, expected: Array, **options: Any) -> Simulation:
    """Simulate with line tables for twice the expected motion (at least a thousandth of the beam, or of a radian)."""
    unit = model.unit
    reach = np.maximum(2.0 * np.nan_to_num(expected), 1e-3 * np.array([unit.breakwater.hull.beam] * 2 + [1.0]))
    return simulate(
        replace(cummins, mooring=compiled_lines(unit, reach)),
        forcing,
        expected_motion=np.nan_to_num(expected),
        **options,
    )


def regular_sea(
    model: FrequencyModel,
    memory: UnitMemory,
    sea: RegularSea,
    frequency: xr.Dataset,
    settings: TimeSettings,
    progress: Progress = silent,
) -> TimeResult:
    """Simulate each period of a regular sea and analyse its steady end, R and T combined as in P3.

    Parameters
    ----------
    model : FrequencyModel
    memory : UnitMemory
    sea : RegularSea
    frequency : xarray.Dataset
        The same sea in the frequency domain: drift force, expected motions.
    settings : TimeSettings
    progress : Progress
    """
    import xarray as xr

    unit = model.unit
    periods = np.sort(np.asarray(sea.periods, dtype=float))
    names = (
        "motion_amplitude",
        "mean_offset",
        "maximum_motion",
        "maximum_tension",
        "minimum_tension",
        "mean_tension",
        "maximum_anchor_vertical_tension",
        "reflection_coefficient",
        "transmission_coefficient",
        "dissipation",
    )
    rows: dict[str, list] = {name: [] for name in names}
    runs: list[TimeRun] = []
    notices: list[Notice] = []
    status = "converged"
    for index, period in enumerate(periods):
        progress(f"time domain, {unit.name}, {sea.name}", index, len(periods))
        one = frequency.sel(period=period)
        try:
            run, found = _one_period(model, memory, sea, float(period), one, settings, progress)
        except KeyboardInterrupt:
            status = "interrupted"
            break
        runs.append(run)
        notices.extend(found)
        for name, value in _summary(model, run.simulation, sea, float(period), settings).items():
            rows[name].append(value)
        notices.extend(_steadiness(run.simulation, float(period), settings, f"{unit.name}, {sea.name}"))
        if run.simulation.status != "converged":
            status = "interrupted" if run.simulation.status == "interrupted" else "not_converged"
            if status == "interrupted":
                break
    progress(f"time domain, {unit.name}, {sea.name}", len(periods), len(periods))
    done = periods[: len(rows["motion_amplitude"])]
    length = wavelengths(2.0 * math.pi / done, unit) if len(done) else done
    dims = {"motion_amplitude": "dof", "mean_offset": "dof", "maximum_motion": "dof"} | dict.fromkeys(
        ("maximum_tension", "minimum_tension", "mean_tension", "maximum_anchor_vertical_tension"), "line"
    )
    out: dict = {
        name: (("period", dims[name]) if name in dims else ("period",), np.array(values))
        for name, values in rows.items()
        if values
    }
    if len(done):
        out["motion_ratio"] = (("period", "dof"), motion_ratio(unit, np.array(rows["motion_amplitude"]), sea.height))
        out["wavelength_over_beam"] = ("period", length / unit.breakwater.hull.beam)
        for name in ("mean_drift_force", "drift_coefficient"):
            if name in frequency:
                out[name] = ("period", frequency[name].sel(period=done).values)
        load = np.array([line.breaking_load for line in unit.lines])
        largest = np.array(rows["maximum_tension"])
        out["maximum_utilisation"] = (("period", "line"), np.where(np.isfinite(load), largest / load, np.nan))
    data = xr.Dataset(out, coords={"period": done, "dof": list(MODES), "line": [line.name for line in unit.lines]})
    data.attrs |= {"kind": "regular", "height": sea.height, "heading": sea.heading, "status": status}
    return TimeResult(labelled(data), tuple(runs), tuple(notices), status)


def _one_period(
    model: FrequencyModel,
    memory: UnitMemory,
    sea: RegularSea,
    period: float,
    frequency: xr.Dataset,
    settings: TimeSettings,
    progress: Progress,
) -> tuple[TimeRun, tuple[Notice, ...]]:
    unit, omega = model.unit, 2.0 * math.pi / period
    hydro = model.hydro.at(np.array([omega]), sea.heading)
    drift = np.array([float(frequency.mean_drift_force), 0.0, 0.0]) if model.with_drift else np.zeros(3)
    if settings.drift == "none":
        drift = np.zeros(3)
    # The damping of the frequency domain, whose stiffness is that of the mean offset, so that both are comparable
    stiffness = unit.statics.stiffness + np.asarray(frequency.mooring_stiffness.values)
    cummins = memory.model(model, _linear_damping(model, hydro.added_mass[0], stiffness))
    ramp = RAMP_PERIODS * period if settings.ramp is None else settings.ramp
    window = settings.analysed_periods * period
    duration = settings.duration
    if duration is None:
        duration = ramp + _settling_time(model, cummins, memory.beam_sea, period) + 2.0 * window
    forcing = RegularForcing(
        omega=omega,
        wave_amplitude=0.5 * sea.height,
        excitation=hydro.excitation[0, 0],
        mean_drift=drift,
        steady=model.steady,
        drift_law="pulsating" if settings.drift == "pulsating" else "ramped",
        ramp=ramp,
    )
    expected = np.abs(frequency.motion_amplitude.values) + np.abs(frequency.mean_offset.values)
    simulation = _run(
        model, cummins, forcing, expected, duration=duration, time_step=settings.time_step, progress=progress
    )
    attributes = {"period": period, "height": sea.height, "ramp": ramp, "kind": "regular"}
    attributes["analysis_start"] = max(duration - window, 0.0)
    notices = simulation.notices
    if simulation.status == "diverged":
        notices = (
            *notices,
            Notice("diverged", f"{unit.name}, {sea.name}, T = {period:g} s: {simulation.message}", severity="error"),
        )
    return TimeRun(f"T{period:.4g}".replace(".", "p"), simulation, attributes), notices


def _harmonics(run: Simulation, period: float, settings: TimeSettings) -> Harmonics:
    return fit_harmonics(run.time, run.position, 2.0 * math.pi / period, periods=settings.analysed_periods)


def _summary(
    model: FrequencyModel, run: Simulation, sea: RegularSea, period: float, settings: TimeSettings
) -> dict[str, Array]:
    """Return first harmonics, extremes, and R and T with these motions in the operators of the frequency domain."""
    blank = np.full(3, np.nan)
    kinds = run.tension.shape[1]
    out = {
        "motion_amplitude": blank, "mean_offset": blank, "maximum_motion": blank,
        "maximum_tension": np.full(kinds, np.nan), "minimum_tension": np.full(kinds, np.nan),
        "mean_tension": np.full(kinds, np.nan), "reflection_coefficient": np.array(np.nan),
        "transmission_coefficient": np.array(np.nan), "dissipation": np.array(np.nan),
        "maximum_anchor_vertical_tension": np.full(kinds, np.nan),
    }  # fmt: skip
    if run.status != "converged" or run.time[-1] < settings.analysed_periods * period:
        return out
    found = _harmonics(run, period, settings)
    window = run.time > run.time[-1] - settings.analysed_periods * period
    out |= {
        "motion_amplitude": np.abs(found.first),
        "mean_offset": found.mean,
        "maximum_motion": np.max(np.abs(run.position[window]), axis=0),
        "maximum_tension": run.tension[window].max(axis=0),
        "minimum_tension": run.tension[window].min(axis=0),
        "mean_tension": run.tension[window].mean(axis=0),
        "maximum_anchor_vertical_tension": anchor_uplift(model.unit, run.position[window], run.tension[window]),
    }
    hydro = model.hydro.at(np.array([2.0 * math.pi / period]), sea.heading)
    if hydro.has_far_field and sea.height > 0.0:
        far = far_field(hydro, found.first[None, None, :] / (0.5 * sea.height))
        out |= {
            "reflection_coefficient": np.abs(far.reflection[0, 0]),
            "transmission_coefficient": np.abs(far.transmission[0, 0]),
            "dissipation": far.loss[0, 0],
        }
    return out


def _steadiness(run: Simulation, period: float, settings: TimeSettings, where: str) -> tuple[Notice, ...]:
    """Compare the last window with the one before it."""
    window = settings.analysed_periods * period
    if run.status != "converged" or run.time[-1] < 2.0 * window:
        return ()
    last = _harmonics(run, period, settings)
    earlier = run.time <= run.time[-1] - window
    before = fit_harmonics(
        run.time[earlier], run.position[earlier], 2.0 * math.pi / period, periods=settings.analysed_periods
    )
    size = np.maximum(np.abs(last.first), 1e-3 * np.max(np.abs(last.first)) + 1e-12)
    change = float(np.max(np.abs(np.abs(last.first) - np.abs(before.first)) / size))
    if change <= STEADY_LIMIT:
        return ()
    return (
        Notice(
            "not-steady",
            f"{where}, T = {period:g} s: the motion still changes by {100 * change:.1f} % between the last two windows "
            f"of {settings.analysed_periods} periods",
            value=change,
            limit=STEADY_LIMIT,
            remedy="give a longer duration; strongly nonlinear lines may never settle to one period",
        ),
    )


def irregular_sea(
    model: FrequencyModel,
    memory: UnitMemory,
    sea: IrregularSea,
    frequency: xr.Dataset,
    settings: TimeSettings,
    progress: Progress = silent,
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
        amplitude = np.where((components.heading >= low) & (components.heading <= high), amplitude, 0.0)
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
    added = _natural_added_mass(model, memory.beam_sea)
    offset = np.asarray(frequency.mean_offset.values)
    stiffness = unit.statics.stiffness + unit.mooring.stiffness(offset)
    cummins = memory.model(model, _linear_damping(model, added, stiffness))
    expected = np.asarray(frequency.most_probable_maximum_motion.values) + np.abs(offset)
    simulation = _run(
        model, cummins, forcing, expected, duration=sea.duration + ramp, time_step=settings.time_step, progress=progress
    )
    run = TimeRun(
        "realisation", simulation, {"kind": "irregular", "seed": sea.seed, "ramp": ramp, "analysis_start": ramp}
    )
    status = {"converged": "converged", "diverged": "not_converged", "interrupted": "interrupted"}[simulation.status]
    notices = list(simulation.notices)
    if simulation.status == "diverged":
        notices.append(Notice("diverged", f"{unit.name}, {sea.name}: {simulation.message}", severity="error"))
    data = _irregular_summary(unit, simulation, sea, frequency, ramp)
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
    hydro = model.hydro.whole(sea.heading)
    if not hydro.has_far_field:
        return None
    motions: Motions = solve_motions(hydro, model.unit.inertia, model.stiffness, damping=model.damping)
    far = far_field(hydro, motions.displacement)
    per_square = drift_force_per_amplitude_squared(far, hydro.omega, hydro.heading, model.unit.water, hydro.length)[
        :, 0
    ]
    out = np.zeros((len(omega), 3))
    # Directions of a spread sea take the drift of the mean heading, turned by the square of the cosine
    turn = np.cos(heading) * np.abs(np.cos(heading)) / max(math.cos(sea.heading) ** 2, 1e-6)
    out[:, 0] = np.interp(omega, hydro.omega, per_square) * turn
    return out


def anchor_uplift(unit: FloatingUnit, position: Array, tension: Array) -> Array:
    """Return the largest vertical tension at the anchor of one line of each kind [N].

    The exact lines are solved at the instants of the largest fairlead tensions, where uplift is largest too.
    """
    if not unit.lines or not len(position):
        return np.zeros(len(unit.lines))
    count = min(PEAKS_LOOKED_UP, len(position))
    instants = np.unique(np.argpartition(-tension, count - 1, axis=0)[:count])
    states = unit.mooring.planar.states(position[instants])
    return np.array([state.vertical_tension_anchor.max() for state in states.values()])


def _irregular_summary(
    unit: FloatingUnit, run: Simulation, sea: IrregularSea, frequency: xr.Dataset, ramp: float
) -> xr.Dataset:
    import xarray as xr

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
            "maximum_tension": ("line", tension.max(axis=0) if len(unit.lines) else np.zeros(0)),
            "significant_tension": ("line", _significant(run.time[keep], tension)),
            "maximum_anchor_vertical_tension": ("line", anchor_uplift(unit, position, tension)),
            "mean_drift_force": ((), float(frequency["mean_drift_force"])),
            "significant_height": ((), 4.0 * float(np.std(run.elevation[keep]))),
        }
        load = np.array([line.breaking_load for line in unit.lines])
        out["maximum_utilisation"] = ("line", np.where(np.isfinite(load), out["maximum_tension"][1] / load, np.nan))
    for name in ("transmission_coefficient", "reflection_coefficient", "transmitted_significant_height"):
        if name in frequency:
            out[name] = ((), float(frequency[name]))
    return xr.Dataset(out, coords={"dof": list(MODES), "line": [line.name for line in unit.lines]})


def _significant(time: Array, series: Array) -> Array:
    """Return the mean of the highest third of the zero-up-crossing double amplitudes of each column."""
    return np.array([zero_crossing(time, column).significant_height() for column in series.T])
