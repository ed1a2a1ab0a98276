"""The breakwater in the frequency domain: operators, regular seas with drift and stiffness together, irregular seas."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from moyai.breakwater.assembly import FloatingUnit
from moyai.breakwater.hydrodynamics import UnitHydrodynamics, spread_headings, wavelengths
from moyai.breakwater.model import MODES, IrregularSea, RegularSea
from moyai.breakwater.screening import transmission_macagno, transmission_ruol, transmission_wiegel
from moyai.breakwater.variables import labelled
from moyai.core.progress import Progress, silent
from moyai.core.validity import IdentityCheck, Notice
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.damping import LinearDamping, QuadraticDamping
from moyai.floating.drift import DriftedMotions, DriftProblem, mean_offset, solve_irregular_with_drift, solve_with_drift
from moyai.floating.far_field import FarField, drift_force_per_amplitude_squared, energy_check, far_field
from moyai.floating.frequency import Motions, point_motion, relative_elevation, solve_motions
from moyai.floating.irregular import energy_transmission, linearised_in_sea, response_statistics

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

COEFFICIENT_ACCURACY = 1e-3  # of the solve of the section
PHASES = 72  # instants of a cycle at which the nonlinear lines are looked up along the linear orbit


@dataclass(frozen=True)
class FrequencyModel:
    """The unit as the frequency domain sees it.

    Parameters
    ----------
    unit : FloatingUnit
    hydro : UnitHydrodynamics
    damping : LinearDamping
    quadratic : QuadraticDamping or None
    steady : ndarray (3,)
        Wind and current [N, N, N m].
    with_drift : bool
    """

    unit: FloatingUnit
    hydro: UnitHydrodynamics
    damping: LinearDamping
    quadratic: QuadraticDamping | None
    steady: Array
    with_drift: bool

    @property
    def stiffness(self) -> Array:
        """K_H + K_M at rest."""
        return self.unit.statics.stiffness + self.unit.mooring_stiffness


def make_model(
    unit: FloatingUnit, hydro: UnitHydrodynamics, steady: Array, with_drift: bool, fraction: float | None = None
) -> FrequencyModel:
    """Put unit, coefficients and damping together; ``fraction`` replaces the case's fraction of critical damping."""
    given = unit.breakwater.damping
    zeta = given.fraction_of_critical if fraction is None else fraction
    damping = LinearDamping.of_modes(
        linear=np.array(given.linear), critical_fraction=[zeta if mode in given.modes else 0.0 for mode in MODES]
    )
    quadratic = QuadraticDamping.of_modes([0.0, 0.0, given.roll_quadratic]) if given.roll_quadratic else None
    return FrequencyModel(unit, hydro, damping, quadratic, steady, with_drift)


@dataclass(frozen=True)
class FrequencyResult:
    """A labelled dataset with what it has to say for itself."""

    dataset: xr.Dataset
    checks: tuple[IdentityCheck, ...] = ()
    notices: tuple[Notice, ...] = ()


def operators(model: FrequencyModel, omega: Array, heading: float) -> FrequencyResult:
    """Response operators per metre of wave amplitude about the rest position, without drift.

    Quadratic damping needs an amplitude and is left out here; the regular and irregular seas of the case hold it.
    """
    import xarray as xr

    unit, whole = model.unit, model.hydro.whole(heading)
    # Coefficients of another program may end earlier than the operators would
    omega = omega[(omega >= whole.omega[0]) & (omega <= whole.omega[-1])] if model.hydro.solution is None else omega
    hydro = model.hydro.at(omega, heading)
    motions = solve_motions(hydro, unit.inertia, model.stiffness, damping=model.damping)
    rao = motions.displacement[:, 0, :]
    out: dict = {"rao": (("omega", "dof"), rao)}
    checks: tuple[IdentityCheck, ...] = ()
    if hydro.has_far_field:
        far = far_field(hydro, motions.displacement)
        out |= _far_field_variables(far, hydro, unit, ("omega",))
        # Operators keep the phase, for drawing the water; sea states give magnitudes
        out["reflection_coefficient"] = ("omega", far.reflection[:, 0])
        out["transmission_coefficient"] = ("omega", far.transmission[:, 0])
        checks = _energy(model, far, motions, hydro, unit.name)
    length = wavelengths(omega, unit)
    k = 2.0 * math.pi / length
    depth, gravity = unit.water.depth, unit.water.gravity
    beam, draught = unit.breakwater.hull.beam, -unit.section.bottom
    out |= {
        "transmission_macagno": ("omega", transmission_macagno(k, depth, beam, draught)),
        "transmission_wiegel": ("omega", transmission_wiegel(k, depth, draught)),
        "transmission_ruol": ("omega", transmission_ruol(omega, k, depth, beam, draught, gravity)),
    }
    coords = {
        "omega": omega,
        "dof": list(MODES),
        "period": ("omega", 2.0 * math.pi / omega),
        "wavelength": ("omega", length),
        "wavelength_over_beam": ("omega", length / beam),
    }
    data = xr.Dataset(out, coords=coords, attrs={"heading": heading})
    return FrequencyResult(labelled(data), checks, tuple(motions.notices))


def _energy(
    model: FrequencyModel, far: FarField, motions: Motions, hydro: Hydrodynamics, where: str
) -> tuple[IdentityCheck, ...]:
    """Hold the loss of the moving body against the work of its damping, to the accuracy of the coefficients.

    A damping lid takes energy of its own, which the solve of the section holds against its own identity.
    """
    if model.unit.breakwater.gap_damping_lid:
        return ()
    found = energy_check(far, motions, model.unit.water, hydro.length, COEFFICIENT_ACCURACY)
    return (replace(found, name=f"{where}: energy of the moving body"),)


def _far_field_variables(far: FarField, hydro: Hydrodynamics, unit: FloatingUnit, dims: tuple[str, ...]) -> dict:
    """Return magnitudes of reflection and transmission, and the drift [eq:breakwater-drift-coefficient]."""
    drift = drift_force_per_amplitude_squared(far, hydro.omega, hydro.heading, unit.water, hydro.length)
    return {
        "reflection_coefficient": (dims, np.abs(far.reflection[:, 0])),
        "transmission_coefficient": (dims, np.abs(far.transmission[:, 0])),
        "dissipation": (dims, far.loss[:, 0]),
        "drift_coefficient": (dims, far.drift_coefficient[:, 0]),
        "mean_drift_force_per_amplitude_squared": (dims, drift[:, 0]),
    }


def _solve(model: FrequencyModel, hydro: Hydrodynamics, amplitude: Array, progress: Progress) -> DriftedMotions:
    """Solve motions about the mean offset; without a far field the offset is that of the steady loads."""
    unit = model.unit
    if hydro.has_far_field:
        problem = DriftProblem(
            hydrodynamics=hydro,
            inertia=unit.inertia,
            hydrostatic_stiffness=unit.statics.stiffness,
            mooring=unit.mooring,
            water=unit.water,
            damping=model.damping,
            quadratic=model.quadratic,
            steady_force=model.steady,
        )
        return solve_with_drift(problem, amplitude, with_drift=model.with_drift, progress=progress)
    offset = mean_offset(unit.mooring, unit.statics.stiffness, model.steady)
    stiffness = unit.mooring.stiffness(offset.position)
    motions = solve_motions(
        hydro,
        unit.inertia,
        unit.statics.stiffness + stiffness,
        damping=model.damping,
        quadratic=model.quadratic,
        wave_amplitude=amplitude[:, None],
    )
    count = len(hydro.omega)
    nothing = np.full((count, 1), np.nan)
    return DriftedMotions(
        motions=motions,
        far=FarField(nothing.astype(complex), nothing.astype(complex), nothing, nothing),
        drift_force=np.zeros(count),
        offset=np.tile(offset.position, (count, 1)),
        mooring_stiffness=np.tile(stiffness, (count, 1, 1)),
        iterations=np.ones(count),
        status=(offset.status,) * count,
        notices=(
            Notice(
                "no-drift-of-given-coefficients",
                "coefficients of a 3-D program carry no far field: no reflection, transmission or drift is computed",
                severity="information",
            ),
        ),
    )


def regular_sea(model: FrequencyModel, sea: RegularSea, progress: Progress = silent) -> FrequencyResult:
    """Motions, reflection, transmission, drift [eq:breakwater-drift] and tensions in regular waves, solved together."""
    import xarray as xr

    unit = model.unit
    periods = np.sort(np.asarray(sea.periods, dtype=float))
    omega = 2.0 * math.pi / periods[::-1]
    hydro = model.hydro.at(omega, sea.heading)
    amplitude = np.full(len(omega), 0.5 * sea.height)
    solved = _solve(model, hydro, amplitude, progress)
    moving = solved.motions.displacement[:, 0, :] * amplitude[:, None]
    length = wavelengths(omega, unit)
    k = 2.0 * math.pi / length
    tension = line_tensions(unit, solved, moving)
    dims = ("period",)
    out = {
        "omega": (dims, omega),
        "wavelength": (dims, length),
        "wavelength_over_beam": (dims, length / unit.breakwater.hull.beam),
        "rao": (("period", "dof"), solved.motions.displacement[:, 0, :]),
        "motion_amplitude": (("period", "dof"), np.abs(moving)),
        "motion_ratio": (("period", "dof"), motion_ratio(unit, np.abs(moving), sea.height)),
        "mean_drift_force": (dims, solved.drift_force),
        "mean_offset": (("period", "dof"), solved.offset),
        "mooring_stiffness": (("period", "influenced_dof", "radiating_dof"), solved.mooring_stiffness),
        **{name: (("period", "line"), values) for name, values in tension.items()},
    }
    out |= _far_field_variables(solved.far, hydro, unit, dims) if hydro.has_far_field else {}
    elevation = deck_relative_elevation(unit, solved.motions, k, sea.heading) * amplitude
    out["relative_elevation"] = (dims, elevation)
    coords = {
        "period": periods[::-1],
        "dof": list(MODES),
        "influenced_dof": list(MODES),
        "radiating_dof": list(MODES),
        "line": [line.name for line in unit.lines],
    }
    data = labelled(xr.Dataset(out, coords=coords)).sortby("period")
    data.attrs |= {"kind": "regular", "height": sea.height, "heading": sea.heading, "status": _worst(solved.status)}
    check: tuple[IdentityCheck, ...] = ()
    if hydro.has_far_field:
        check = _energy(model, solved.far, solved.motions, hydro, f"{unit.name}, {sea.name}")
    return FrequencyResult(
        data, check, (*solved.notices, *solved.motions.notices, *_overtopping(unit, sea.name, elevation))
    )


def motion_ratio(unit: FloatingUnit, amplitude: Array, height: float) -> Array:
    """Return |x|/(H/2), |z|/(H/2) and |theta| B/H (P3 equation 6)."""
    scale = np.array([2.0, 2.0, unit.breakwater.hull.beam])
    return np.asarray(amplitude * scale / height if height > 0.0 else np.full_like(amplitude, np.nan))


def line_tensions(unit: FloatingUnit, solved: DriftedMotions, moving: ComplexArray) -> dict[str, Array]:
    """Tension of one line of each kind: mean and amplitude (linear), largest and smallest along the linear orbit.

    The exact lines are evaluated at the positions of a cycle; lines are at rest at each of them (quasi-static).
    """
    planar, count = unit.mooring.planar, len(moving)
    kinds = len(unit.lines)
    names = (
        "mean_tension",
        "tension_amplitude",
        "maximum_tension",
        "minimum_tension",
        "maximum_anchor_vertical_tension",
    )
    out = {name: np.zeros((count, kinds)) for name in names}
    if not kinds:
        return out
    phase = np.exp(-2j * math.pi * np.arange(PHASES) / PHASES)
    for index in range(count):
        offset, orbit = solved.offset[index], np.nan_to_num(moving[index])
        path = offset + (phase[:, None] * orbit).real
        states = planar.states(
            np.concatenate([offset[None], path, offset + 1e-3 * orbit.real[None], offset + 1e-3 * orbit.imag[None]])
        )
        for column, state in enumerate(states.values()):
            pull = state.tension_fairlead
            out["mean_tension"][index, column] = pull[0]
            # The linear amplitude from small steps along the two quadratures of the orbit
            out["tension_amplitude"][index, column] = 1e3 * abs(complex(pull[-2] - pull[0], pull[-1] - pull[0]))
            out["maximum_tension"][index, column] = pull[: PHASES + 1].max()
            out["minimum_tension"][index, column] = pull[: PHASES + 1].min()
            out["maximum_anchor_vertical_tension"][index, column] = state.vertical_tension_anchor[: PHASES + 1].max()
    load = np.array([line.breaking_load for line in unit.lines])
    out["maximum_utilisation"] = np.where(np.isfinite(load), out["maximum_tension"] / load, np.nan)
    return out


def deck_relative_elevation(unit: FloatingUnit, motions: Motions, k: Array, heading: float) -> Array:
    """Amplitude of the water surface relative to the seaward deck edge per wave amplitude [eq:breakwater-overtopping].

    The surface is the incident wave and its reflection by the fixed and moving body would raise it to twice that at
    most; the incident wave is doubled here, which a wall would do, so that the figure is on the safe side.
    """
    side = -1.0 if math.cos(heading) >= 0.0 else 1.0
    point = (side * 0.5 * unit.breakwater.hull.beam, unit.freeboard)
    surface = 2.0 * np.exp(1j * k * point[0] * math.cos(heading))
    return np.abs(relative_elevation(motions, point, unit.centre, surface[:, None])[:, 0])


def _overtopping(unit: FloatingUnit, name: str, elevation: Array) -> tuple[Notice, ...]:
    worst = float(np.nanmax(elevation)) if np.isfinite(elevation).any() else 0.0
    if worst <= unit.freeboard:
        return ()
    return (
        Notice(
            "overtopping",
            f"{unit.name}, {name}: the water may rise {worst:.3g} m against the seaward deck edge, above the freeboard "
            f"of {unit.freeboard:.3g} m",
            value=worst,
            limit=unit.freeboard,
            remedy="waves over the deck pass energy that linear theory does not count; raise the deck",
            source="wall-doubled incident wave against linear motion",
        ),
    )


def _worst(status: tuple[str, ...]) -> str:
    return "converged" if all(item == "converged" for item in status) else "not_converged"


def irregular_sea(
    model: FrequencyModel, sea: IrregularSea, omega: Array, progress: Progress = silent
) -> FrequencyResult:
    """Response spectra, significant and most probable largest values, transmission weighted by energy, mean drift."""
    import xarray as xr

    unit = model.unit
    density = np.asarray(sea.spectrum.density_at(omega), dtype=float)
    progress("irregular sea", 0, 1)
    headings, share = spread_headings(sea, omega)
    hydros = [model.hydro.at(omega, float(heading)) for heading in headings]
    directional = density[:, None] * share
    met = directional.sum(axis=1)
    main = hydros[int(np.argmin(np.abs(headings - sea.heading)))]
    solved = _irregular_mean(model, main, met)
    stiffness = unit.statics.stiffness + solved.mooring_stiffness[0]
    motions, notices_of_sea = _sea_motions(model, hydros, headings, stiffness, directional)
    statistics = response_statistics(omega, motions.displacement, directional)
    tension = _tension_transfer(unit, motions, solved.offset[0])
    tension_statistics = response_statistics(omega, tension[0], directional)
    waves = response_statistics(omega, np.ones((len(omega), 1)), met)
    duration = sea.duration
    height = float(waves.significant[0])
    out: dict = {
        "wave_spectrum": ("omega", density),
        "response_spectrum": (("omega", "dof"), statistics.spectrum),
        "significant_height": ((), height),
        "significant_motion": ("dof", statistics.significant),
        "most_probable_maximum_motion": ("dof", statistics.most_probable_maximum(duration)),
        "mean_zero_crossing_period": ("dof", statistics.mean_zero_crossing_period),
        "mean_drift_force": ((), float(solved.drift_force[0])),
        "mean_offset": ("dof", solved.offset[0]),
        "mean_tension": ("line", tension[1]),
        "significant_tension": ("line", tension_statistics.significant),
        "most_probable_maximum_tension": ("line", tension[1] + tension_statistics.most_probable_maximum(duration)),
    }
    if main.has_far_field:
        waves_of = [far_field(item, motions.displacement[:, [column]]) for column, item in enumerate(hydros)]
        reflected = np.concatenate([np.abs(item.reflection) for item in waves_of], axis=1)
        transmitted = np.concatenate([np.abs(item.transmission) for item in waves_of], axis=1)
        coefficient = energy_transmission(omega, transmitted, directional)
        out |= {
            "transmission_coefficient": ((), coefficient),
            "transmitted_significant_height": ((), coefficient * height),
            "reflection_coefficient": ((), energy_transmission(omega, reflected, directional)),
            "transmitted_spectrum": ("omega", np.sum(transmitted**2 * directional, axis=1)),
        }
    load = np.array([line.breaking_load for line in unit.lines])
    out["maximum_utilisation"] = (
        "line",
        np.where(np.isfinite(load), np.asarray(out["most_probable_maximum_tension"][1]) / load, np.nan),
    )
    share_over, relative = _overtopping_share(unit, motions, omega, headings, directional)
    out |= {
        "overtopping_share": ((), share_over),
        "significant_relative_elevation": ((), relative),
    }
    coords = {"omega": omega, "dof": list(MODES), "line": [line.name for line in unit.lines]}
    data = labelled(xr.Dataset(out, coords=coords))
    data.attrs |= {
        "kind": "irregular",
        "heading": sea.heading,
        "duration": duration,
        "headings": headings.tolist(),
        "status": _worst(solved.status),
    }
    notices = [*solved.notices, *notices_of_sea]
    lost = 1.0 - float(met.sum() / density.sum())
    if lost > 0.01:
        notices.append(
            Notice(
                "spreading-sector",
                f"{sea.name}: {100.0 * lost:.1f} % of the wave energy travels within 15 degrees of the crest line or "
                "away and does not meet the side of the breakwater",
                value=lost,
                limit=0.01,
            )
        )
    if share_over > 0.01:
        notices.append(
            Notice(
                "overtopping",
                f"{unit.name}, {sea.name}: about {100.0 * share_over:.0f} % of waves may pass the seaward deck edge",
                value=share_over,
                limit=0.01,
                source="Rayleigh distribution of the wall-doubled relative elevation",
            )
        )
    progress("irregular sea", 1, 1)
    return FrequencyResult(data, (), tuple(notices))


def _irregular_mean(model: FrequencyModel, hydro: Hydrodynamics, density: Array) -> DriftedMotions:
    if not hydro.has_far_field:
        return _solve(model, hydro, np.full(len(hydro.omega), 1e-6), silent)
    unit = model.unit
    problem = DriftProblem(
        hydrodynamics=hydro,
        inertia=unit.inertia,
        hydrostatic_stiffness=unit.statics.stiffness,
        mooring=unit.mooring,
        water=unit.water,
        damping=model.damping,
        quadratic=model.quadratic,
        steady_force=model.steady,
    )
    return solve_irregular_with_drift(problem, density, with_drift=model.with_drift)


def _sea_motions(
    model: FrequencyModel, hydros: list[Hydrodynamics], headings: Array, stiffness: Array, directional: Array
) -> tuple[Motions, tuple[Notice, ...]]:
    """Return the motions in all headings of a sea, quadratic damping linearised for the whole of it.

    The linearisation takes the radiation of the first heading for all; each heading is then solved with its own.
    """
    unit, damping = model.unit, model.damping
    if model.quadratic is not None:
        joined = _joined_headings(hydros, headings)
        found = linearised_in_sea(
            joined, unit.inertia, stiffness, directional, quadratic=model.quadratic, damping=model.damping
        )
        damping = LinearDamping(damping.matrix + found.equivalent_damping, damping.critical_fraction)
    each = [solve_motions(item, unit.inertia, stiffness, damping=damping) for item in hydros]
    displacement = np.concatenate([item.displacement for item in each], axis=1)
    notices = tuple(notice for item in each for notice in item.notices)
    return replace(each[0], heading=headings, displacement=displacement), notices


def _joined_headings(hydros: list[Hydrodynamics], headings: Array) -> Hydrodynamics:
    """Put one-heading coefficients side by side; radiation is that of the first (motions equal along the unit)."""
    first = hydros[0]
    if len(hydros) == 1:
        return first

    def beside(name: str) -> ComplexArray | None:
        values = [getattr(item, name) for item in hydros]
        return None if values[0] is None else np.concatenate(values, axis=1)

    excitation = np.concatenate([item.excitation for item in hydros], axis=1)
    return replace(
        first,
        heading=np.asarray(headings, dtype=float),
        excitation=excitation,
        reflection=beside("reflection"),
        transmission=beside("transmission"),
    )


def _tension_transfer(unit: FloatingUnit, motions: Motions, offset: Array) -> tuple[ComplexArray, Array]:
    """Linear tension per wave amplitude (n, h, lines) about the mean offset, and the mean tensions."""
    if not unit.lines:
        return np.zeros((*motions.displacement.shape[:2], 0), dtype=complex), np.zeros(0)
    steps = np.diag([1e-4 * unit.breakwater.hull.beam, 1e-4 * unit.breakwater.hull.beam, 1e-4])
    around = np.concatenate([offset[None], offset + steps, offset - steps])
    pull = unit.mooring.planar.tensions(around)
    slope = (pull[1:4] - pull[4:7]) / (2.0 * np.diag(steps))[:, None]
    return motions.displacement @ slope, pull[0]


def _overtopping_share(
    unit: FloatingUnit, motions: Motions, omega: Array, headings: Array, directional: Array
) -> tuple[float, float]:
    """Return the share of waves over the deck edge [eq:breakwater-overtopping] and the significant double amplitude."""
    k = 2.0 * math.pi / wavelengths(omega, unit)
    columns = []
    for column, heading in enumerate(headings):
        one = replace(
            motions, heading=headings[column : column + 1], displacement=motions.displacement[:, column : column + 1]
        )
        columns.append(deck_relative_elevation(unit, one, k, float(heading)))
    statistics = response_statistics(omega, np.stack(columns, axis=1)[..., None], directional)
    significant = float(statistics.significant[0])
    if unit.freeboard <= 0.0:
        return 1.0, significant
    return (math.exp(-2.0 * unit.freeboard**2 / (0.5 * significant) ** 2) if significant > 0.0 else 0.0), significant


__all__ = [
    "FrequencyModel",
    "FrequencyResult",
    "irregular_sea",
    "make_model",
    "operators",
    "point_motion",
    "regular_sea",
]
