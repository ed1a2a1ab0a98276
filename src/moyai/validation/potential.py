"""Validation of the section solver: exact solutions, independent methods, published tables, identities at random."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.validation import ValidationCase
from moyai.potential import shapes
from moyai.potential.drift import mean_drift_far_field, mean_drift_near_field
from moyai.potential.modes import rigid_modes
from moyai.potential.rectangle import solve_rectangle
from moyai.potential.solution import RadiationDiffraction
from moyai.potential.solver import solve
from moyai.sea.water import Water

_GRAVITY = 9.81
_NAKAMURA = "Nakamura, Ohmori and Ide: model of the floating breakwater, matched eigenfunctions with 240 terms"
_BOX = "floating box h = B, matched eigenfunctions with 800 to 1600 terms, converged to 2e-4"


@lru_cache(maxsize=1)
def _model() -> RadiationDiffraction:
    """Model of Nakamura, Ohmori and Ide at T = 0.60, 0.95 and 1.60 s."""
    omega = 2.0 * math.pi / np.array([0.60, 0.95, 1.60])
    section = shapes.rectangle(0.38, 0.17).immersed(0.113)
    return solve(section, Water(0.38, 1000.0, _GRAVITY), omega, modes=rigid_modes((0.0, -0.027)))


@lru_cache(maxsize=1)
def _pontoon() -> RadiationDiffraction:
    """The 10 m x 3 m pontoon in 10 m of water at 0.5, 1.5256 and 2.5 rad/s."""
    section = shapes.rectangle(10.0, 4.5).immersed(3.0)
    return solve(section, Water(10.0, 1000.0, _GRAVITY), [0.5, 1.525641, 2.5], modes=rigid_modes((0.0, 0.0)))


def half_circle(relative: float, accuracy: float = 1e-3) -> tuple[Array, Array, Array]:
    """Return added mass, damping and wave of a half-immersed circle in sway and heave, without dimension."""
    omega = math.sqrt(relative * _GRAVITY)
    section, water = shapes.circle(1.0).immersed(1.0), Water(math.inf, 1.0, _GRAVITY)
    found = solve(section, water, [omega], modes=rigid_modes((0.0, 0.0)), accuracy=accuracy)
    mass, damping = (np.diagonal(part[0])[:2] for part in (found.added_mass, found.radiation_damping))
    unit = math.pi / 2.0
    return mass / unit, damping / (unit * omega), np.abs(found.radiated_wave[0, :2]) * omega


def _submerged_circle(name: str) -> float:
    """Return a figure of a submerged circle two radii below the surface at K a = 0.4, infinite depth."""
    omega = math.sqrt(0.4 * _GRAVITY)
    found = solve(
        shapes.circle(1.0).immersed(3.0), Water(math.inf, 1.0, _GRAVITY), [omega], modes=rigid_modes((0.0, -2.0))
    )
    if name == "reflection":
        return float(np.abs(found.reflection_coefficient).max())
    return float(found.added_mass[0, 1, 1] / math.pi)


def _box_transmission(ratio: float) -> float:
    """Return KT of the fixed box h = B = 0.38 m, d = 0.113 m at L/B."""
    number = 2.0 * math.pi / (ratio * 0.38)
    omega = math.sqrt(_GRAVITY * number * math.tanh(number * 0.38))
    section = shapes.rectangle(0.38, 0.17).immersed(0.113)
    found = solve(section, Water(0.38, 1000.0, _GRAVITY), [omega], modes=rigid_modes((0.0, 0.0)))
    return float(np.abs(found.transmission_coefficient[0, 0]))


def _against_rectangle(heading: float) -> float:
    """Return the largest difference to matched eigenfunctions over three random rectangles, over band maxima."""
    rng = np.random.default_rng(20)
    worst = 0.0
    for _ in range(3):
        depth = 10.0 ** rng.uniform(-0.5, 1.5)
        draught, beam = depth * rng.uniform(0.1, 0.9), depth * 10.0 ** rng.uniform(-0.7, 0.5)
        number = np.sort(10.0 ** rng.uniform(-0.7, 0.9, 3)) / beam
        omega = np.sqrt(_GRAVITY * number * np.tanh(number * depth))
        water = Water(depth, 1025.0, _GRAVITY)
        found = solve(
            shapes.rectangle(beam, 1.5 * draught).immersed(draught),
            water,
            omega,
            modes=rigid_modes((0.0, 0.0)),
            heading=heading,
        )
        exact = solve_rectangle(beam, draught, water, omega, centre=(0.0, 0.0), heading=heading)
        for name in ("added_mass", "radiation_damping"):
            a, b = getattr(found, name), getattr(exact, name)
            size = np.sqrt(np.einsum("wii->wi", b).max(axis=0))
            worst = max(worst, float((np.abs(a - b).max(axis=0) / np.outer(size, size)).max()))
        a, b = found.excitation_force, exact.excitation_force
        worst = max(worst, float((np.abs(a - b).max(axis=(0, 1)) / np.abs(b).max(axis=(0, 1))).max()))
        worst = max(worst, float(np.abs(found.transmission_coefficient - exact.transmission_coefficient).max()))
    return worst


def _random_identities() -> float:
    """Return the worst identity over eight random pairs of polygons, heeled, in random depth, one in four submerged."""
    rng = np.random.default_rng(4)
    worst = 0.0
    done = 0
    while done < 8:
        angle = np.sort(rng.uniform(0.0, 2.0 * math.pi, 6))
        if np.diff(np.append(angle, angle[0] + 2.0 * math.pi)).max() > 2.6 or np.diff(angle).min() < 0.2:
            continue
        reach = rng.uniform(0.5, 1.0, 6)
        draught = rng.uniform(1.2, 2.0) if rng.random() < 0.25 else rng.uniform(-0.2, 0.5)
        try:
            section = shapes.polygon(np.stack([reach * np.cos(angle), reach * np.sin(angle)], axis=1)).immersed(
                draught, heel=rng.uniform(-0.3, 0.3)
            )
        except InputError:
            continue
        water = Water(-section.bottom * (1.0 + 10.0 ** rng.uniform(-1.5, 1.0)), 1025.0, _GRAVITY)
        number = np.sort(10.0 ** rng.uniform(-1.0, 1.0, 3))
        omega = np.sqrt(_GRAVITY * number * np.tanh(number * water.depth))
        found = solve(section, water, omega, modes=rigid_modes((0.1, -0.2)))
        worst = max(worst, *(check.value for check in found.checks[:4]))
        done += 1
    return worst


def _drift_difference() -> float:
    """Return the near-field less the far-field drift of a fixed and of a driven box over rho g / 2."""
    found = _pontoon()
    driven = np.array([[0.5, 0.3 + 0.2j, 0.02], [0.2j, 0.4, 0.03j], [0.1, 0.1, 0.01]])
    worst = 0.0
    for motions in (None, driven):
        far, near = mean_drift_far_field(found, motions), mean_drift_near_field(found, motions)
        worst = max(worst, float(np.abs(far.horizontal - near.horizontal).max()))
    return worst / (0.5 * 1000.0 * _GRAVITY)


CASES: tuple[ValidationCase, ...] = (
    ValidationCase(
        "potential: half circle heave added mass, Ka = 1",
        "Ursell 1949, multipoles in infinite depth, extrapolated (moyai.potential.multipole_circle)",
        lambda: float(half_circle(1.0)[0][1]),
        0.604976885,
        1e-4,
    ),
    ValidationCase(
        "potential: half circle sway damping, Ka = 0.6",
        "Ursell's multipoles for sway, infinite depth",
        lambda: float(half_circle(0.6)[1][0]),
        0.895866714,
        2e-4,
    ),
    ValidationCase(
        "potential: half circle, phi = 0, heave",
        "exact: half of the circle's pi rho a^2 in unbounded water",
        lambda: float(
            solve(
                shapes.circle(1.0).immersed(1.0), Water(math.inf, 1.0, _GRAVITY), [1.0], modes=rigid_modes((0.0, 0.0))
            ).infinite_frequency_added_mass[1, 1]
        ),
        math.pi / 2.0,
        1e-6,
    ),
    ValidationCase(
        "potential: reflection of a submerged circle",
        "Dean 1948, Ursell 1950: none in infinite depth",
        lambda: _submerged_circle("reflection"),
        0.0,
        1e-5,
        relative=False,
    ),
    ValidationCase(
        "potential: submerged circle heave added mass",
        "multipoles in infinite depth, K a = 0.4, two radii deep",
        lambda: _submerged_circle("added_mass"),
        0.967998075,
        1e-4,
    ),
    ValidationCase(
        "potential: random rectangles, normal waves",
        "matched eigenfunctions: A, B, X, T over their band maxima",
        lambda: _against_rectangle(0.0),
        0.0,
        2e-4,
        relative=False,
        note="the accuracy asked for is 1e-3",
    ),
    ValidationCase(
        "potential: random rectangles, waves at 40 degrees",
        "matched eigenfunctions with the wave number along the crest",
        lambda: _against_rectangle(math.radians(40.0)),
        0.0,
        2e-4,
        relative=False,
        note="the accuracy asked for is 1e-3",
    ),
    ValidationCase(
        "potential: identities of random polygons",
        "energy, symmetry, Haskind, damping by pressure and by waves",
        _random_identities,
        0.0,
        1e-3,
        relative=False,
    ),
    ValidationCase(
        "potential: drift by pressure and by momentum",
        "Pinkster's near field against Longuet-Higgins' far field, fixed and moving box",
        _drift_difference,
        0.0,
        1e-3,
        relative=False,
    ),
    *(
        ValidationCase(
            f"potential: breakwater model, {name}",
            _NAKAMURA,
            lambda index=index, value=value: value(_model(), index),  # type: ignore[misc]
            reference,
            1.5e-3,
            note="four printed digits",
        )
        for name, index, value, reference in (
            ("a11 at T = 0.95 s", 1, lambda s, i: float(s.added_mass[i, 0, 0]), 18.08),
            ("a22 at T = 0.60 s", 0, lambda s, i: float(s.added_mass[i, 1, 1]), 74.27),
            ("b22 at T = 1.60 s", 2, lambda s, i: float(s.radiation_damping[i, 1, 1]), 308.1),
            ("X3 at T = 0.95 s", 1, lambda s, i: float(abs(s.excitation_force[i, 0, 2])), 54.98),
            ("C_T at T = 1.60 s", 2, lambda s, i: float(abs(s.transmission_coefficient[i, 0])), 0.7769),
            ("m* in heave", 0, lambda s, i: float(s.infinite_frequency_added_mass[1, 1]), 93.77),
            ("m* sway-roll", 0, lambda s, i: float(s.infinite_frequency_added_mass[0, 2]), 0.142),
        )
    ),
    *(
        ValidationCase(
            f"potential: pontoon 10 m x 3 m, {name}",
            "converging two-dimensional prototype, t/m",
            lambda index=index, value=value: value(_pontoon(), index),  # type: ignore[misc]
            reference,
            2e-3,
            note="three to four printed digits",
        )
        for name, index, value, reference in (
            ("A33 at 0.5 rad/s", 0, lambda s, i: float(s.added_mass[i, 1, 1]) / 1e3, 32.99),
            ("A33 at 2.5 rad/s", 2, lambda s, i: float(s.added_mass[i, 1, 1]) / 1e3, 56.88),
            ("B11 at 1.526 rad/s", 1, lambda s, i: float(s.radiation_damping[i, 0, 0]) / 1e3, 29.92),
            ("B33 at 1.526 rad/s", 1, lambda s, i: float(s.radiation_damping[i, 1, 1]) / 1e3, 17.07),
        )
    ),
    *(
        ValidationCase(
            f"potential: fixed box, KT at L/B = {ratio:g}",
            _BOX,
            lambda ratio=ratio: _box_transmission(ratio),  # type: ignore[misc]
            reference,
            1.5e-4,
            relative=False,
        )
        for ratio, reference in ((2.0, 0.0735), (3.5, 0.3337), (8.0, 0.8109))
    ),
)
