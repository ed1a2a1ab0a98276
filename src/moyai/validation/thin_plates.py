"""Thin plates in the limits of frequency and in waves, alone and on hulls, against closed forms and references."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.core.validation import ValidationCase
from moyai.potential.drift import mean_drift_far_field, mean_drift_near_field
from moyai.potential.modes import Modes, Rigid, rigid_modes
from moyai.potential.plates import PlateLine
from moyai.potential.shapes import pi_type, rectangle
from moyai.potential.skirt_modes import edge_modes, stretching_modes
from moyai.potential.solution import RadiationDiffraction
from moyai.potential.solver import solve
from moyai.potential.thin_plate import Plate, hanging_arc, solve_plate_limit
from moyai.potential.thin_plate_waves import plate_memory, plate_section, solve_plate_waves
from moyai.potential.vertical_barrier import solve_vertical_barrier
from moyai.sea.water import Water

_APERY = 1.2020569031595942


def _hanging(depth: float, frequency: str = "infinite") -> float:
    plate, water = Plate((0.0, 0.0), (0.0, -1.0)), Water(depth, 1.0, 9.81)
    limit = solve_plate_limit(plate, water, frequency="zero" if frequency == "zero" else "infinite")
    return float(limit.added_mass[0, 0])


def _half_circle() -> float:
    limit = solve_plate_limit(hanging_arc(1.0, 0.0), Water(math.inf, 1.0, 9.81))
    return float(limit.added_mass[0, 0]) * math.pi / 2.0


def _swaying(depth: float, omega: list[float], accuracy: float = 1e-5) -> RadiationDiffraction:
    section = plate_section(Plate((0.0, 0.0), (0.0, -1.0)))
    sway = Modes(("sway",), (Rigid("sway"),))
    return solve(section, Water(depth, 1.0, 9.81), omega, modes=sway, accuracy=accuracy)


def ursell_barrier(relative_draught: Array) -> tuple[ComplexArray, ComplexArray]:
    """Return R and T of a barrier in deep water (Ursell 1947), by wave number times draught."""
    from scipy.special import iv, kv

    common = math.pi * iv(1, relative_draught) + 1j * kv(1, relative_draught)
    return math.pi * iv(1, relative_draught) / common, 1j * kv(1, relative_draught) / common


def _ursell() -> float:
    """Largest error of R and T over Kd = 0.1 to 4 in deep water."""
    ka = np.array([0.1, 0.5, 1.0, 2.0, 4.0])
    reflection, transmission = ursell_barrier(ka)
    found = _swaying(math.inf, list(np.sqrt(9.81 * ka))).normal
    apart = found.reflection_coefficient - reflection, found.transmission_coefficient - transmission
    return float(np.abs(apart).max())


def _eigenfunctions() -> float:
    """Largest difference of added mass, over 2 rho d^2 / pi, and of R from the sums over eigenfunctions, h/d = 3."""
    omega = np.sqrt(9.81 * np.array([0.1, 0.5, 1.0, 2.0, 4.0]))
    reference = solve_vertical_barrier(1.0, Water(3.0, 1.0, 9.81), omega, evanescent_modes=8000, polynomials=18)
    found = _swaying(3.0, list(omega), 1e-6)
    mass = np.abs(found.added_mass[:, 0, 0] - reference.added_mass).max() * math.pi / 2.0
    return float(max(mass, np.abs(found.normal.reflection_coefficient - reference.reflection_coefficient).max()))


def _tail() -> float:
    omega = math.sqrt(9.81 * 200.0)
    return float(_swaying(3.0, [omega]).radiation_damping[0, 0, 0] * omega**3 / (4.0 * 9.81**2))


def _kernel(time: float) -> float:
    kernel, _ = plate_memory(1.0, Water(2.67, 1.0, 9.81), np.array([0.0, time]) / math.sqrt(9.81))
    return float(kernel[1] / 9.81)


def _lower_edge() -> float:
    plate = Plate((0.0, 0.0), (0.0, -1.0))
    waves = solve_plate_waves(plate, Water(math.inf, 1.0, 9.81), [1.0, 3.0], modes=edge_modes(plate), accuracy=1e-6)
    return float(waves.solution.infinite_frequency_added_mass[1, 1])


def _stretch() -> float:
    arc = hanging_arc(1.0, 0.3)
    waves = solve_plate_waves(arc, Water(math.inf, 1.0, 9.81), [1.0, 3.0], modes=stretching_modes(arc))
    return float(waves.solution.infinite_frequency_added_mass[1, 1]) * math.pi / 2.0


def _suction() -> float:
    """Drift by pressure with the suction of both edges over that by momentum, inclined submerged plate that moves."""
    plate = PlateLine(np.array([(0.0, -0.5), (0.7, -1.6)]))
    found = solve_plate_waves(plate, Water(3.0, 1025.0, 9.81), [2.5], accuracy=1e-6)
    motions = np.array([[0.6 - 0.3j, 0.2j, 0.3]])
    return float(found.drift_by_pressure(motions).horizontal[0] / found.drift_by_momentum(motions).horizontal[0])


def _keel_plates(heading: float) -> float:
    """Largest change of T when keel plates of a box become 3 mm thick in place of nothing."""
    water, omega, motion = Water(6.0, 1025.0, 9.81), [1.6, 2.6], rigid_modes((0.0, -0.3))
    plates = [PlateLine(np.array([(side, 0.0), (side, -1.2)])) for side in (-2.0, 2.0)]
    thin = rectangle(4.0, 2.0).with_plates(*plates).immersed(1.5)
    thick = pi_type(4.0, 2.0, 1.2, 3e-3).immersed(2.7)
    parts = [
        solve(section, water, omega, modes=motion, heading=heading).transmission_coefficient
        for section in (thin, thick)
    ]
    return float(np.abs(parts[0] - parts[1]).max())


def _hull_drift() -> float:
    """Drift by pressure over that by momentum, box with a curtain under it, fixed."""
    section = rectangle(4.0, 2.0).with_plates(PlateLine(np.array([(0.5, 0.0), (0.8, -1.5)]))).immersed(1.5)
    found = solve(section, Water(6.0, 1025.0, 9.81), [1.8], modes=rigid_modes((0.0, -0.3)), accuracy=1e-5)
    return float(mean_drift_near_field(found).horizontal[0] / mean_drift_far_field(found).horizontal[0])


CASES: tuple[ValidationCase, ...] = (
    ValidationCase(
        "thin plates: flat plate, infinite frequency, deep water",
        "2 rho d^2 / pi, Sawaragi, Aoki and Liu (1991) eq. 1",
        lambda: _hanging(math.inf),
        2.0 / math.pi,
        1e-10,
    ),
    ValidationCase(
        "thin plates: flat plate that reaches the bed",
        "28 zeta(3) / pi^3, closed form",
        lambda: _hanging(1.0),
        28.0 * _APERY / math.pi**3,
        1e-8,
    ),
    ValidationCase(
        "thin plates: zero frequency, depth twice the draught",
        "-(4 rho h^2 / pi) ln cos(pi d / 2h), closed form",
        lambda: _hanging(2.0, "zero"),
        -16.0 / math.pi * math.log(math.cos(0.25 * math.pi)),
        1e-6,
    ),
    ValidationCase(
        "thin plates: half circle over flat plate",
        "vortex panels of another construction: 1.461 +- 0.003; Sawaragi, Aoki and Liu (1991): about 1.4",
        _half_circle,
        1.461,
        0.003,
        False,
        "spread of the source",
    ),
    ValidationCase(
        "thin plates: reflection and transmission of a barrier in deep water",
        "Ursell (1947), closed form; largest error over Kd 0.1 to 4",
        _ursell,
        0.0,
        1e-5,
        False,
    ),
    ValidationCase(
        "thin plates: added mass and reflection in finite depth",
        "matched eigenfunctions with 8000 modes; largest difference over Kd 0.1 to 4",
        _eigenfunctions,
        0.0,
        2e-5,
        False,
    ),
    ValidationCase(
        "thin plates: damping at high frequency, B omega^3 / 4 rho g^2",
        "either face reflects as a cliff, exact limit",
        _tail,
        1.0,
        1e-3,
    ),
    ValidationCase(
        "thin plates: memory K(sqrt(d/g)) / (rho d g), h/d = 2.67",
        "cosine transform of damping by another construction, three digits",
        lambda: _kernel(1.0),
        0.166,
        1e-3,
        False,
        "digits of the source",
    ),
    ValidationCase(
        "thin plates: lower edge's share at infinite frequency, from the solver of any frequency",
        "pi / 16, closed form",
        _lower_edge,
        math.pi / 16.0,
        1e-6,
    ),
    ValidationCase(
        "thin plates: added mass of stretching, s/d = 0.3",
        "vortex panels of another construction: 0.204",
        _stretch,
        0.204,
        5e-4,
        False,
        "digits of the source",
    ),
    ValidationCase(
        "thin plates: drift by pressure and edge suction over that by momentum, moving plate",
        "momentum far off",
        _suction,
        1.0,
        1e-5,
    ),
    ValidationCase(
        "thin plates: keel plates of a box against plates of 3 mm",
        "closed polygon with thickness, same waves; change of T",
        lambda: _keel_plates(0.0),
        0.0,
        1.2e-3,
        False,
        "thickness of the polygon: the change falls like t ln t",
    ),
    ValidationCase(
        "thin plates: drift by pressure over that by momentum, box with a curtain under it",
        "momentum far off",
        _hull_drift,
        1.0,
        1e-4,
    ),
)
