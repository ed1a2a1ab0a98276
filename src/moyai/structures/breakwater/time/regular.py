"""Regular waves in time: every period run to a steady motion, its harmonics, extremes, R and T."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.progress import Progress, silent
from moyai.core.validity import Notice
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.damping import QuadraticDamping
from moyai.floating.far_field import far_field
from moyai.floating.forcing import Forcing, RegularForcing
from moyai.floating.memory import StateSpaceMemory
from moyai.floating.modes import natural_modes
from moyai.floating.moving_water import MovingWater
from moyai.floating.time import CumminsModel, Simulation
from moyai.mooring.lines import SpringLine
from moyai.series.harmonics import Harmonics, fit_last_periods
from moyai.structures.breakwater.frequency.model import FrequencyModel, motion_ratio
from moyai.structures.breakwater.hydrodynamics import wavelengths
from moyai.structures.breakwater.lines.driven import wave_around
from moyai.structures.breakwater.lines.events import movable, out_of_range, with_lines_in_motion
from moyai.structures.breakwater.lines.motion import without_line_drag
from moyai.structures.breakwater.memory_model import UnitMemory
from moyai.structures.breakwater.model import RegularSea
from moyai.structures.breakwater.responses import (
    anchor_loads,
    snap_notices,
)
from moyai.structures.breakwater.settings import MODES, TimeSettings
from moyai.structures.breakwater.time.energy import HIGHER, EnergyOfPeriod, energy_checks, energy_of_period, of_springs
from moyai.structures.breakwater.time.lines import lines_at_rest, motion_names, motion_summary
from moyai.structures.breakwater.time.model import SeaOfRun, TimeResult, TimeRun, linear_damping, run_with_lines
from moyai.structures.breakwater.variables import labelled
from moyai.structures.breakwater.viscous_damping import own_water_motion

if TYPE_CHECKING:
    import xarray as xr

    from moyai.flexible.flow import Current


RAMP_PERIODS = 6.0  # P3: cosine ramp of six periods
LEAST_SETTLING_PERIODS = 20.0
MOST_SETTLING_PERIODS = 300.0
SETTLED = math.log(1e3)  # transients die to a thousandth
LEAST_LOSS = 0.005  # of the incident energy
STEADY_LIMIT = 0.01  # change of the first harmonic from one window to the next
REPEATING_LIMIT = 0.05  # of the same; beyond it the motion has no appreciable first harmonic
PERIODS_OF_NO_REPEAT = 100  # whose largest values count where the motion never repeats


def regular_sea(
    model: FrequencyModel,
    memory: UnitMemory,
    sea: RegularSea,
    frequency: xr.Dataset,
    settings: TimeSettings,
    progress: Progress = silent,
    current: Current | None = None,
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
    current : profile or None
        Around lines in motion.
    """
    import xarray as xr

    unit = model.unit
    periods = np.sort(np.asarray(sea.periods, dtype=float))
    names = (
        "motion_amplitude",
        "mean_offset",
        "maximum_motion",
        "line_tension_maximum",
        "line_tension_minimum",
        "line_tension_mean",
        "anchor_vertical_tension_maximum",
        "anchor_horizontal_tension_maximum",
        "least_grounded_length",
        "lines_in_motion",
        "reflection_coefficient",
        "transmission_coefficient",
        "dissipation",
        "damping_work",
        "energy_to_harmonics",
        "harmonic_radiation",
    )
    summaries: list[dict[str, Array]] = []
    runs: list[TimeRun] = []
    energies: list[tuple[float, EnergyOfPeriod]] = []
    notices: list[Notice] = []
    status = "converged"
    for index, period in enumerate(periods):
        progress(f"time domain, {unit.name}, {sea.name}", index, len(periods))
        one = frequency.sel(period=period)
        try:
            used, run, found, laws, kept = _repeating(
                model, memory, sea, float(period), one, settings, progress, current
            )
        except KeyboardInterrupt:
            status = "interrupted"
            break
        runs.append(run)
        notices.extend(found)
        change = _change(run.simulation, float(period), settings)
        summary = _summary(used, run, sea, float(period), kept, repeats=change <= REPEATING_LIMIT)
        loss = float(summary["dissipation"])
        energy = energy_of_period(used, run, sea, float(period), kept.analysed_periods, loss, *laws)
        energies.append((float(period), energy))
        summaries.append(summary | energy.variables())
        notices.extend(_steadiness(change, f"{unit.name}, {sea.name}, T = {period:g} s", settings, kept))
        if run.simulation.status != "converged":
            status = "interrupted" if run.simulation.status == "interrupted" else "not_converged"
            if status == "interrupted":
                break
    progress(f"time domain, {unit.name}, {sea.name}", len(periods), len(periods))
    motion = tuple(name for name in motion_names(settings.lines) if any(name in item for item in summaries))
    blank = np.full(len(unit.lines), np.nan)
    rows = {name: [item.get(name, blank) for item in summaries] for name in dict.fromkeys((*names, *motion))}
    done = periods[: len(summaries)]
    length = wavelengths(2.0 * math.pi / done, unit) if len(done) else done
    dims = (
        {"motion_amplitude": "dof", "mean_offset": "dof", "maximum_motion": "dof"}
        | dict.fromkeys((*names[3:10], *motion), "line")
        | {"harmonic_radiation": "harmonic"}
    )
    out: dict[str, Any] = {
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
        largest = np.array(rows["line_tension_maximum"])
        out["maximum_utilisation"] = (("period", "line"), np.where(np.isfinite(load), largest / load, np.nan))
    coords = {"period": done, "dof": list(MODES), "line": [line.name for line in unit.lines], "harmonic": list(HIGHER)}
    data = xr.Dataset(out, coords=coords)
    if len(done):
        where = f"{unit.name}, {sea.name}, time domain"
        # Peaks of lines in motion are none of lines at rest
        still = np.array(rows["lines_in_motion"]) == 0.0
        largest_at_rest = np.where(still, np.array(rows["line_tension_maximum"]), 0.0)
        notices.extend(snap_notices(where, unit.lines, largest_at_rest, np.array(rows["line_tension_mean"])))
    notices.extend(_created_energy(data, f"{unit.name}, {sea.name}"))
    data.attrs |= {"kind": "regular", "height": sea.height, "heading": sea.heading, "status": status}
    checks = energy_checks(energies, f"{unit.name}, {sea.name}")
    if unit.lines and all(isinstance(line, SpringLine) for line in unit.lines):
        checks, said = of_springs(checks)
        notices.extend(said)
    return TimeResult(labelled(data), tuple(runs), tuple(notices), status, checks)


_Laws = tuple[Array, QuadraticDamping | None, Forcing]


def _repeating(
    model: FrequencyModel,
    memory: UnitMemory,
    sea: RegularSea,
    period: float,
    frequency: xr.Dataset,
    settings: TimeSettings,
    progress: Progress,
    current: Current | None,
) -> tuple[FrequencyModel, TimeRun, tuple[Notice, ...], _Laws, TimeSettings]:
    """Run one period until its motion repeats, or long enough for the largest values of one that never does.

    The settings in the last place hold the periods to analyse.
    """
    first = _one_period(model, memory, sea, period, frequency, settings, progress, current)
    if settings.duration is not None or _change(first[1].simulation, period, settings) <= REPEATING_LIMIT:
        return (*first, settings)
    longer = settings.changed(analysed_periods=max(PERIODS_OF_NO_REPEAT, settings.analysed_periods))
    again = _one_period(model, memory, sea, period, frequency, longer, progress, current)
    repeats = _change(again[1].simulation, period, settings) <= REPEATING_LIMIT
    return (*again, settings if repeats else longer)


def _one_period(
    model: FrequencyModel,
    memory: UnitMemory,
    sea: RegularSea,
    period: float,
    frequency: xr.Dataset,
    settings: TimeSettings,
    progress: Progress,
    current: Current | None,
) -> tuple[FrequencyModel, TimeRun, tuple[Notice, ...], _Laws]:
    """Run one period; lines are set in motion where their peaks pass the range of lines at rest, and reported so.

    The last item holds what forces acted on the unit: linear and quadratic damping, and the forcing.
    """
    unit, omega = model.unit, 2.0 * math.pi / period
    hydro = model.hydro.at(np.array([omega]), sea.heading)
    drift = np.array([float(frequency.mean_drift_force), 0.0, 0.0]) if model.with_drift else np.zeros(3)
    if settings.drift == "none":
        drift = np.zeros(3)
    # The damping of the frequency domain, whose stiffness is that of the mean offset, so that both are comparable
    stiffness = unit.statics.stiffness + np.asarray(frequency.mooring_stiffness.values)
    damping = linear_damping(model, hydro.added_mass[0], stiffness)
    cummins = memory.model(model, damping)
    if sea.heading != 0.0:
        # In oblique waves the motion runs along the structure with the wave: radiation of that one frequency, no memory
        cummins = replace(
            cummins,
            inertia=unit.inertia + hydro.added_mass[0],
            linear_damping=damping + hydro.radiation_damping[0],
            memory=StateSpaceMemory.none(3),
        )
    ramp = RAMP_PERIODS * period if settings.ramp is None else settings.ramp
    window = settings.analysed_periods * period
    duration = settings.duration
    if duration is None:
        duration = ramp + _settling_time(model, cummins, memory.beam_sea, period) + 2.0 * window
    forcing = RegularForcing(
        omega=omega,
        wave_amplitude=0.5 * sea.height,
        excitation_force=hydro.excitation_force[0, 0],
        mean_drift=drift,
        steady=model.steady,
        drift_law="pulsating" if settings.drift == "pulsating" else "ramped",
        ramp=ramp,
    )
    expected = np.abs(frequency.motion_amplitude.values) + np.abs(frequency.mean_offset.values)
    begin = max(duration - window, 0.0)
    attributes = {"period": period, "height": sea.height, "ramp": ramp, "kind": "regular", "analysis_start": begin}
    around = SeaOfRun(wave_around(unit, omega, sea.height, sea.heading), current, ramp, begin, period)
    name = f"T{period:.4g}".replace(".", "p")
    waves: Forcing = forcing
    if unit.breakwater.damping.viscous:
        measures = own_water_motion(unit, np.array([omega]), np.array([sea.heading]))
        waves = MovingWater(forcing, np.array([omega]), np.array([0.5 * sea.height + 0j]), measures, ramp)
    run = run_with_lines(name, attributes, model, cummins, waves, expected, settings, around, duration, progress)
    reported: tuple[Notice, ...] = ()
    if _need_motion(model, run, period, settings):
        moving = with_lines_in_motion(model)
        try:
            run = run_with_lines(
                name, attributes, moving, cummins, waves, expected, settings, around, duration, progress
            )
            model = moving
        except InputError as error:
            message = f"{unit.name}, {sea.name}: {error.fault.message}; lines stay at rest at every instant"
            reported = (Notice("lines-stay-at-rest", message, remedy=error.fault.remedy),)
    simulation = run.simulation
    notices = (*simulation.notices, *reported)
    if simulation.status == "diverged":
        notices = (
            *notices,
            Notice("diverged", f"{unit.name}, {sea.name}, T = {period:g} s: {simulation.message}", severity="error"),
        )
    quadratic = cummins.quadratic if run.lines is None else without_line_drag(model, cummins)
    return model, run, notices, (damping, quadratic, waves)


def _need_motion(model: FrequencyModel, run: TimeRun, period: float, settings: TimeSettings) -> bool:
    """Whether a line that may be set in motion passes the range of lines at rest in the analysed window."""
    tension = run.simulation.tension[_analysed(run.simulation, period, settings)]
    able = movable(model.unit) if run.simulation.status == "converged" else np.zeros(0, dtype=bool)
    if settings.lines.mode != "auto" or not able.any() or not len(tension):
        return False
    return bool((out_of_range(model.unit, tension.max(axis=0), tension.mean(axis=0)) & able).any())


def _settling_time(model: FrequencyModel, cummins: CumminsModel, hydro: Hydrodynamics, period: float) -> float:
    """Time in which transients die to a thousandth, from the damping of the natural modes [s]."""
    modes = natural_modes(hydro, model.unit.inertia, model.stiffness, damping=cummins.linear_damping)
    longest = LEAST_SETTLING_PERIODS * period
    for omega, ratio in zip(modes.omega, modes.damping_ratio):
        if np.isfinite(omega) and omega > 0.0:
            longest = max(longest, SETTLED / (max(float(ratio), 0.005) * float(omega)))
    return min(longest, MOST_SETTLING_PERIODS * period)


def _harmonics(run: Simulation, period: float, settings: TimeSettings) -> Harmonics:
    return fit_last_periods(run.time, run.position, 2.0 * math.pi / period, periods=settings.analysed_periods)


def _analysed(run: Simulation, period: float, settings: TimeSettings) -> NDArray[np.bool_]:
    """Which rows the analysed periods at the end hold."""
    values: NDArray[np.bool_] = run.time > run.time[-1] - settings.analysed_periods * period
    return values


def _summary(
    model: FrequencyModel, whole: TimeRun, sea: RegularSea, period: float, settings: TimeSettings, *, repeats: bool
) -> dict[str, Array]:
    """Return first harmonics, extremes, and R and T with these motions in the operators of the frequency domain.

    A motion that never repeats has no R and T.
    """
    run, blank = whole.simulation, np.full(3, np.nan)
    kinds = run.tension.shape[1]
    out = {
        "motion_amplitude": blank, "mean_offset": blank, "maximum_motion": blank,
        "line_tension_maximum": np.full(kinds, np.nan), "line_tension_minimum": np.full(kinds, np.nan),
        "line_tension_mean": np.full(kinds, np.nan), "reflection_coefficient": np.array(np.nan),
        "transmission_coefficient": np.array(np.nan), "dissipation": np.array(np.nan),
        "anchor_vertical_tension_maximum": np.full(kinds, np.nan),
        "anchor_horizontal_tension_maximum": np.full(kinds, np.nan),
        "least_grounded_length": np.full(kinds, np.nan), "lines_in_motion": np.zeros(kinds),
    }  # fmt: skip
    if run.status != "converged" or run.time[-1] < settings.analysed_periods * period:
        return out
    found = _harmonics(run, period, settings)
    window = _analysed(run, period, settings)
    vertical, horizontal, grounded = anchor_loads(model.unit, run.position[window], run.tension[window])
    out |= {
        "motion_amplitude": np.abs(found.first),
        "mean_offset": found.mean,
        "maximum_motion": np.max(np.abs(run.position[window]), axis=0),
        "line_tension_maximum": whole.peaks[window].max(axis=0),
        "line_tension_minimum": run.tension[window].min(axis=0),
        "line_tension_mean": run.tension[window].mean(axis=0),
        "anchor_vertical_tension_maximum": vertical,
        "anchor_horizontal_tension_maximum": horizontal,
        "least_grounded_length": grounded,
        "lines_in_motion": np.full(kinds, 0.0 if whole.lines is None else 1.0) * ~lines_at_rest(model.unit),
    }
    if whole.lines is not None:
        still, lines = lines_at_rest(model.unit), whole.lines
        level = np.sqrt(np.maximum(lines.anchor[window] ** 2 - lines.uplift[window] ** 2, 0.0)).max(axis=0)
        out |= motion_summary(model.unit, whole, window, float(run.time[window][0]))
        out["least_grounded_length"] = np.where(still, grounded, out["least_grounded_length"])
        out["anchor_vertical_tension_maximum"] = np.where(
            still, vertical, out["anchor_vertical_tension_maximum_lines_in_motion"]
        )
        out["anchor_horizontal_tension_maximum"] = np.where(still, horizontal, level)
    hydro = model.hydro.at(np.array([2.0 * math.pi / period]), sea.heading)
    if hydro.has_far_field and sea.height > 0.0 and repeats:
        far = far_field(hydro, found.first[None, None, :] / (0.5 * sea.height))
        out |= {
            "reflection_coefficient": np.abs(far.reflection_coefficient[0, 0]),
            "transmission_coefficient": np.abs(far.transmission_coefficient[0, 0]),
            "dissipation": far.loss[0, 0],
        }
    return out


def _change(run: Simulation, period: float, settings: TimeSettings) -> float:
    """Return by what share the first harmonic changes between the last two windows; 0 where there are no two."""
    window = settings.analysed_periods * period
    if run.status != "converged" or run.time[-1] < 2.0 * window:
        return 0.0
    last = _harmonics(run, period, settings)
    earlier = run.time <= run.time[-1] - window
    before = fit_last_periods(
        run.time[earlier], run.position[earlier], 2.0 * math.pi / period, periods=settings.analysed_periods
    )
    size = np.maximum(np.abs(last.first), 1e-3 * np.max(np.abs(last.first)) + 1e-12)
    return float(np.max(np.abs(np.abs(last.first) - np.abs(before.first)) / size))


def _steadiness(change: float, where: str, settings: TimeSettings, kept: TimeSettings) -> tuple[Notice, ...]:
    """Report a motion that has not settled, or never repeats."""
    if change <= STEADY_LIMIT:
        return ()
    windows = f"between the last two windows of {settings.analysed_periods} periods"
    message = f"{where}: the motion still changes by {100.0 * change:.1f} % {windows}"
    limit = STEADY_LIMIT
    if change > REPEATING_LIMIT:
        limit = REPEATING_LIMIT
        message = (
            f"{where}: the motion does not repeat (its first harmonic changes by {100.0 * change:.0f} % {windows}); "
            "reflection and transmission there are not known, largest values are those of "
            f"{kept.analysed_periods} periods"
        )
    remedy = "give a longer duration; strongly nonlinear lines may never settle to one period"
    return (Notice("not-steady", message, value=change, limit=limit, remedy=remedy),)


def _created_energy(data: xr.Dataset, where: str) -> tuple[Notice, ...]:
    """Warn when the combined R and T of P3 carry more energy than came in."""
    if "dissipation" not in data:
        return ()
    least = float(data["dissipation"].min(skipna=True))
    if not least < -LEAST_LOSS:
        return ()
    return (
        Notice(
            "energy-created",
            f"{where}, time domain: reflected and transmitted waves carry {-100.0 * least:.1f} % more energy than came "
            "in; motions of nonlinear lines, or of the memory of normal incidence in oblique waves, do not fit the "
            "operators of the frequency domain",
            value=-least,
            limit=LEAST_LOSS,
            remedy="take reflection and transmission of the frequency domain",
        ),
    )
