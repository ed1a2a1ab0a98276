"""Reference solvers: the rectangle against an independent prototype and exact limits, the circles against limits."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache

import numpy as np

from moyai.core.validation import ValidationCase
from moyai.potential.multipole_circle import half_immersed_circle, submerged_circle
from moyai.potential.rectangle import RectangleSolution, solve_rectangle
from moyai.sea.dispersion import angular_frequency
from moyai.sea.water import Water

PROTOTYPE = "matched eigenfunctions with 240 modes and plain cosines, box of Nakamura, Ohmori and Ide"
BENCHMARK = "matched eigenfunctions with 800 to 1600 terms, box of Nakamura, Ohmori and Ide"
FLUME = "matched eigenfunctions, fixed box of Koutandos' flume (B 2 m, d 0.5 m, h 2 m)"
BEAM, DRAUGHT, CENTRE_Z, GYRADIUS = 0.38, 0.113, -0.027, 0.101
WATER = Water(depth=0.38, density=1000.0, gravity=9.81)
_PRINTED = "printed digits of a prototype that converges like modes^(-4/3)"


@lru_cache(maxsize=16)
def box_at_period(period: float) -> RectangleSolution:
    """Return the solution of the model's box at one period [s]."""
    return solve_rectangle(BEAM, DRAUGHT, WATER, 2.0 * math.pi / period, centre=(0.0, CENTRE_Z))


@lru_cache(maxsize=16)
def box_at_length(length_over_beam: float) -> RectangleSolution:
    """Return the solution of the model's box at one wave length."""
    omega = float(angular_frequency(2.0 * math.pi / (length_over_beam * BEAM), WATER.depth, WATER.gravity))
    return solve_rectangle(BEAM, DRAUGHT, WATER, omega, centre=(0.0, CENTRE_Z))


def free_box(length_over_beam: float) -> tuple[float, np.ndarray]:
    """Return KT and the motions |x|/a, |z|/a, |theta| B/2a of the freely floating box without damping and mooring."""
    solution = box_at_length(length_over_beam)
    omega, rho, g = float(solution.omega[0]), WATER.density, WATER.gravity
    area = BEAM * DRAUGHT
    mass = rho * area * np.diag([1.0, 1.0, GYRADIUS**2])
    metacentre = BEAM**2 / (12.0 * DRAUGHT) - 0.5 * DRAUGHT - CENTRE_Z
    stiffness = np.diag([0.0, rho * g * BEAM, rho * g * area * metacentre])
    impedance = stiffness - omega**2 * (mass + solution.added_mass[0]) - 1j * omega * solution.radiation_damping[0]
    motion = np.linalg.solve(impedance, solution.excitation_force[0, 0])
    velocity = -1j * omega * motion
    transmission = solution.transmission_coefficient[0, 0] + solution.radiated_wave[0, :, 1] @ velocity
    return float(abs(transmission)), np.abs(motion) * [1.0, 1.0, 0.5 * BEAM]


def flume_transmission(period: float) -> float:
    """Return KT of the fixed box of the flume."""
    water = Water(2.0, 1000.0, 9.81)
    return float(
        abs(solve_rectangle(2.0, 0.5, water, 2.0 * math.pi / period, centre=(0.0, 0.0)).transmission_coefficient[0, 0])
    )


def rectangle_identities() -> float:
    """Return the worst identity of a box at four frequencies and three headings."""
    solution = solve_rectangle(
        7.3, 1.9, Water(6.1, 1025.0, 9.81), [0.4, 1.0, 1.8, 3.0], centre=(0.3, -0.6), heading=[0.0, 0.7, 2.6]
    )
    return max(check.value for check in solution.checks)


def plate_added_mass(draught_over_depth: float) -> float:
    """Return the phi = 0 added mass of a thin plate over rho d^2."""
    solution = solve_rectangle(1e-5, draught_over_depth, Water(1.0, 1.0, 9.81), 1.0, centre=(0.0, 0.0))
    return float(solution.infinite_frequency_added_mass[0, 0]) / draught_over_depth**2


def shallow_heave_damping() -> float:
    """Return the heave damping at kh = 1e-3 over that of long waves."""
    water = Water(4.0, 1000.0, 9.81)
    omega = 1e-3 * math.sqrt(9.81 / 4.0)
    solution = solve_rectangle(3.0, 1.5, water, omega, centre=(0.0, 0.0))
    return float(solution.radiation_damping[0, 1, 1]) / (0.5 * 1000.0 * 9.0 * math.sqrt(9.81 / 4.0))


def image_dipoles(submergence: float) -> float:
    """Return the added mass of a circle below a plane with phi = 0, over its area, from the chain of image dipoles."""
    position, strength, total = 0.0, 1.0, 1.0
    for _ in range(200):
        distance = 2.0 * submergence - position
        position = 1.0 / distance
        strength *= -1.0 / distance**2
        total += 2.0 * strength
    return total


def _box(name: str, compute: Callable[[], float], reference: float, tolerance: float) -> ValidationCase:
    return ValidationCase(f"rectangle: {name}", PROTOTYPE, compute, reference, tolerance, note=_PRINTED)


CASES: tuple[ValidationCase, ...] = (
    _box("a11 at T = 0.95 s", lambda: float(box_at_period(0.95).added_mass[0, 0, 0]), 18.08, 5e-4),
    _box("a33 at T = 0.60 s", lambda: float(box_at_period(0.60).added_mass[0, 2, 2]), 0.2973, 6e-4),
    _box("b22 at T = 1.60 s", lambda: float(box_at_period(1.60).radiation_damping[0, 1, 1]), 308.1, 3e-4),
    _box("X3 at T = 1.60 s", lambda: float(abs(box_at_period(1.60).excitation_force[0, 0, 2])), 70.32, 4e-4),
    _box(
        "C_T fixed at T = 0.95 s", lambda: float(abs(box_at_period(0.95).transmission_coefficient[0, 0])), 0.3352, 4e-4
    ),
    _box("m11 at phi = 0", lambda: float(box_at_period(0.95).infinite_frequency_added_mass[0, 0]), 10.16, 6e-4),
    ValidationCase(
        "rectangle: KT free, L/B = 3", BENCHMARK, lambda: free_box(3.0)[0], 0.2766, 4e-4, note="printed digits"
    ),
    ValidationCase(
        "rectangle: roll free, L/B = 3.5", BENCHMARK, lambda: free_box(3.5)[1][2], 9.091, 3e-4, note="resonance"
    ),
    ValidationCase("rectangle: KT of the flume, T = 3 s", FLUME, lambda: flume_transmission(3.0), 0.696, 8e-4),
    ValidationCase(
        "rectangle: worst identity",
        "energy, Haskind, symmetry, far field",
        rectangle_identities,
        0.0,
        1e-10,
        relative=False,
    ),
    ValidationCase(
        "rectangle: plate, phi = 0, d/h = 0.8",
        "Galerkin solution on the strip",
        lambda: plate_added_mass(0.8),
        0.6574,
        2e-4,
    ),
    ValidationCase("rectangle: slow heave", "long waves, rho b^2 sqrt(g/h)/2", shallow_heave_damping, 1.0, 1e-5),
    ValidationCase(
        "half circle: sway at phi = 0",
        "series with the sum 4/pi^2, approached like 1/K",
        lambda: 2.0 * half_immersed_circle(20.0, "sway").added_mass - half_immersed_circle(10.0, "sway").added_mass,
        4.0 / math.pi**2,
        8e-3,
        note="extrapolation from K a = 10 and 20; the next term is of second order in 1/Ka with a logarithm",
    ),
    ValidationCase(
        "half circle: slow heave damping",
        "source at the surface, 8/pi",
        lambda: half_immersed_circle(1e-6, "heave").radiation_damping,
        8.0 / math.pi,
        5e-5,
        note="at K a = 1e-6, where K a ln(K a) is 1.4e-5",
    ),
    ValidationCase(
        "half circle: energy at K a = 0.7",
        "power of the waves",
        lambda: half_immersed_circle(0.7, "heave").energy_defect,
        0.0,
        1e-11,
        relative=False,
    ),
    ValidationCase(
        "submerged circle: |T| at K a = 0.5, f/a = 1.25",
        "no reflection (Dean, Ursell)",
        lambda: abs(submerged_circle(0.5, 1.25).transmission_coefficient),
        1.0,
        1e-12,
    ),
    ValidationCase(
        "submerged circle: fast motion at f/a = 2",
        "image dipoles, approached like 1/K",
        lambda: 2.0 * submerged_circle(20.0, 2.0).added_mass - submerged_circle(10.0, 2.0).added_mass,
        image_dipoles(2.0),
        1e-3,
    ),
)
