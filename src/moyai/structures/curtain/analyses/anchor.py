"""Anchor loads in the sea states of a case: squared velocity and energy model of Tabata et al."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.validity import IdentityCheck, Notice
from moyai.structures.curtain.assembly import LevelCurtain
from moyai.structures.curtain.model import AnchorLoadSettings, LimitSettings
from moyai.structures.curtain.seas.anchor_energy import EnergyModel, check_energy_model
from moyai.structures.curtain.seas.squared_velocity import (
    check_direction_rule,
    check_squared_velocity,
    effective_height,
    mean_squared_velocity,
    squared_velocity,
    surface_speed,
)
from moyai.structures.curtain.seas.states import DesignWave
from moyai.structures.curtain.variables import labelled

if TYPE_CHECKING:
    import xarray as xr

RULES = ("paper", "normal", "none")
_ANGLES = np.radians(np.linspace(0.0, 90.0, 46))
_HEIGHT_STEPS = 40


def steady_tension(unit: LevelCurtain, settings: AnchorLoadSettings) -> float:
    """Return the steady tension of the anchor line [N]: given, of the statics, or 0 where it does not count."""
    anchors = unit.curtain.anchors
    if not settings.pretension or anchors is None:
        return 0.0
    if anchors.pretension is not None:
        return anchors.pretension
    return unit.statics.anchor_tension if unit.surface_speed > 0.0 else 0.0


def rope_model(unit: LevelCurtain, settings: AnchorLoadSettings) -> EnergyModel:
    """Return the energy model of the anchor rope."""
    anchors = unit.curtain.anchors
    return settings.model(math.nan if anchors is None else anchors.stiffness)


def anchor_dataset(
    unit: LevelCurtain, settings: AnchorLoadSettings, limits: LimitSettings, waves: tuple[DesignWave, ...]
) -> xr.Dataset:
    """Return the group ``anchor_loads``: one row a wave, with the direction rules and curves next to it.

    Parameters
    ----------
    unit : LevelCurtain
        With anchor lines.
    settings : AnchorLoadSettings
    limits : LimitSettings
        Gives the period that goes with a height in the curves.
    waves : tuple of DesignWave
        Not empty.
    """
    import xarray as xr

    model, water, current = rope_model(unit, settings), unit.water, unit.normal_speed
    steady = steady_tension(unit, settings)
    period = np.array([wave.period for wave in waves])
    ratio = np.array([settings.height_ratio if wave.irregular else 1.0 for wave in waves])
    given = np.array([wave.significant_height for wave in waves])
    angle = np.array([wave.angle for wave in waves])

    def height(rule: Any, turned: Array) -> Array:
        return np.asarray(effective_height(given * ratio, turned, rule, 1.0))

    def rise(acting: Array, time: Array, pretension: float) -> Array:
        return model.fluctuating_tension(model.float_speed(acting, time, current, water), pretension)

    acting = height(settings.rule, angle)
    plain, pulled = rise(acting, period, 0.0), rise(acting, period, steady)
    rows = {
        "significant_height": given,
        "wave_period": period,
        "wave_angle": angle,
        "effective_height": acting,
        "squared_velocity": squared_velocity(acting, period, current, unit.depth, water),
        "mean_squared_velocity": mean_squared_velocity(acting, period, current, unit.depth, water),
        "orbital_speed": surface_speed(acting, period, water),
        "float_speed": model.float_speed(acting, period, current, water),
        "rope_tension": plain,
        "rope_tension_pretensioned": pulled,
        "wire_tension": settings.wire_factor * pulled,
        "total_rope_tension": steady + pulled,
        "conventional_tension": pulled / settings.new_type_factor,
    }
    by_rule = {rule: height(rule, angle) for rule in RULES}
    steps = np.linspace(0.0, 1.0, _HEIGHT_STEPS + 1)[1:]
    heights = given[:, None] * 1.5 * steps
    # the steepness of the sea is kept along the curve: T goes with the root of the height
    times = period[:, None] * np.sqrt(heights / given[:, None])
    curve = acting[:, None] * 1.5 * steps
    data: dict[str, Any] = {
        **{name: ("sea", values) for name, values in rows.items()},
        "rule_height": (("sea", "direction_rule"), np.stack([by_rule[rule] for rule in RULES], axis=1)),
        "rule_squared_velocity": (
            ("sea", "direction_rule"),
            np.stack([squared_velocity(by_rule[rule], period, current, unit.depth, water) for rule in RULES], axis=1),
        ),
        "rule_tension": (
            ("sea", "direction_rule"),
            np.stack([rise(by_rule[rule], period, steady) for rule in RULES], axis=1),
        ),
        "angle_tension": (
            ("sea", "direction_rule", "angle"),
            np.stack(
                [
                    np.stack(
                        [rise(height(rule, np.full(len(waves), turn)), period, steady) for turn in _ANGLES], axis=1
                    )
                    for rule in RULES
                ],
                axis=1,
            ),
        ),
        "height": (("sea", "height_step"), heights),
        "height_tension": (("sea", "height_step"), rise(curve, times, steady)),
        "height_squared_velocity": (
            ("sea", "height_step"),
            squared_velocity(curve, times, current, unit.depth, water),
        ),
        "energy_factor": ((), settings.energy_factor),
        "float_mass": ((), settings.float_mass),
        "rope_stiffness": ((), model.rope_stiffness),
        "mass_product": ((), settings.energy_factor * settings.float_mass),
        "pretension": ((), steady),
        "response_time": ((), model.response_time),
    }
    coords = {"sea": [wave.name for wave in waves], "direction_rule": list(RULES), "angle": _ANGLES}
    return labelled(xr.Dataset(data, coords=coords, attrs={"direction_rule": settings.rule}))


def anchor_notices(
    unit: LevelCurtain, settings: AnchorLoadSettings, waves: tuple[DesignWave, ...]
) -> tuple[Notice, ...]:
    """Return where squared velocity and energy model leave their range."""
    notices: list[Notice] = [*check_direction_rule(settings.rule, "energy")]
    for wave in waves:
        acting = wave.effective_height(settings.rule, settings.height_ratio)
        notices += check_squared_velocity(acting, wave.period, unit.normal_speed, unit.water)
        notices += check_energy_model(rope_model(unit, settings), wave.period)
    if unit.surface_speed == 0.0 and settings.pretension and _given_pretension(unit) is None:
        notices.append(
            Notice(
                "curtain-no-pretension",
                "without a current and without a pretension of the anchors the rope has no steady tension",
                severity="information",
                source="Tabata et al.: pretension is left out",
            )
        )
    return tuple(notices)


def _given_pretension(unit: LevelCurtain) -> float | None:
    return None if unit.curtain.anchors is None else unit.curtain.anchors.pretension


def anchor_checks(unit: LevelCurtain, data: xr.Dataset) -> tuple[IdentityCheck, ...]:
    """Return the identities of the anchor loads: energy of the rope, and the squared velocity by quadrature."""
    steady = float(data["pretension"])
    rise = data["rope_tension_pretensioned"].values
    speed = np.maximum(data["float_speed"].values, 0.0)
    stiffness = float(data["rope_stiffness"])
    stored = ((steady + rise) ** 2 - steady**2) / (2.0 * stiffness)
    given = 0.5 * float(data["mass_product"]) * speed**2
    energy = float(np.max(np.abs(stored / np.where(given > 0.0, given, 1.0) - (given > 0.0))))
    return (
        IdentityCheck(f"{unit.name}: energy of the rope", energy, 1e-9, "stretch beyond the steady one = M m_B U^2/2"),
        IdentityCheck(
            f"{unit.name}: squared velocity under the crest",
            _quadrature_miss(unit, data),
            1e-9,
            "mean over the skirt of (u_crest + U)^2 by quadrature",
        ),
    )


def _quadrature_miss(unit: LevelCurtain, data: xr.Dataset) -> float:
    from moyai.sea.kinematics import depth_functions

    nodes, weights = np.polynomial.legendre.leggauss(60)
    z = -0.5 * unit.depth * (1.0 - nodes)
    worst = 0.0
    for height, period, expected in zip(
        data["effective_height"].values, data["wave_period"].values, data["squared_velocity"].values
    ):
        omega = 2.0 * math.pi / float(period)
        from moyai.sea.dispersion import wave_number

        k = float(wave_number(omega, unit.water.depth, unit.water.gravity))
        crest = 0.5 * float(height) * omega * np.asarray(depth_functions(k, unit.water.depth, z)[0])
        mean = 0.5 * float(weights @ (crest + unit.normal_speed) ** 2)
        worst = max(worst, abs(mean / float(expected) - 1.0) if expected > 0.0 else mean)
    return worst
