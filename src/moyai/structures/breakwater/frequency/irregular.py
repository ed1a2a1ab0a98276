"""Irregular seas in the frequency domain: spectra and statistics of the response, transmission, mean drift."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.progress import Progress, silent
from moyai.core.validity import Notice
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.damping import LinearDamping
from moyai.floating.far_field import drift_force_per_amplitude_squared, far_field
from moyai.floating.frequency import Motions
from moyai.floating.irregular import (
    ResponseStatistics,
    SeaMotions,
    energy_transmission,
    integration_weights,
    linearised_in_sea,
    response_statistics,
)
from moyai.floating.offset import mean_offset
from moyai.structures.breakwater.assembly import FloatingUnit
from moyai.structures.breakwater.frequency.about_rest import (
    band_factors,
    band_words,
    equivalent_variables,
    natural_added_mass,
    scaled_damping,
)
from moyai.structures.breakwater.frequency.model import (
    FrequencyModel,
    FrequencyResult,
    water_motion,
)
from moyai.structures.breakwater.hydrodynamics import spread_headings
from moyai.structures.breakwater.model import IrregularSea
from moyai.structures.breakwater.responses import (
    overtopping_share,
    tension_transfer,
)
from moyai.structures.breakwater.settings import MODES
from moyai.structures.breakwater.slow_drift import SlowDrift, combined_extremes, slow_drift
from moyai.structures.breakwater.variables import VOCABULARY

MOST_TURNS = 60  # of the loop of drift and stiffness


def irregular_sea(
    model: FrequencyModel, sea: IrregularSea, omega: Array, progress: Progress = silent
) -> FrequencyResult:
    """Response spectra, significant and most probable largest values, transmission weighted by energy, mean drift."""
    unit = model.unit
    density = np.asarray(sea.spectrum.density_at(omega), dtype=float)
    progress("irregular sea", 0, 1)
    headings, share = spread_headings(sea, omega)
    hydros = [model.hydro.at(omega, float(heading)) for heading in headings]
    directional = density[:, None] * share
    met = directional.sum(axis=1)
    settled = _settle(model, hydros, headings, directional)
    motions, offset = settled.motions, settled.offset
    statistics = response_statistics(omega, motions.displacement, directional)
    tension = tension_transfer(unit, motions, offset)
    tension_statistics = response_statistics(omega, tension[0], directional)
    waves = response_statistics(omega, np.ones((len(omega), 1)), met)
    duration = sea.duration
    slow = _slow(model, hydros, settled, directional)
    height = float(waves.significant[0])
    out: dict[str, Any] = {
        "wave_spectrum": ("omega", density),
        "response_spectrum": (("omega", "dof"), statistics.spectrum),
        "significant_height": ((), height),
        "significant_motion": ("dof", statistics.significant),
        "most_probable_maximum_motion": ("dof", statistics.most_probable_maximum(duration)),
        "mean_zero_crossing_period": ("dof", statistics.mean_zero_crossing_period),
        "mean_drift_force": ((), settled.force),
        "mean_offset": ("dof", offset),
        "line_tension_mean": ("line", tension[1]),
        "significant_tension": ("line", tension_statistics.significant),
        "most_probable_maximum_tension": ("line", tension[1] + tension_statistics.most_probable_maximum(duration)),
    }
    if hydros[0].has_far_field:
        waves_of = [far_field(item, motions.displacement[:, [column]]) for column, item in enumerate(hydros)]
        reflected = np.concatenate([np.abs(item.reflection_coefficient) for item in waves_of], axis=1)
        transmitted = np.concatenate([np.abs(item.transmission_coefficient) for item in waves_of], axis=1)
        coefficient = energy_transmission(omega, transmitted, directional)
        out |= {
            "transmission_coefficient": ((), coefficient),
            "transmitted_significant_height": ((), coefficient * height),
            "reflection_coefficient": ((), energy_transmission(omega, reflected, directional)),
            "transmitted_spectrum": ("omega", np.sum(transmitted**2 * directional, axis=1)),
        }
    factors = (_peak_factors(statistics, duration), _peak_factors(tension_statistics, duration))
    extremes = combined_extremes(
        unit, offset, motions.displacement, tension[0], directional, omega, slow, factors, duration
    )
    out |= _band(model, hydros, headings, directional, settled)
    hydro = model.hydro.unit
    out |= equivalent_variables(
        ("dof",),
        settled.damping.at(model.inertia, natural_added_mass(model, hydro), settled.stiffness),
        model.inertia,
        natural_added_mass(model, hydro),
        settled.stiffness,
    )
    load = np.array([line.breaking_load for line in unit.lines])
    out |= {
        "line_tension_maximum": ("line", extremes.tension),
        "anchor_vertical_tension_maximum": ("line", extremes.anchor_vertical),
        "anchor_horizontal_tension_maximum": ("line", extremes.anchor_horizontal),
        "anchor_vertical_tension_of_storms": (("line", "storm_end"), extremes.vertical_of_storms),
        "anchor_horizontal_tension_of_storms": (("line", "storm_end"), extremes.horizontal_of_storms),
        "least_grounded_length": ("line", extremes.grounded),
        "largest_offset": ((), extremes.offset),
        "maximum_utilisation": ("line", np.where(np.isfinite(load), extremes.tension / load, np.nan)),
        **_slow_variables(slow),
    }
    share_over, relative = overtopping_share(unit, motions, omega, headings, directional)
    out |= {
        "overtopping_share": ((), share_over),
        "significant_relative_elevation": ((), relative),
    }
    coords = {"omega": omega, "dof": list(MODES), "line": [line.name for line in unit.lines]}
    attributes = {
        "kind": "irregular",
        "heading": sea.heading,
        "duration": duration,
        "headings": headings.tolist(),
        "status": settled.status,
        "damping_band": band_words(model),
        "drift": "none" if slow is None else "newman",
    }
    data = VOCABULARY.dataset(out, coords, attributes)
    notices = list(settled.notices)
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


def _peak_factors(statistics: ResponseStatistics, duration: float) -> Array:
    """Return the most probable largest amplitudes over the standard deviations."""
    deviation = statistics.standard_deviation
    return np.asarray(statistics.most_probable_maximum(duration) / np.where(deviation > 0.0, deviation, 1.0))


def _slow_variables(slow: SlowDrift | None) -> dict[str, Any]:
    if slow is None:
        return {}
    return {
        "slow_motion_deviation": ("dof", slow.deviation),
        "slow_sway_deviation_half_damping": ((), slow.half_damping),
        "slow_sway_deviation_double_damping": ((), slow.double_damping),
        "slow_sway_period": ((), slow.natural_period),
        "slow_sway_damping_ratio": ((), slow.damping_ratio),
    }


def _slow(
    model: FrequencyModel, hydros: list[Hydrodynamics], settled: _Settled, directional: Array
) -> SlowDrift | None:
    """Return the slow drift of a sea, ``None`` without drift."""
    if not (model.with_drift and hydros[0].has_far_field) or settled.status != "converged":
        return None
    columns = [_drift_of(model.unit, hydro, settled.motions, column) for column, hydro in enumerate(hydros)]
    stiffness = model.unit.mooring.stiffness(settled.offset)
    return slow_drift(model, hydros[0].omega, directional, np.stack(columns, axis=1), stiffness, settled.damping)


@dataclass(frozen=True)
class _Settled:
    """Motions about the offset of their own drift, all headings of a sea together."""

    motions: Motions
    force: float
    offset: Array
    status: str
    notices: tuple[Notice, ...]
    damping: LinearDamping
    stiffness: Array
    linearised: SeaMotions


def _settle(
    model: FrequencyModel,
    hydros: list[Hydrodynamics],
    headings: Array,
    directional: Array,
    start: _Settled | None = None,
) -> _Settled:
    """Find the mean drift of the whole sea, every heading with its own, and the offset and stiffness that go with it.

    The loop of P3 for a sea: drift moves the unit, the moved lines are stiffer, the stiffer unit drifts differently.
    The drift is the sum over frequencies and headings of twice the spectrum times the drift per amplitude squared.
    ``start`` is the answer with a damping nearby, from which the loop continues.
    """
    unit = model.unit
    weights = integration_weights(hydros[0].omega)
    drifting = model.with_drift and hydros[0].has_far_field
    moving = water_motion(model, hydros[0].omega, headings)
    near: SeaMotions | None = None
    force, place = 0.0, np.zeros(3)
    if start is not None:
        force, place, near = start.force, start.offset, start.linearised
    status: str = "not_converged"
    for _ in range(MOST_TURNS):
        pushed = model.steady + np.array([force, 0.0, 0.0])
        mean = mean_offset(unit.mooring, unit.statics.stiffness, pushed, start=place)
        offset = mean.position if mean.status == "converged" else np.zeros(3)
        place, stiffness = offset, unit.statics.stiffness + unit.mooring.stiffness(offset)
        near = linearised_in_sea(
            hydros,
            model.inertia,
            stiffness,
            directional,
            quadratic=model.quadratic,
            damping=model.damping,
            water_motion=moving,
            start=near,
        )
        if not drifting:
            status = str(mean.status)
            break
        before, force = force, _drift(unit, hydros, near.motions, directional, weights)
        if abs(force - before) <= 1e-6 * max(abs(force), 1e-12):
            status = str(mean.status)
            break
    assert near is not None
    damping = LinearDamping(model.damping.matrix + near.equivalent_damping, model.damping.critical_fraction)
    motions = replace(near.motions, heading=headings)
    return _Settled(motions, force, offset, status, motions.notices, damping, stiffness, near)


def _band(
    model: FrequencyModel, hydros: list[Hydrodynamics], headings: Array, directional: Array, settled: _Settled
) -> dict[str, Any]:
    """Return transmission and motion with the damping of the unit at both ends of its band, nominal included."""
    omega = hydros[0].omega
    answers = [settled]
    for factor in band_factors(model):
        answers.append(_settle(scaled_damping(model, factor), hydros, headings, directional, settled))
    motion = np.array(
        [response_statistics(omega, item.motions.displacement, directional).significant for item in answers]
    )
    out: dict[str, Any] = {
        "significant_motion_low": ("dof", motion.min(axis=0)),
        "significant_motion_high": ("dof", motion.max(axis=0)),
    }
    if hydros[0].has_far_field:
        passed = [_transmission(hydros, item.motions, directional) for item in answers]
        out["transmission_coefficient_low"] = ((), min(passed))
        out["transmission_coefficient_high"] = ((), max(passed))
    return out


def _transmission(hydros: list[Hydrodynamics], motions: Motions, directional: Array) -> float:
    """Return the energy-weighted transmission of a sea."""
    waves = [far_field(item, motions.displacement[:, [column]]) for column, item in enumerate(hydros)]
    transmitted = np.concatenate([np.abs(item.transmission_coefficient) for item in waves], axis=1)
    return energy_transmission(hydros[0].omega, transmitted, directional)


def _drift(
    unit: FloatingUnit, hydros: list[Hydrodynamics], motions: Motions, directional: Array, weights: Array
) -> float:
    total = 0.0
    for column, hydro in enumerate(hydros):
        square = _drift_of(unit, hydro, motions, column)
        total += float(np.sum(2.0 * weights * directional[:, column] * square))
    return total


def _drift_of(unit: FloatingUnit, hydro: Hydrodynamics, motions: Motions, column: int) -> Array:
    """Return the mean drift over amplitude squared of one heading [N/m2]."""
    far = far_field(hydro, motions.displacement[:, [column]])
    return drift_force_per_amplitude_squared(far, hydro.omega, hydro.heading, unit.water, hydro.length)[:, 0]
