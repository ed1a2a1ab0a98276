"""Validation of moorings at rest: published static lines, exact limits and the equations of the cable by quadrature."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.validation import ValidationCase
from moyai.mooring.catenary import solve_catenary
from moyai.mooring.lines import Clump, Line, LineType, Segment
from moyai.mooring.shoji import solve_shoji
from moyai.mooring.system import LineSystem, PlanarLineSystem

_NAKAMURA = "Nakamura, Ohmori and Ide: chain of the model, by an independent prototype"


#: Reach, rise, length [m], EA [N] and weight in water [N/m] of that chain.
NAKAMURA_CHAIN = (1.925, 0.267, 1.975, 2.14e4, 1.122)


def nakamura_model(per_side: int = 2) -> PlanarLineSystem:
    """Return the lines of the model of the floating breakwater, four chains by default."""
    reach, _, length, axial, weight = NAKAMURA_CHAIN
    chain = LineType("chain", weight, axial)
    lines = tuple(
        Line(
            name,
            (sign * (0.19 + reach), 0.0, -0.38),
            (sign * 0.19, 0.0, -0.113),
            (Segment(chain, length),),
            count=per_side,
        )
        for name, sign in (("offshore", -1.0), ("shore", 1.0))
    )
    return LineSystem(lines, 0.38).planar()


def _stiffness(row: int, column: int) -> float:
    return float(nakamura_model().stiffness([0.0, 0.0, 0.0], about=(0.0, -0.027))[row, column])


def _offset(offset: float) -> float:
    return float(solve_catenary(NAKAMURA_CHAIN[0] + offset, *NAKAMURA_CHAIN[1:]).horizontal_tension)


def _deck(distance: float, depth: float, length: float, at_anchor: bool) -> float:
    """Return a tension [kN] of MoorDyn's chain 0.252 m, 390 kg/m."""
    weight = (390.0 - 1025.0 * math.pi / 4.0 * 0.252**2) * 9.81
    line = solve_catenary(distance, depth, length, 1.674e9, weight)
    return float(line.tension_anchor if at_anchor else line.tension_fairlead) / 1e3


def _shared_anchor() -> float:
    weight = (685.0 - 1025.0 * math.pi / 4.0 * 0.333**2) * 9.80665
    distance = math.hypot(725.382878 - 50.229473, 418.8 - 29.0)
    return float(solve_catenary(distance, 186.0, 850.0, 3.27e9, weight).tension_fairlead) / 1e3


def _random_residual() -> float:
    """Return the largest residual of 60 000 random lines of every regime."""
    rng = np.random.default_rng(77)
    count = 20_000
    chord, angle = 10.0 ** rng.uniform(-2, 4, count), rng.uniform(0.0, np.pi / 2, count)
    length, weight = chord * rng.uniform(0.5, 3.0, count), 10.0 ** rng.uniform(-3, 4, count)
    axial = weight * length * 10.0 ** rng.uniform(0, 7, count)
    x, z = chord * np.cos(angle), chord * np.sin(angle)
    worst = 0.0
    for settings in ({"bed": True}, {"bed": False}, {"bed": True, "bed_friction": rng.uniform(0, 1.5, count)}):
        line = solve_catenary(x, z, length, axial, weight, **settings)
        worst = max(worst, float(np.nanmax(line.residual)), 1.0 * bool(np.isnan(line.residual).any()))
    return worst


def _quadrature() -> float:
    """Return the miss of the fairlead over the length when the cable's equations are integrated numerically."""
    from scipy.integrate import solve_ivp

    rng = np.random.default_rng(5)
    worst = 0.0
    for _ in range(10):
        length, weight = rng.uniform(5.0, 500.0), rng.uniform(1.0, 3000.0)
        axial = weight * length * 10.0 ** rng.uniform(0, 5)
        angle = rng.uniform(0.05, 1.4)
        chord = length / rng.uniform(0.7, 0.97 * (math.cos(angle) + math.sin(angle)))  # not slack
        x, z = chord * math.cos(angle), chord * math.sin(angle)
        line = solve_catenary(x, z, length, axial, weight)
        h, ground = float(line.horizontal_tension), float(line.grounded_length)
        v = max(float(line.vertical_tension_anchor), 0.0)

        def slope(
            s: float, _: object, h: float = h, v: float = v, w: float = weight, axial: float = axial
        ) -> list[float]:
            vertical = v + w * s
            rate = 1.0 / math.hypot(h, vertical) + 1.0 / axial
            return [h * rate, vertical * rate]

        end = solve_ivp(slope, (0.0, length - ground), [0.0, 0.0], method="DOP853", rtol=1e-12, atol=1e-12).y[:, -1]
        reach = end[0] + ground * (1.0 + h / axial)
        worst = max(worst, abs(reach - x) / length, abs(end[1] - z) / length)
    return worst


def _segmented_against_uniform() -> float:
    """Return the largest relative difference of a chain cut in three (with a clump of no weight) to the whole one."""
    chain = LineType("chain", 420.0, 2e8)
    parts = (Segment(chain, 55.0), Segment(chain, 25.0), Segment(chain, 20.0))
    cut = Line("cut", (0.0, 0.0, -10.0), (0.0, 0.0, 0.0), parts, (Clump(1, 1e-9),))
    x, z = np.linspace(95.0, 99.6, 40), np.full(40, 8.0)
    out, _ = cut.solve_plane(x, z, 10.0)
    whole = solve_catenary(x, z, cut.length, 2e8, 420.0)
    return float(np.max(np.abs(out[:, 0] / whole.horizontal_tension - 1.0)))


_EXACT = "exact elastic catenary computed independently"
CASES: tuple[ValidationCase, ...] = (
    ValidationCase("mooring: inextensible line on the bed, H [N]", "MoorPy test case",
                   lambda: float(solve_catenary(400.0, 200.0, 500.0, np.inf, 800.0).horizontal_tension),
                   96643.4, 1e-6, note="printed digits"),
    ValidationCase("mooring: inextensible line on the bed, grounded length [m]", "MoorPy test case",
                   lambda: float(solve_catenary(400.0, 200.0, 500.0, np.inf, 800.0).grounded_length),
                   202.810, 3e-6, note="printed digits"),
    ValidationCase("mooring: suspended chain, H [N]", "MoorPy test case",
                   lambda: float(solve_catenary(89.9, 59.2, 130.0, 7.51e8, 881.05, bed=False).horizontal_tension),
                   31373.23, 3e-7, note="printed digits"),
    ValidationCase("mooring: Bergdahl line, tension at the top [N]", "Bergdahl et al. 2016, static line, " + _EXACT,
                   lambda: float(solve_catenary(32.554, 3.3, 33.0, 1e4, 0.6993).tension_fairlead), 22.680, 1e-4,
                   note="four digits of the weight"),
    ValidationCase("mooring: deck WD0050, fairlead [kN]", "MoorDyn v2 deck, " + _EXACT,
                   lambda: _deck(400.0, 50.0, 410.0, False), 1002.0, 1e-4, note="printed digits"),
    ValidationCase("mooring: deck WD0050, anchor [kN]", "MoorDyn v2 deck, " + _EXACT,
                   lambda: _deck(400.0, 50.0, 410.0, True), 835.9, 1e-4, note="printed digits"),
    ValidationCase("mooring: deck WD0200, fairlead [kN]", "MoorDyn v2 deck, " + _EXACT,
                   lambda: _deck(700.0, 200.0, 760.0, False), 2070.8, 1e-4, note="printed digits"),
    ValidationCase("mooring: deck WD0200, anchor [kN]", "MoorDyn v2 deck, " + _EXACT,
                   lambda: _deck(700.0, 200.0, 760.0, True), 1406.6, 1e-4, note="printed digits"),
    ValidationCase("mooring: three chains to one anchor, fairlead [kN]", "CableDyn V-S1m, MoorDyn-C static state",
                   _shared_anchor, 2435.737, 2e-4, note="MoorDyn-C lumps the chain into 200 segments"),
    ValidationCase("mooring: Nakamura chain, T_H at rest [N]", _NAKAMURA, lambda: _offset(0.0), 1.796, 3e-4,
                   note="printed digits"),
    ValidationCase("mooring: Nakamura chain, T_H at +2 cm [N]", _NAKAMURA, lambda: _offset(0.02), 5.02, 1e-3,
                   note="printed digits"),
    ValidationCase("mooring: Nakamura chain by Shoji's formula [N]", _NAKAMURA,
                   lambda: solve_shoji(*NAKAMURA_CHAIN).horizontal_tension, 1.796, 3e-4,
                   note="equal to the exact line while part of it rests on the bed"),
    ValidationCase("mooring: Nakamura sway stiffness of four chains [N/m]", _NAKAMURA, lambda: _stiffness(0, 0), 298.3,
                   1e-3, note="weight of the chain to four digits"),
    ValidationCase("mooring: Nakamura sway-roll stiffness [N/rad]", _NAKAMURA, lambda: _stiffness(0, 2), -9.93, 1e-3,
                   note="printed digits"),
    ValidationCase("mooring: Nakamura roll stiffness [N m/rad]", _NAKAMURA, lambda: _stiffness(2, 2), 2.38, 2e-3,
                   note="printed digits"),
    ValidationCase("mooring: residual of 60 000 random lines over their length", "identity", _random_residual, 0.0,
                   1e-10, relative=False, note="0.5 to 3 chords, EA/wL 1 to 1e7, slopes to the vertical, bed and none"),
    ValidationCase("mooring: fairlead missed by quadrature of the cable's equations", "scipy DOP853, rtol 1e-12",
                   _quadrature, 0.0, 1e-9, relative=False, note="over the line length, ten random lines"),
    ValidationCase("mooring: segmented solver against the uniform line", "identity", _segmented_against_uniform, 0.0,
                   1e-8, relative=False, note="chain cut in three"),
)  # fmt: skip
