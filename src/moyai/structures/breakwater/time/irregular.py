"""Irregular seas in time: realisations with slow drift and nonlinear lines, and their means."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.progress import Progress, silent
from moyai.core.validity import Notice
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.far_field import drift_force_per_amplitude_squared, far_field
from moyai.floating.forcing import Forcing, IrregularForcing
from moyai.floating.frequency import solve_motions
from moyai.floating.lanes_kernel import LANES
from moyai.floating.memory import StateSpaceMemory
from moyai.floating.time import CumminsModel, Simulation
from moyai.sea.irregular import realisation_seed, synthesise
from moyai.series.zero_crossing import split_waves
from moyai.structures.breakwater.assembly import FloatingUnit
from moyai.structures.breakwater.frequency.about_rest import about_rest_in_sea, natural_added_mass
from moyai.structures.breakwater.frequency.model import FrequencyModel
from moyai.structures.breakwater.hydrodynamics import SECTOR
from moyai.structures.breakwater.lines.events import EventSettings, movable, out_of_range, with_lines_in_motion
from moyai.structures.breakwater.lines.motion import has_dynamic_lines
from moyai.structures.breakwater.lines.network import resolved
from moyai.structures.breakwater.lines.search import (
    MOST_EVENTS,
    EventsInMotion,
    Realisation,
    change_on_finer_lines,
    events_in_motion,
)
from moyai.structures.breakwater.memory_model import UnitMemory
from moyai.structures.breakwater.model import DEFAULT_REALISATIONS, IrregularSea
from moyai.structures.breakwater.responses import anchor_loads, snap_notices
from moyai.structures.breakwater.settings import MODES, TimeSettings
from moyai.structures.breakwater.slow_drift import LEAST_CYCLES
from moyai.structures.breakwater.time.lines import STATISTICS, TWICE_THE_BARS, lines_at_rest, motion_summary
from moyai.structures.breakwater.time.model import SeaOfRun, TimeResult, TimeRun, linear_damping, run_seeds
from moyai.structures.breakwater.variables import labelled
from moyai.structures.breakwater.viscous_damping import in_moving_water

if TYPE_CHECKING:
    import xarray as xr

    from moyai.flexible.flow import Current

#: Peak periods in a record, below which its largest values say nothing of the sea state
LEAST_WAVES = 10.0
#: Natural period of sway over the peak period under which Newman's approximation is rough
LEAST_RATIO = 3.0


@dataclass(frozen=True)
class _Sea:
    """What every realisation of a sea shares."""

    model: FrequencyModel
    sea: IrregularSea
    settings: TimeSettings
    cummins: CumminsModel
    expected: Array
    ramp: float
    law: str
    current: Current | None

    @property
    def peak_period(self) -> float:
        return 2.0 * math.pi / float(self.sea.spectrum.peak_omega)


def irregular_sea(
    model: FrequencyModel,
    memory: UnitMemory,
    sea: IrregularSea,
    frequency: xr.Dataset,
    settings: TimeSettings,
    progress: Progress = silent,
    current: Current | None = None,
) -> TimeResult:
    """Simulate realisations of an irregular sea with slow drift and nonlinear lines; numbers are means over them.

    Parameters
    ----------
    model : FrequencyModel
    memory : UnitMemory
    sea : IrregularSea
    frequency : xarray.Dataset
        The same sea in the frequency domain, for the expected motions and the slow drift.
    settings : TimeSettings
    progress : Progress
    current : profile or None
        Around lines in motion.
    """
    unit = model.unit
    shared = _shared(model, memory, sea, frequency, settings, current)
    chosen = 1 if has_dynamic_lines(unit) else DEFAULT_REALISATIONS
    wanted = chosen if settings.realisations == "auto" else settings.realisations
    members: list[Realisation] = []
    status, notices = "converged", []
    for number, one in enumerate(_realisations(shared, wanted, progress)):
        progress(f"realisations, {unit.name}, {sea.name}", number + 1, wanted)
        ended = one.run.simulation.status
        if ended != "interrupted" or not members:
            members.append(one)
        if ended == "diverged":
            reported = f"{unit.name}, {sea.name}, seed {one.seed}: {one.run.simulation.message}"
            notices.append(Notice("diverged", reported, severity="error"))
        if ended != "converged":
            status = {"diverged": "not_converged", "interrupted": "interrupted"}[ended]
            break
    good = [
        one for one in members if "line_tension_maximum" in one.summary and one.run.simulation.status == "converged"
    ]
    notices = [*members[0].run.simulation.notices, *notices]
    events: list[TimeRun] = []
    moved = np.zeros(len(unit.lines), dtype=bool)
    if good and status == "converged":
        try:
            good, events, moved, line_notices = _lines_in_motion(shared, good, frequency, progress)
        except KeyboardInterrupt:
            status, line_notices = "interrupted", ()
        notices.extend(line_notices)
    data, shown = _gathered(unit, good or members, moved)
    kept = (good or members)[shown]
    runs = [kept.run, *events[shown : shown + 1]]
    # In oblique waves the memory is that of another problem than the operators: no transmission is combined from them
    if sea.spreading is None and sea.heading == 0.0 and "mean_offset" in data:
        data = data.assign(_transmission(model, kept.run.simulation, sea, shared.ramp))
    notices.extend(_notices(shared, data, frequency, moved))
    data.attrs |= {
        "kind": "irregular",
        "heading": sea.heading,
        "duration": sea.duration,
        "seed": sea.seed,
        "shown_seed": kept.seed,
        "realisations": len(good or members),
        "drift": shared.law,
        "status": status,
    }
    return TimeResult(labelled(data), tuple(runs), tuple(notices), status)


def _shared(
    model: FrequencyModel,
    memory: UnitMemory,
    sea: IrregularSea,
    frequency: xr.Dataset,
    settings: TimeSettings,
    current: Current | None,
) -> _Sea:
    unit = model.unit
    ramp = settings.ramp if settings.ramp is not None else 10.0 * 2.0 * math.pi / float(sea.spectrum.peak_omega)
    laws = {"auto": "newman", "ramped": "ramped", "newman": "newman", "pulsating": "newman", "none": "none"}
    law = laws[settings.drift] if model.with_drift and model.hydro.whole(sea.heading).has_far_field else "none"
    added = natural_added_mass(model, memory.beam_sea)
    offset = np.asarray(frequency.mean_offset.values)
    stiffness = unit.statics.stiffness + unit.mooring.stiffness(offset)
    cummins = memory.model(model, linear_damping(model, added, stiffness))
    expected = np.asarray(frequency.most_probable_maximum_motion.values) + np.abs(offset)
    if "slow_motion_deviation" in frequency and law == "newman":
        expected = expected + 3.0 * frequency.slow_motion_deviation.values
    return _Sea(model, sea, settings, cummins, expected, ramp, law, current)


def _realisations(shared: _Sea, wanted: int, progress: Progress) -> Iterator[Realisation]:
    """Yield the realisations, side by side where all lines are at rest at every instant."""
    model, sea, ramp = shared.model, shared.sea, shared.ramp
    duration = sea.duration + ramp
    together = 1 if has_dynamic_lines(model.unit) else LANES
    for first in range(0, wanted, together):
        progress(f"realisations, {model.unit.name}, {sea.name}", first, wanted)
        seeds = [realisation_seed(sea.seed, number) for number in range(first, min(first + together, wanted))]
        prepared = [_prepared(shared, seed) for seed in seeds]
        runs = run_seeds(
            [{"kind": "irregular", "seed": seed, "ramp": ramp, "analysis_start": ramp} for seed in seeds], model,
            shared.cummins, [waves for _, waves, _ in prepared], shared.expected, shared.settings,
            [around for _, _, around in prepared], duration, progress,
        )  # fmt: skip
        for seed, run, (forcing, _, around) in zip(seeds, runs, prepared):
            summary = _irregular_summary(model.unit, run, sea, float(forcing.mean_drift()[0]), ramp)
            yield Realisation(seed, run, forcing, around, summary)


def _prepared(shared: _Sea, seed: int) -> tuple[IrregularForcing, Forcing, SeaOfRun]:
    """Return the forces of a realisation, the same with the motion of the water, and the sea around lines."""
    model, sea, ramp = shared.model, shared.sea, shared.ramp
    unit, duration = model.unit, shared.sea.duration + shared.ramp
    components = synthesise(
        sea.spectrum,
        unit.water,
        duration=duration,
        seed=seed,
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
    drift = None if shared.law == "none" else _drift_of_components(model, components.omega, components.heading, sea)
    forcing = IrregularForcing(
        omega=components.omega,
        amplitude=amplitude,
        excitation_force=excitation,
        drift=drift,
        steady=model.steady,
        drift_law=shared.law,  # type: ignore[arg-type]
        ramp=ramp,
    )
    around = SeaOfRun(components, shared.current, ramp, ramp, shared.peak_period)
    return forcing, in_moving_water(unit, forcing, components.heading), around


def _lines_in_motion(
    shared: _Sea, members: list[Realisation], frequency: xr.Dataset, progress: Progress
) -> tuple[list[Realisation], list[TimeRun], NDArray[np.bool_], tuple[Notice, ...]]:
    """Set lines in motion around the largest events of every realisation where lines at rest do not serve.

    The line of the highest utilisation comes first. Of every other line that is out of its range the largest event of
    each realisation is rerun, and more only where they could govern.
    """
    unit, moved = shared.model.unit, np.zeros(len(shared.model.unit.lines), dtype=bool)
    tension = np.array([one.summary.line_tension_maximum.values for one in members])
    passing = out_of_range(unit, tension, np.array([one.summary.line_tension_mean.values for one in members]))
    loads = np.array([line.breaking_load for line in unit.lines])
    rank = tension.mean(axis=0) / np.where(np.isfinite(loads), loads, 1.0)
    # The number of the first page comes from lines in motion, also where lines at rest are in their range
    passing = (passing | (rank == rank.max(initial=-math.inf))) & movable(unit)
    if not passing.any() or shared.settings.lines.mode != "auto":
        return members, [], moved, ()
    if not isinstance(shared.cummins.memory, StateSpaceMemory):
        reported = f"{unit.name}, {shared.sea.name}: lines in motion need the memory of the water as states"
        remedy = "give a damping lid where water resonates between hulls, or a memory by state space"
        return members, [], moved, (Notice("lines-stay-at-rest", reported, remedy=remedy),)
    period = float(frequency.slow_sway_period) if "slow_sway_period" in frequency else 0.0
    try:
        lines = resolved(with_lines_in_motion(shared.model).unit, shared.settings.lines)
    except (InputError, ConvergenceError) as error:
        reported = f"{unit.name}, {shared.sea.name}: {error.fault.message}; lines stay at rest at every instant"
        return members, [], moved, (Notice("lines-stay-at-rest", reported, remedy=error.fault.remedy),)
    settings = shared.settings.changed(lines=lines)
    given = EventSettings(shared.model, shared.cummins, shared.expected, settings, shared.peak_period, period)
    shown: list[TimeRun] = []
    best, counts, still_open, refined = -math.inf, [], 0, list[Notice]()
    offsets: list[Array] = []
    for line in sorted(np.flatnonzero(passing), key=lambda number: -rank[number]):
        load = float(loads[line]) if math.isfinite(loads[line]) else 1.0
        try:
            found = events_in_motion(given, members, int(line), max(best, 0.0) * load, progress)
        except (InputError, ConvergenceError) as error:
            reported = f"{unit.name}, {shared.sea.name}: {error.fault.message}; lines stay at rest at every instant"
            return members, shown, moved, (Notice("lines-stay-at-rest", reported, remedy=error.fault.remedy),)
        moved[line] = True
        try:
            change = change_on_finer_lines(given, members, found, int(line), progress)
        except (InputError, ConvergenceError) as error:
            finer = f"{unit.name}, {shared.sea.name}: with twice the bars: {error.fault.message}; not in the band"
            refined.append(Notice("lines-not-refined", finer, remedy=error.fault.remedy))
            change = math.nan
        for item in found:
            item.numbers[TWICE_THE_BARS] = np.full(len(unit.lines), change)
        members = [_with_events(shared.model, one, item, int(line)) for one, item in zip(members, found, strict=True)]
        counts += [item.count for item in found]
        offsets += [item.offsets for item in found]
        highest = [max(float(item.numbers["line_tension_maximum"][line]), max(best, 0.0) * load) for item in found]
        still_open += sum(item.bound > value for item, value in zip(found, highest, strict=True))
        now = float(np.mean([item.bound for item in found]))
        value = now / load
        if value > best:
            best = value
            shown = [
                replace(item.run, attributes={**item.run.attributes, "seed": one.seed})
                for item, one in zip(found, members, strict=True)
            ]
    names = ", ".join(line.name for line, there in zip(unit.lines, moved, strict=True) if there)
    reported = (
        f"{unit.name}, {shared.sea.name}: {min(counts)} to {max(counts)} events of each realisation were run with line "
        f"{names} in motion, over {given.lead:.0f} s up to each, until the next could not pass the largest"
    )
    notices = [Notice("lines-set-in-motion", reported, severity="information"), *refined]
    if still_open:
        reported = (
            f"{unit.name}, {shared.sea.name}: in {still_open} searches of {len(counts)} the limit of {MOST_EVENTS} "
            "events ended the reruns; the tension is judged at the bound that the next event leaves open"
        )
        notices.append(Notice("events-left-open", reported, value=still_open, limit=0.0))
    largest = np.concatenate(offsets).max(axis=0)
    members = [replace(one, summary=_with_offsets(one.summary, largest)) for one in members]
    return members, shown, moved, tuple(notices)


def _with_offsets(summary: xr.Dataset, largest: Array) -> xr.Dataset:
    """Put the largest offsets of all events, lines in motion and at rest (2, dof), next to those of a realisation."""
    return summary.assign(event_offset=("dof", largest[0]), event_offset_lines_at_rest=("dof", largest[1]))


def _with_events(model: FrequencyModel, one: Realisation, found: EventsInMotion, line: int) -> Realisation:
    """Put the numbers of the events of one line in the place of those with lines at rest."""
    data, numbers = one.summary.copy(), dict(found.numbers)
    count = len(model.unit.lines)
    numbers["events_in_motion"] = np.full(count, float(found.count))
    numbers["line_tension_bound"] = np.full(count, found.bound)
    for name, values in numbers.items():
        given = data[name].values.copy() if name in data else np.full(values.shape, np.nan)
        given[line] = values[line]
        data[name] = ("line", given)
    load = model.unit.lines[line].breaking_load
    if math.isfinite(load):
        share = data["maximum_utilisation"].values.copy()
        share[line] = numbers["line_tension_maximum"][line] / load
        data["maximum_utilisation"] = ("line", share)
    return replace(one, summary=data)


def _gathered(unit: FloatingUnit, members: list[Realisation], moved: NDArray[np.bool_]) -> tuple[xr.Dataset, int]:
    """Return means over the realisations with what each gave, and the number of the one whose record is kept.

    The kept record is that whose largest tension of the governing line (without lines: largest sway) is nearest to the
    mean.
    """
    import xarray as xr

    data = xr.concat([one.summary for one in members], dim="member")
    if "line_tension_maximum" not in data:
        return members[0].summary, 0
    tension = data.line_tension_maximum.values
    excursion = data.largest_offset_by_dof.values
    followed = excursion[:, 0]
    if tension.shape[1]:
        loads = np.array([line.breaking_load for line in unit.lines])
        share = tension.mean(axis=0) / (loads if np.isfinite(loads).all() else 1.0)
        followed = tension[:, int(np.argmax(share))]
    shown = int(np.argmin(np.abs(followed - followed.mean())))
    out = data.mean("member", skipna=True)
    if "least_grounded_length" in data:
        out["least_grounded_length"] = data["least_grounded_length"].min("member", skipna=True)
    # counts and single events of snaps are those of the realisation whose record is kept
    for name in STATISTICS:
        if name in data:
            out[name] = data[name].isel(member=shown)
    still = lines_at_rest(unit) & ~moved
    names = ("anchor_vertical_tension_maximum", "anchor_horizontal_tension_maximum", "line_tension_bound")
    for name in names:
        if name in data:
            out[f"{name}_of_realisation"] = (("member", "line"), data[name].values)
    return out.assign(
        line_tension_maximum_of_realisation=(("member", "line"), tension),
        largest_offset_by_dof_of_realisation=(("member", "dof"), excursion),
        seed_of_realisation=("member", np.array([one.seed for one in members], dtype=np.int64)),
        lines_in_motion=("line", (~still).astype(np.int8)),
    ), shown


def _notices(shared: _Sea, data: xr.Dataset, frequency: xr.Dataset, moved: NDArray[np.bool_]) -> tuple[Notice, ...]:
    """Report peaks out of range, drift that was switched off, and records that are too short."""
    unit, sea = shared.model.unit, shared.sea
    out: list[Notice] = []
    where = f"{unit.name}, {sea.name}"
    if "line_tension_maximum" in data and len(unit.lines):
        kept = lines_at_rest(unit) & ~moved
        still = [line for line, rests in zip(unit.lines, kept, strict=True) if rests]
        largest = data.line_tension_maximum_of_realisation.values[:, kept]
        mean = np.broadcast_to(data.line_tension_mean.values[kept], largest.shape)
        out.extend(snap_notices(f"{where}, time domain", still, largest, mean))
    waves = sea.duration / shared.peak_period
    if waves < LEAST_WAVES:
        out.append(
            Notice(
                "short-record",
                f"{where}: the record of {sea.duration:g} s holds {waves:.3g} peak periods; its largest values are "
                "none of the sea state",
                value=waves,
                limit=LEAST_WAVES,
                severity="error",
                remedy=f"give a duration of {LEAST_WAVES * shared.peak_period:.0f} s or more",
            )
        )
    if "slow_sway_period" not in frequency:
        return tuple(out)
    period, slow = float(frequency.slow_sway_period), float(frequency.slow_motion_deviation.values[0])
    if shared.law != "newman":
        out.append(
            Notice(
                "slow-drift-off",
                f"{where}: slow drift is switched off (time.drift: {shared.settings.drift}); the slow sway that is "
                f"left out has a standard deviation of {slow:.3g} m at a natural period of {period:.3g} s, by the "
                "frequency domain, and the tensions that go with it are missing",
                value=slow,
                limit=0.0,
                remedy="leave the drift at auto, or give newman",
            )
        )
    ratio = period / shared.peak_period
    if shared.law == "newman" and ratio < LEAST_RATIO:
        out.append(
            Notice(
                "newman-rough",
                f"{where}: the natural period of sway is {ratio:.2g} peak periods; Newman's approximation of the slow "
                "drift is rough there",
                value=ratio,
                limit=LEAST_RATIO,
                remedy="take the offset with a margin, or compare with a longer mooring",
                source="Newman (1974)",
            )
        )
    cycles = sea.duration / period
    if shared.law == "newman" and cycles < LEAST_CYCLES:
        out.append(
            Notice(
                "few-slow-cycles",
                f"{where}: the record of {sea.duration:g} s holds {cycles:.2g} natural periods of sway ({period:.3g} "
                "s); its largest slow excursion " + ("scatters widely" if cycles >= 1.0 else "is not in it"),
                value=cycles,
                limit=LEAST_CYCLES,
                severity="warning" if cycles >= 1.0 else "error",
                remedy=f"give a duration of {LEAST_CYCLES * period:.0f} s or more, or more realisations",
            )
        )
    return tuple(out)


def _excitation_of_headings(model: FrequencyModel) -> Hydrodynamics:
    """Put the wave loads of all headings side by side on the frequencies that all have."""
    every = model.hydro.by_heading
    low = max(float(item.omega[0]) for item in every)
    high = min(float(item.omega[-1]) for item in every)
    shortest = min(every, key=lambda item: len(item.omega))
    omega = shortest.omega[(shortest.omega >= low) & (shortest.omega <= high)]
    loads = np.concatenate([item.at(omega).excitation_force for item in every], axis=1)
    first = every[0].at(omega)
    heading = np.array([float(item.heading[0]) for item in every])
    return replace(
        first,
        heading=heading,
        excitation_force=loads,
        reflection_coefficient=None,
        transmission_coefficient=None,
        radiated_wave=None,
    )


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
            motions = solve_motions(hydro, model.inertia, model.stiffness, damping=model.damping)
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
    out: dict[str, Any] = {}
    if keep.sum() > 100:
        mean = position.mean(axis=0)
        vertical, horizontal, grounded = anchor_loads(unit, position, tension)
        out = {
            "mean_offset": ("dof", mean),
            "maximum_motion": ("dof", np.max(np.abs(position - mean), axis=0)),
            "largest_offset_by_dof": ("dof", np.max(np.abs(position), axis=0)),
            "significant_motion": ("dof", _significant(run.time[keep], position)),
            "line_tension_mean": ("line", tension.mean(axis=0)),
            "line_tension_maximum": ("line", whole.peaks[keep].max(axis=0) if len(unit.lines) else np.zeros(0)),
            "significant_tension": ("line", _significant(run.time[keep], tension)),
            "anchor_vertical_tension_maximum": ("line", vertical),
            "anchor_horizontal_tension_maximum": ("line", horizontal),
            "least_grounded_length": ("line", grounded),
            "mean_drift_force": ((), float(drift_force)),
            "significant_height": ((), 4.0 * float(np.std(run.elevation[keep]))),
        }
        if whole.lines is not None:
            found = motion_summary(unit, whole, keep, ramp)
            still, lines = lines_at_rest(unit), whole.lines
            level = np.sqrt(np.maximum(lines.anchor[keep] ** 2 - lines.uplift[keep] ** 2, 0.0)).max(axis=0)
            found["least_grounded_length"] = np.where(still, grounded, found["least_grounded_length"])
            out |= {name: ("line", values) for name, values in found.items()}
            out["anchor_vertical_tension_maximum"] = (
                "line",
                np.where(still, vertical, found["anchor_vertical_tension_maximum_lines_in_motion"]),
            )
            out["anchor_horizontal_tension_maximum"] = ("line", np.where(still, horizontal, level))
        load = np.array([line.breaking_load for line in unit.lines])
        out["maximum_utilisation"] = (
            "line",
            np.where(np.isfinite(load), out["line_tension_maximum"][1] / load, np.nan),
        )
    return xr.Dataset(out, coords={"dof": list(MODES), "line": [line.name for line in unit.lines]})


def _transmission(model: FrequencyModel, run: Simulation, sea: IrregularSea, ramp: float) -> dict[str, Any]:
    """Return transmission and reflection of the sea with the motions of the time domain.

    The combined method of P3 carried over to spectra: the wave that passes the body held fixed plus the waves that the
    simulated motions radiate, frequency by frequency of the record [eq:breakwater-combined]. Slow drift radiates
    nothing and is left out with everything outside the band of the waves. Long-crested seas only.
    """
    hydro = model.hydro.whole(sea.heading)
    if hydro.reflection_coefficient is None or hydro.transmission_coefficient is None or hydro.radiated_wave is None:
        return {}
    keep = run.time >= ramp
    window = np.hanning(int(keep.sum()))
    step = float(run.time[1] - run.time[0])
    omega = 2.0 * math.pi * np.fft.rfftfreq(len(window), step)
    low, high = (float(item) for item in sea.spectrum.quantile(np.array([1e-4, 1.0 - 1e-3])))
    band = (omega >= max(low, hydro.omega[0])) & (omega <= min(high, hydro.omega[-1]))

    def spectrum(series: Array) -> NDArray[np.complex128]:
        # The convention is exp(-i omega t): the conjugate of the transform
        values: NDArray[np.complex128] = np.asarray(np.conj(np.fft.rfft(series * window)))[band]
        return values

    wave = spectrum(run.elevation[keep])
    at = hydro.at(omega[band])
    if at.reflection_coefficient is None or at.transmission_coefficient is None or at.radiated_wave is None:
        return {}
    position = run.position[keep] - run.position[keep].mean(axis=0)
    velocity = -1j * omega[band][:, None] * np.stack([spectrum(column) for column in position.T], axis=1)
    radiated = np.einsum("nm,nms->ns", velocity, at.radiated_wave)
    incident = float(np.sum(np.abs(wave) ** 2))
    if incident == 0.0:
        return {}
    reflected = math.sqrt(
        float(np.sum(np.abs(at.reflection_coefficient[:, 0] * wave + radiated[:, 0]) ** 2)) / incident
    )
    passed = math.sqrt(float(np.sum(np.abs(at.transmission_coefficient[:, 0] * wave + radiated[:, 1]) ** 2)) / incident)
    height = 4.0 * float(np.std(run.elevation[keep]))
    return {
        "transmission_coefficient": ((), passed),
        "reflection_coefficient": ((), reflected),
        "transmitted_significant_height": ((), passed * height),
    }


def _significant(time: Array, series: Array) -> Array:
    """Return the mean of the highest third of the zero-up-crossing double amplitudes of each column."""
    return np.array([split_waves(time, column).significant_height() for column in series.T])
