"""Validation of rigid cages: statics and motions of a published model cage, exact limits, identities."""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from moyai.core.validation import ValidationCase
from moyai.sea.environment import Environment
from moyai.structures.cage.rigid.matsubara import VISCOSITY, WATER, model_cage, taut_lines
from moyai.structures.cage.rigid.model import RigidCageProblem, RigidCageSettings
from moyai.structures.cage.rigid.modes import natural_modes
from moyai.structures.cage.rigid.pack import pack
from moyai.structures.cage.rigid.runs import RigidCageRun, run_wave
from moyai.structures.cage.rigid.statics import equilibrium_with_lines, free_floating
from moyai.structures.cage.rigid.waves import wave_of

_PAPER = "Matsubara, Noda and Nishihira, dynamic response of an offshore fish cage"
_PROTOTYPE = f"independent prototype of the cage of {_PAPER}"
_GRAM = 9.81e-3


@cache
def _run(
    kind: str, period: float, height: float, reach: float = 0.3, stiffness: float = 2000.0, pull: float = 0.011
) -> RigidCageRun:
    """Run the model cage; ``free`` without lines, ``bare`` without lines and drag."""
    cage = model_cage(drag=kind != "bare")
    moored = kind not in ("free", "bare")
    name = "crossed_top" if kind == "crossed" else "outward_bottom"
    lines = (
        taut_lines(cage, kind=name, anchor_distance=reach, pull_down=pull, stiffness=stiffness)  # type: ignore[arg-type]
        if moored
        else ()
    )
    settings = RigidCageSettings(periods=24, settled_periods=8, tolerance=1e-5)
    problem = RigidCageProblem("", cage, (), VISCOSITY, Environment(WATER), settings=settings)
    rest = equilibrium_with_lines(cage, lines, WATER, VISCOSITY) if lines else free_floating(cage, WATER, VISCOSITY)
    return run_wave(problem, lines, rest, WATER, wave_of("linear", height, period, 0.0, WATER, 0.0, settings.periods))


def _ratio(mode: int, kind: str, period: float, height: float = 0.03) -> float:
    return float(_run(kind, period, height).numbers.range[mode]) / height


def _rotation(kind: str, period: float, height: float = 0.03) -> float:
    return math.degrees(0.5 * float(_run(kind, period, height).numbers.range[2]))


def _peak(stiffness: float) -> float:
    found = _run("outward", 1.1, 0.03, 0.5, stiffness, 0.012)
    return float(found.numbers.line_tension_maximum.max()) / _GRAM


def _heave_period() -> float:
    """Return the natural period of heave of the free cage over its exact value."""
    cage = model_cage()
    free = free_floating(cage, WATER, VISCOSITY)
    periods, shapes = natural_modes(pack(cage, (), WATER, VISCOSITY), free, 0.2)
    radius = 0.5 * cage.floats.diameter
    high = radius - (free.z + 0.1 - cage.centre[1])
    area = 12.0 * math.pi * high * (2.0 * radius - high)
    added = 0.5 * 1000.0 * 12.0 * math.pi * high**2 * (radius - high / 3.0)
    # rods of the level edges wholly, the bottom net wholly, the walls by half
    added += 1000.0 * 8.0 * cage.rods[0].volume + 1000.0 * cage.net_volume * (0.04 + 0.5 * 0.16)
    exact = 2.0 * math.pi * math.sqrt((cage.mass + added) / (1000.0 * 9.81 * area))
    heave = int(np.argmax(np.abs(shapes[:, 1])))
    return float(periods[heave]) / exact


def _literal() -> float:
    """Return the heave range over H with the volume of the whole cage in the inertia force, fault (ii) in print."""
    from moyai.structures.cage.rigid.literal import literal_pack
    from moyai.structures.cage.rigid.time import march

    cage = model_cage()
    lines = taut_lines(cage)
    rest = equilibrium_with_lines(cage, lines, WATER, VISCOSITY)
    wave = wave_of("linear", 0.03, 1.1, 0.0, WATER, 0.0, 16)
    packed = pack(cage, lines, WATER, VISCOSITY, waves=wave.components, ramp=5.5)
    packed = literal_pack(packed, cage, WATER, ("enclosed_volume",))
    start = np.concatenate([rest.place, np.zeros(3)])
    found = march(packed, start, duration=17.6, spacing=0.011, size=0.2, period=1.1, tolerance=1e-5)
    return float(found.tension_peak[found.time > 8.8].max()) / _GRAM / 1000.0


_OURS = "the prototype's anchors and pull are given as ranges only"

CASES: tuple[ValidationCase, ...] = (
    ValidationCase(
        "cage: floats in water at rest",
        _PROTOTYPE,
        lambda: free_floating(model_cage(), WATER, VISCOSITY).immersion,
        0.81,
        0.01,
        relative=False,
    ),
    ValidationCase(
        "cage: middle of the floating cage [m]",
        _PROTOTYPE,
        lambda: free_floating(model_cage(), WATER, VISCOSITY).middle_z,
        -0.109,
        0.0005,
        relative=False,
    ),
    ValidationCase("cage: moment of inertia [kg m2]", _PROTOTYPE, lambda: model_cage().inertia, 4.72e-3, 0.01),
    ValidationCase("cage: natural heave over the exact one", "formulas of the sphere's cap", _heave_period, 1.0, 1e-5),
    ValidationCase(
        "cage: free, no drag, sway/H at T = 1.5 s",
        "orbit of long waves, coth kh",
        lambda: _ratio(0, "bare", 1.5),
        1.291,
        0.03,
        note="the cage is 0.07 wavelengths large and does not float at the surface itself",
    ),
    ValidationCase("cage: free, sway/H at T = 1.0 s", _PROTOTYPE, lambda: _ratio(0, "free", 1.0), 0.84, 0.08),
    ValidationCase("cage: free, heave/H at T = 1.0 s", _PROTOTYPE, lambda: _ratio(1, "free", 1.0), 0.97, 0.03),
    ValidationCase("cage: free, rotation at T = 1.0 s [deg]", _PROTOTYPE, lambda: _rotation("free", 1.0), 4.2, 0.05),
    ValidationCase("cage: free, sway/H at T = 2.0 s", _PROTOTYPE, lambda: _ratio(0, "free", 2.0), 1.58, 0.05),
    ValidationCase(
        "cage: crossed, sway/H at T = 1.1 s", _PROTOTYPE, lambda: _ratio(0, "crossed", 1.1), 0.30, 0.05, note=_OURS
    ),
    ValidationCase(
        "cage: crossed, heave/H at T = 1.1 s", _PROTOTYPE, lambda: _ratio(1, "crossed", 1.1), 0.25, 0.05, note=_OURS
    ),
    ValidationCase(
        "cage: crossed, rotation at T = 1.1 s [deg]", _PROTOTYPE, lambda: _rotation("crossed", 1.1), 5.8, 0.05
    ),
    ValidationCase("cage: peak at 1 kN/m [gf]", _PROTOTYPE, lambda: _peak(1e3), 230.0, 0.08, note=_OURS),
    ValidationCase("cage: peak at 10 kN/m [gf]", _PROTOTYPE, lambda: _peak(1e4), 646.0, 0.05, note=_OURS),
    ValidationCase(
        "cage: growth of the peak from 1 to 10 kN/m",
        "spring that stops a body, v sqrt(k m)",
        lambda: math.log10(_peak(1e4) / _peak(1e3)),
        0.5,
        0.03,
        relative=False,
    ),
    ValidationCase(
        "cage: printed volume, peak [kgf]",
        f"{_PROTOTYPE}: 1.7 to 2.3 kgf",
        _literal,
        2.0,
        0.35,
        relative=False,
        note="the range of the prototype and a little more",
    ),
)
